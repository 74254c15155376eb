// SPDX-License-Identifier: MIT
#include "app/detect/detect_files.h"

#include "app/output/standard_streams.h"
#include "core/base/outward.h"
#include "core/base/text.h"
#include "io/text/table.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

/// Of a millimetre or its square: more digits say nothing.
constexpr double kParts = 1e6;

std::string rounded(double value) {
    return number(std::round(value * kParts) / kParts + 0.0);
}

std::string joined(const Vec3& vector, char between) {
    return rounded(vector[0]) + between + rounded(vector[1]) + between + rounded(vector[2]);
}

/// What was measured of a part of a pair; `part`: which one.
template <class Bounds>
void writeBounds(std::ostream& out, const DetectOptions& options, const Row& row, const std::string& part,
                 const Bounds& bounds) {
    const PairJobs& jobs = options.jobs;
    const Job& job = jobs.jobs[row.job];
    out << row.pose << ',' << io::csvField(jobs.meshes[job.mesh]) << ',' << io::csvField(jobs.volumes[job.volume])
        << ',' << part << ',' << number(bounds.lo) << ',' << number(bounds.hi)
        << (jobs.fromFile ? "," + std::to_string(row.job) : "") << '\n';
}

std::string labelPart(const DetectInputs& inputs, std::int32_t label) {
    return std::to_string(label) + ',' + io::csvField(labelName(inputs, label));
}

/// Parts of a mm^2: more digits say nothing.
double areaParts(double tolerance) {
    return std::max(kParts, std::pow(10, std::ceil(2 - std::log10(tolerance))));
}

std::int32_t labelOf(const DetectInputs& inputs, const Vec3& world) {
    return inputs.labels ? inputs.labels->values[labelAt(*inputs.labels, world)] : 0;
}

void writePly(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
              std::span<const KeptClosest> kept) {
    const PairJobs& jobs = options.jobs;
    out << "ply\nformat ascii 1.0\n"
           "comment closest points by voxtact; world, mm, LPS (+x left, +y posterior, +z superior)\n"
           "comment vertices: on the mesh, in the volume, by turns; clearance: its upper bound\n";
    for (std::size_t i = 0; i < jobs.meshes.size(); ++i) {
        out << "comment mesh " << i << " is " << io::csvField(oneLine(jobs.meshes[i])) << '\n';
    }
    for (std::size_t i = 0; i < jobs.volumes.size(); ++i) {
        out << "comment volume " << i << " is " << io::csvField(oneLine(jobs.volumes[i])) << '\n';
    }
    out << "element vertex " << 2 * kept.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nproperty int in_volume\n"
           "element edge "
        << kept.size()
        << "\nproperty int vertex1\nproperty int vertex2\nproperty double clearance\nproperty uint pose\n"
           "property uint mesh\nproperty uint volume\nproperty uint triangle\nproperty int label\nend_header\n";
    for (const KeptClosest& entry : kept) {
        out << joined(entry.closest.mesh, ' ') << " 0\n" << joined(entry.closest.volume, ' ') << " 1\n";
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const KeptClosest& entry = kept[i];
        const Job& job = jobs.jobs[entry.job];
        out << 2 * i << ' ' << 2 * i + 1 << ' ' << rounded(entry.bounds.hi) << ' ' << entry.pose << ' ' << job.mesh
            << ' ' << job.volume << ' ' << entry.closest.triangle << ' ' << labelOf(inputs, entry.closest.volume)
            << '\n';
    }
}

} // namespace

void writeClosestHeader(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs) {
    out << "pose,mesh,volume,triangle,mesh_x,mesh_y,mesh_z,volume_x,volume_y,volume_z,label,per_x,per_y,per_z,per_rx,"
           "per_ry,per_rz"
        << (inputs.labelNames.empty() ? "" : ",label_name") << (options.jobs.fromFile ? ",job\n" : "\n");
}

void writeClosestRows(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      std::span<const KeptClosest> kept) {
    const PairJobs& jobs = options.jobs;
    const bool named = !inputs.labelNames.empty();
    for (const KeptClosest& entry : kept) {
        const Job& job = jobs.jobs[entry.job];
        const ClosestPoints& closest = entry.closest;
        const std::int32_t label = labelOf(inputs, closest.volume);
        out << entry.pose << ',' << io::csvField(jobs.meshes[job.mesh]) << ',' << io::csvField(jobs.volumes[job.volume])
            << ',' << closest.triangle << ',' << joined(closest.mesh, ',') << ',' << joined(closest.volume, ',') << ','
            << label << ',' << joined(closest.perTranslation, ',') << ',' << joined(closest.perRotation, ',')
            << (named ? ',' + io::csvField(labelName(inputs, label)) : "")
            << (jobs.fromFile ? "," + std::to_string(entry.job) : "") << '\n';
    }
}

ClearanceBounds roundedOutward(const ClearanceBounds& bounds) {
    return {lowerRounded(bounds.lo, kParts), upperRounded(bounds.hi, kParts)};
}

AreaBounds roundedOutward(const AreaBounds& bounds, double tolerance) {
    const double parts = areaParts(tolerance);
    return {lowerRounded(bounds.lo, parts), upperRounded(bounds.hi, parts)};
}

void writeLabelClearanceHeader(std::ostream& out, const DetectOptions& options) {
    out << "pose,mesh,volume,label,name,clearance_lo,clearance_hi" << (options.jobs.fromFile ? ",job\n" : "\n");
}

void writeLabelClearance(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs, const Row& row,
                         const LabelClearance& clearance) {
    writeBounds(out, options, row, labelPart(inputs, clearance.label), roundedOutward(clearance.bounds));
}

void writeLabelAreaHeader(std::ostream& out, const DetectOptions& options) {
    out << "pose,mesh,volume,label,name,area_lo,area_hi" << (options.jobs.fromFile ? ",job\n" : "\n");
}

void writeLabelArea(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs, const Row& row,
                    const LabelArea& area) {
    writeBounds(out, options, row, labelPart(inputs, area.label),
                roundedOutward(area.bounds, options.distance.areaGoal()));
}

void writeTriangleAreaHeader(std::ostream& out, const DetectOptions& options) {
    out << "pose,mesh,volume,triangle,triangle_area,area_lo,area_hi" << (options.jobs.fromFile ? ",job\n" : "\n");
}

void writeTriangleArea(std::ostream& out, const DetectOptions& options, const Row& row, const TriangleArea& area) {
    const double tolerance = options.distance.areaGoal();
    const double parts = areaParts(tolerance);
    writeBounds(out, options, row, std::to_string(area.triangle) + ',' + number(std::round(area.whole * parts) / parts),
                roundedOutward(area.bounds, tolerance));
}

bool isClosestEnding(const std::filesystem::path& path) {
    return path.extension() == ".csv" || path.extension() == ".ply";
}

void writeClosest(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                  std::span<const KeptClosest> kept) {
    if (options.distance.closest.extension() == ".csv") {
        writeClosestHeader(out, options, inputs);
        writeClosestRows(out, options, inputs, kept);
    } else {
        writePly(out, options, inputs, kept);
    }
}

} // namespace voxtact::app

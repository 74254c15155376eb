// SPDX-License-Identifier: MIT
#include "cli/files/pair_files.h"

#include "cli/output/standard_streams.h"
#include "core/base/outward.h"
#include "core/base/text.h"
#include "io/text/table.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

/// Fractions of a millimetre or its square; more digits have no meaning.
constexpr double kPrintedParts = 1e6;

std::string rounded(double value) {
    return number(std::round(value * kPrintedParts) / kPrintedParts + 0.0);
}

std::string joined(const Vec3& vector, char between) {
    return rounded(vector[0]) + between + rounded(vector[1]) + between + rounded(vector[2]);
}

/// Parts of a mm^2: more digits say nothing.
double areaParts(double tolerance) {
    return std::max(kPrintedParts, std::pow(10, std::ceil(2 - std::log10(tolerance))));
}

std::int32_t labelOf(const PairInputs& inputs, const Vec3& world) {
    return inputs.labels ? inputs.labels->values[labelAt(*inputs.labels, world)] : 0;
}

void writePly(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
              std::span<const KeptClosest> kept) {
    const PairJobs& jobs = options.jobs;
    out << "ply\nformat ascii 1.0\n"
           "comment witness points by voxtact; world, mm, LPS (+x left, +y posterior, +z superior)\n"
           "comment vertices: alternately on the mesh and in the volume; distance: its upper bound\n";
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
        << "\nproperty int vertex1\nproperty int vertex2\nproperty double distance\nproperty uint pose\n"
           "property uint mesh\nproperty uint volume\nproperty uint triangle\nproperty int label\nend_header\n";
    for (const KeptClosest& entry : kept) {
        out << joined(entry.closest.mesh, ' ') << " 0\n" << joined(entry.closest.volume, ' ') << " 1\n";
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const KeptClosest& entry = kept[i];
        const Job& job = jobs.jobs[entry.job];
        out << 2 * i << ' ' << 2 * i + 1 << ' ' << rounded(entry.upper) << ' ' << entry.pose << ' ' << job.mesh << ' '
            << job.volume << ' ' << entry.closest.triangle << ' ' << labelOf(inputs, entry.closest.volume) << '\n';
    }
}

void writeCsv(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
              std::span<const KeptClosest> kept) {
    const PairJobs& jobs = options.jobs;
    const bool named = !inputs.labelNames.empty();
    if (options.shard.hasHead()) {
        out << "pose,mesh,volume,triangle,mesh_x,mesh_y,mesh_z,volume_x,volume_y,volume_z,label,per_x,per_y,per_z,"
               "per_rx,per_ry,per_rz"
            << (named ? ",label_name\n" : "\n");
    }
    for (const KeptClosest& entry : kept) {
        const Job& job = jobs.jobs[entry.job];
        const WitnessPoints& closest = entry.closest;
        const std::int32_t label = labelOf(inputs, closest.volume);
        out << entry.pose << ',' << io::csvField(jobs.meshes[job.mesh]) << ',' << io::csvField(jobs.volumes[job.volume])
            << ',' << (closest.triangle == kInsideMesh ? "" : std::to_string(closest.triangle)) << ','
            << joined(closest.mesh, ',') << ',' << joined(closest.volume, ',') << ',' << label << ','
            << joined(closest.perTranslation, ',') << ',' << joined(closest.perRotation, ',')
            << (named ? ',' + io::csvField(labelName(inputs, label)) : "") << '\n';
    }
}

} // namespace

Bounds roundedOutward(const Bounds& bounds) {
    return {lowerRounded(bounds.lower, kPrintedParts), upperRounded(bounds.upper, kPrintedParts)};
}

Bounds roundedOutward(const Bounds& bounds, double tolerance) {
    const double parts = areaParts(tolerance);
    return {lowerRounded(bounds.lower, parts), upperRounded(bounds.upper, parts)};
}

void writeTriangleArea(std::ostream& out, const PairOptions& options, const Row& row, const TriangleArea& area) {
    const double tolerance = options.measure.tolerance;
    const double parts = areaParts(tolerance);
    const PairJobs& jobs = options.jobs;
    const Job& job = jobs.jobs[row.job];
    const Bounds bounds = roundedOutward(area.bounds, tolerance);
    out << row.pose << ',' << io::csvField(jobs.meshes[job.mesh]) << ',' << io::csvField(jobs.volumes[job.volume])
        << ',' << area.triangle << ',' << number(std::round(area.whole * parts) / parts) << ',' << number(bounds.lower)
        << ',' << number(bounds.upper) << '\n';
}

bool isWitnessEnding(const std::filesystem::path& path) {
    return path.extension() == ".csv" || path.extension() == ".ply";
}

void writeWitnesses(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
                    std::span<const KeptClosest> kept) {
    if (options.measure.witness.extension() == ".csv") {
        writeCsv(out, options, inputs, kept);
    } else {
        writePly(out, options, inputs, kept);
    }
}

} // namespace voxtact::app

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

/// Steps per mm or mm^2 in files; more digits have no meaning.
constexpr double kPrintedParts = 1e6;

std::string rounded(double value) {
    return number(std::round(value * kPrintedParts) / kPrintedParts + 0.0);
}

/// The coordinates of a point of a row.
std::string joined(const Measured& row, const char* column, char between) {
    const auto at = [&](std::size_t axis) { return rounded(row.table->number(column, row.row, axis)); };
    return at(0) + between + at(1) + between + at(2);
}

/// Steps per unit in files; more digits have no meaning.
double partsOf(const PairOptions& options) {
    const double tolerance = options.measure.settings.number("tolerance");
    return tolerance > 0 ? std::max(kPrintedParts, std::pow(10, std::ceil(2 - std::log10(tolerance)))) : kPrintedParts;
}

/// The label at the witness point in the volume.
std::int32_t labelOf(const PairInputs& inputs, const Measured& row) {
    const auto at = [&](std::size_t axis) { return row.table->number("in_volume", row.row, axis); };
    return inputs.labels ? inputs.labels->values[labelAt(*inputs.labels, {at(0), at(1), at(2)})] : 0;
}

std::uint32_t triangleOf(const Measured& row) {
    return static_cast<std::uint32_t>(row.table->number("triangle", row.row));
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
        out << joined(entry.measured, "on_mesh", ' ') << " 0\n" << joined(entry.measured, "in_volume", ' ') << " 1\n";
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const KeptClosest& entry = kept[i];
        const Job& job = jobs.jobs[entry.job];
        out << 2 * i << ' ' << 2 * i + 1 << ' ' << rounded(entry.measured.table->number("upper", entry.measured.row))
            << ' ' << entry.pose << ' ' << job.mesh << ' ' << job.volume << ' ' << triangleOf(entry.measured) << ' '
            << labelOf(inputs, entry.measured) << '\n';
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
        const Measured& row = entry.measured;
        const std::int32_t label = labelOf(inputs, row);
        out << entry.pose << ',' << io::csvField(jobs.meshes[job.mesh]) << ',' << io::csvField(jobs.volumes[job.volume])
            << ',' << (triangleOf(row) == kInsideMesh ? "" : std::to_string(triangleOf(row))) << ','
            << joined(row, "on_mesh", ',') << ',' << joined(row, "in_volume", ',') << ',' << label << ','
            << joined(row, "per_translation", ',') << ',' << joined(row, "per_rotation", ',')
            << (named ? ',' + io::csvField(labelName(inputs, label)) : "") << '\n';
    }
}

} // namespace

bool hasWitness(const NamedQuestion& question) noexcept {
    const TableLayout* const pairs = question.table("pairs");
    return pairs != nullptr && std::ranges::any_of(pairs->columns, [](const Column& column) {
               return std::string_view(column.name) == "in_volume";
           });
}

Bounds roundedOutward(const Bounds& bounds, const PairOptions& options) {
    const double parts = partsOf(options);
    return {lowerRounded(bounds.lower, parts), upperRounded(bounds.upper, parts)};
}

void writeTriangle(std::ostream& out, const PairOptions& options, const Row& row, const AnswerTable& triangles,
                   std::size_t number) {
    const PairJobs& jobs = options.jobs;
    const Job& job = jobs.jobs[row.job];
    const double parts = partsOf(options);
    const Bounds bounds =
        roundedOutward({triangles.number("lower", number), triangles.number("upper", number)}, options);
    out << row.pose << ',' << io::csvField(jobs.meshes[job.mesh]) << ',' << io::csvField(jobs.volumes[job.volume])
        << ',' << triangles.number("triangle", number) << ','
        << voxtact::number(std::round(triangles.number("whole", number) * parts) / parts) << ','
        << voxtact::number(bounds.lower) << ',' << voxtact::number(bounds.upper) << '\n';
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

// SPDX-License-Identifier: MIT
#include "app/plan/plan_run.h"
#include "app/version.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr std::array kColumns{"entry",        "x",       "y",         "z",         "safe",      "clearance_lo",
                              "clearance_hi", "nearest", "nearest_x", "nearest_y", "nearest_z", "length",
                              "angle",        "crosses"};

/// A nanometre: more digits say nothing.
io::Cell millimetres(double value) {
    constexpr double kParts = 1e6;
    return std::isfinite(value) ? std::round(value * kParts) / kParts + 0.0 : value;
}

/// Bounds are rounded away from each other.
double roundedTo(double value, double (*round)(double)) {
    constexpr double kParts = 1e6;
    return std::isfinite(value) ? round(value * kParts) / kParts : value;
}

io::Cell safetyCell(Safety safety) {
    return io::NumberWord{static_cast<std::uint64_t>(safety), toString(safety)};
}

std::string nearestText(const PlanInputs& inputs, const NearestObstacle& nearest) {
    return inputs.obstacles[nearest.obstacle].labels != nullptr ? labelText(*inputs.labels, nearest.label) : "opaque";
}

std::string crossed(const PlanInputs& inputs, const PlannedPath& path) {
    std::string out;
    const Result<std::vector<std::int32_t>> labels =
        labelsAlong(inputs.labels->labels, path.position, inputs.task.target);
    if (!labels.ok()) {
        throw std::bad_alloc(); // the plan has looked at all that can be refused
    }
    for (const std::int32_t label : *labels) {
        out += (out.empty() ? "" : ";") + labelText(*inputs.labels, label);
    }
    return out;
}

io::Cell cellOf(const PlanInputs& inputs, const PlannedPath& path, std::size_t column) {
    switch (column) {
    case 0:
        return std::uint64_t{path.entry};
    case 1:
    case 2:
    case 3:
        return millimetres(path.position[column - 1]);
    case 4:
        return safetyCell(path.safety);
    case 5:
        return roundedTo(path.clearance.lo, std::floor);
    case 6:
        return roundedTo(path.clearance.hi, std::ceil);
    case 7:
        return path.nearest ? io::Cell(nearestText(inputs, *path.nearest)) : io::Cell();
    case 8:
    case 9:
    case 10:
        return path.nearest ? millimetres(path.nearest->position[column - 8]) : io::Cell();
    case 11:
        return millimetres(path.length);
    case 12:
        return path.angle ? millimetres(*path.angle) : io::Cell();
    default:
        return inputs.labels ? io::Cell(crossed(inputs, path)) : io::Cell();
    }
}

} // namespace

io::Table planTable(const PlanInputs& inputs, const PlanAnswer& answer, bool timing) {
    io::Table out;
    out.columns = {kColumns.begin(), kColumns.end()};
    out.rows = answer.paths.size();
    out.cell = [&](std::size_t row, std::size_t column) { return cellOf(inputs, answer.paths[row], column); };
    const Vec3& target = inputs.task.target;
    out.facts = {{"voxtact", std::string(programVersion())},
                 {"target_x", target[0]},
                 {"target_y", target[1]},
                 {"target_z", target[2]},
                 {"margin", inputs.task.margin},
                 {"directions", std::uint64_t{answer.directions}},
                 {"no_surface", std::uint64_t{answer.noSurface}},
                 {"too_long", std::uint64_t{answer.tooLong}},
                 {"too_oblique", std::uint64_t{answer.tooOblique}},
                 {"area_mm2", answer.area},
                 {"safe_area_mm2", inputs.task.mesh ? io::Cell() : io::Cell(answer.safeArea)}};
    if (timing) {
        out.timing = {{"entries", std::uint64_t{answer.paths.size()}},
                      {"wall_ms", answer.wallMilliseconds},
                      {"entries_per_s", 1000 * static_cast<double>(answer.paths.size()) / answer.wallMilliseconds}};
    }
    return out;
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "cli/pairs/extra_outputs.h"
#include "cli/plan/plan_run.h"
#include "cli/version.h"
#include "core/base/outward.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr std::array kColumns{"entry",     "x",         "y",         "z",      "safe",  "lower",   "upper", "nearest",
                              "nearest_x", "nearest_y", "nearest_z", "length", "angle", "crosses", "target"};
constexpr std::array kTargetColumns{"target",    "x",          "y",           "z",          "paths",
                                    "safe",      "unsafe",     "undecided",   "directions", "no_surface",
                                    "on_border", "too_long",   "too_oblique", "area_mm2",   "safe_area_mm2",
                                    "best",      "best_lower", "best_length"};

/// Steps per mm: more digits than a nanometre have no meaning.
io::Cell millimetres(double value) {
    constexpr double kParts = 1e6;
    return std::isfinite(value) ? std::round(value * kParts) / kParts + 0.0 : value;
}

/// Rounds bounds outward.
double roundedTo(double value, double (*round)(double value, double parts)) {
    constexpr double kParts = 1e6;
    return std::isfinite(value) ? round(value, kParts) : value;
}

io::Cell safetyCell(Safety safety) {
    return io::NumberWord{static_cast<std::uint64_t>(safety), toString(safety)};
}

std::string nearestText(const PlanInputs& inputs, const NearestObstacle& nearest) {
    return inputs.obstacles[nearest.obstacle].labels != nullptr ? labelName(inputs.labels->names, nearest.label)
                                                                : "opaque";
}

std::string crossed(const PlanInputs& inputs, const PlanTarget& target, const PlannedPath& path) {
    std::string out;
    const Result<std::vector<std::int32_t>> labels = labelsAlong(inputs.labels->labels, path.position, target.at);
    if (!labels.ok()) {
        throw std::bad_alloc(); // the plan has checked all arguments
    }
    for (const std::int32_t label : *labels) {
        out += (out.empty() ? "" : ";") + labelName(inputs.labels->names, label);
    }
    return out;
}

io::Cell cellOf(const PlanInputs& inputs, const PlanTarget& target, const PlannedPath& path, std::size_t column) {
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
        return roundedTo(path.clearance.lower, lowerRounded);
    case 6:
        return roundedTo(path.clearance.upper, upperRounded);
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
    case 13:
        return inputs.labels ? io::Cell(crossed(inputs, target, path)) : io::Cell();
    default:
        return target.name;
    }
}

io::Cell countCell(const PlanAnswer& answer, Safety safety) {
    return static_cast<std::uint64_t>(std::ranges::count(answer.paths, safety, &PlannedPath::safety));
}

/// Rounds a certain area down, to 0.01 mm^2.
io::Cell areaCell(double area) {
    constexpr double kParts = 100;
    return lowerRounded(area, kParts);
}

io::Cell bestCell(const TargetPlan& plan, std::size_t which) {
    const std::vector<ChosenPath> best = rankedPaths(std::span(&plan, 1), 1);
    if (best.empty()) {
        return {};
    }
    const PlannedPath& path = *best.front().path;
    return which == 0   ? io::Cell(std::uint64_t{path.entry})
           : which == 1 ? io::Cell(roundedTo(path.clearance.lower, lowerRounded))
                        : millimetres(path.length);
}

io::Cell targetCell(const PlanInputs& inputs, const TargetPlan& plan, std::size_t column) {
    const PlanAnswer& answer = plan.answer;
    switch (column) {
    case 0:
        return plan.target.name;
    case 1:
    case 2:
    case 3:
        return millimetres(plan.target.at[column - 1]);
    case 4:
        return std::uint64_t{answer.paths.size()};
    case 5:
        return countCell(answer, Safety::Safe);
    case 6:
        return countCell(answer, Safety::Unsafe);
    case 7:
        return countCell(answer, Safety::Undecided);
    case 8:
        return std::uint64_t{answer.directions};
    case 9:
        return std::uint64_t{answer.noSurface};
    case 10:
        return std::uint64_t{answer.onBorder};
    case 11:
        return std::uint64_t{answer.tooLong};
    case 12:
        return std::uint64_t{answer.tooOblique};
    case 13:
        return areaCell(answer.area);
    case 14:
        return inputs.task.mesh ? io::Cell() : areaCell(answer.safeArea);
    default:
        return bestCell(plan, column - 15);
    }
}

/// Appends the column of --resample.
void addResampled(const PlanInputs& inputs, io::Table& table) {
    if (!inputs.isResampled) {
        return;
    }
    table.cell = [last = table.columns.size(), is = *inputs.isResampled,
                  cell = std::move(table.cell)](std::size_t row, std::size_t column) {
        return column == last ? resampledCell(is) : cell(row, column);
    };
    table.columns.emplace_back(kResampledColumn);
}

} // namespace

io::Table planTable(const PlanInputs& inputs, std::span<const TargetPlan> plans, bool timing) {
    io::Table out;
    out.columns = {kColumns.begin(), kColumns.end()};
    std::vector<std::size_t> firsts; // first row of each plan
    double milliseconds = 0;
    for (const TargetPlan& plan : plans) {
        firsts.push_back(out.rows);
        out.rows += plan.answer.paths.size();
        milliseconds += plan.answer.wallMilliseconds;
    }
    out.cell = [&inputs, plans, firsts](std::size_t row, std::size_t column) {
        const auto number = static_cast<std::size_t>(std::ranges::upper_bound(firsts, row) - firsts.begin()) - 1;
        const TargetPlan& plan = plans[number];
        return cellOf(inputs, plan.target, plan.answer.paths[row - firsts[number]], column);
    };
    addResampled(inputs, out);
    out.facts = {{"voxtact", std::string(programVersion())},
                 {"margin", inputs.task.margin},
                 {"targets", std::uint64_t{inputs.targets.size()}}};
    if (timing) {
        const double perSecond = 1000 * static_cast<double>(out.rows) / milliseconds;
        out.timing = {{"entries", std::uint64_t{out.rows}},
                      {"wall_ms", rounded(milliseconds, 1e6)},
                      {"entries_per_s", rounded(milliseconds > 0 ? perSecond : 0, 10)}};
    }
    return out;
}

io::Table targetTable(const PlanInputs& inputs, std::span<const TargetPlan> plans) {
    io::Table out;
    out.columns = {kTargetColumns.begin(), kTargetColumns.end()};
    out.rows = plans.size();
    out.cell = [&inputs, plans](std::size_t row, std::size_t column) { return targetCell(inputs, plans[row], column); };
    addResampled(inputs, out);
    return out;
}

void writePlanTable(std::ostream& out, const PlanOptions& options, const PlanInputs& inputs,
                    std::span<const TargetPlan> plans) {
    const io::Table rows = planTable(inputs, plans, options.timing);
    io::TableWriter writer(out, options.output.format());
    if (!options.shard.hasHead()) {
        writer.omitHead();
    }
    writer.add(rows);
    if (options.output.format() == io::Format::Json) {
        writer.beginArray("by_target");
        writer.add(targetTable(inputs, plans));
    }
    const io::TableEnd end{"timing", rows.timing};
    writer.end({&end, 1});
}

void writeTargetTable(std::ostream& out, const PlanOptions& options, const PlanInputs& inputs,
                      std::span<const TargetPlan> plans) {
    io::TableWriter writer(out, io::Format::Csv);
    if (!options.shard.hasHead()) {
        writer.omitHead();
    }
    writer.add(targetTable(inputs, plans));
    writer.end();
}

} // namespace voxtact::app

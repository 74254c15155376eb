// SPDX-License-Identifier: MIT
#include "app/detect/detect_table.h"

#include "app/detect/detect_files.h"
#include "app/version.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

io::Cell verdictOf(const PairAnswer& answer) {
    return answer.hit        ? io::NumberWord{1, "yes"}
           : answer.possible ? io::NumberWord{2, "possible"}
                             : io::NumberWord{0, "no"};
}

} // namespace

void DetectColumns::addClearance() {
    columns_.push_back({"clearance_lo", [](const Row& row) {
                            return row.clearance ? io::Cell(roundedOutward(row.clearance->bounds).lo) : io::Cell();
                        }});
    columns_.push_back({"clearance_hi", [](const Row& row) {
                            return row.clearance ? io::Cell(roundedOutward(row.clearance->bounds).hi) : io::Cell();
                        }});
}

void DetectColumns::addArea(double tolerance) {
    columns_.push_back({"area_lo", [tolerance](const Row& row) {
                            return row.area ? io::Cell(roundedOutward(row.area->bounds, tolerance).lo) : io::Cell();
                        }});
    columns_.push_back({"area_hi", [tolerance](const Row& row) {
                            return row.area ? io::Cell(roundedOutward(row.area->bounds, tolerance).hi) : io::Cell();
                        }});
}

DetectColumns::DetectColumns(const DetectOptions& options, const DetectInputs& inputs) {
    const PairJobs& jobs = options.jobs;
    columns_ = {
        {"pose", [](const Row& row) { return row.pose; }},
        {"mesh", [&](const Row& row) { return jobs.meshes[jobs.jobs[row.job].mesh]; }},
        {"volume", [&](const Row& row) { return jobs.volumes[jobs.jobs[row.job].volume]; }},
        {"hit", [](const Row& row) { return verdictOf(row.timed.answer); }},
        {"count", [](const Row& row) { return row.timed.answer.count; }},
        {"exact",
         [](const Row& row) { return std::uint64_t{row.timed.answer.exactness == Exactness::Exact ? 1U : 0U}; }},
        {"method", [](const Row& row) { return std::string(toString(row.timed.answer.method)); }},
        {"projection", [](const Row& row) { return std::string(toString(row.timed.answer.projection)); }}};
    for (ExtraColumn& extra : extraColumns(options.extra.outputs(), inputs.labelNames)) {
        columns_.push_back({extra.name, [cell = std::move(extra.cell)](const Row& row) { return cell(row.extra); }});
    }
    if (options.distance.area) {
        addArea(options.distance.areaGoal());
    }
    if (options.distance.clearance) {
        addClearance();
    }
    if (options.timing) {
        columns_.push_back({"gpu_ms", [](const Row& row) {
                                const std::optional<double>& gpu = row.timed.gpuMilliseconds;
                                return gpu ? io::Cell(rounded(*gpu, 1e6)) : io::Cell();
                            }});
        columns_.push_back({"wall_ms", [](const Row& row) { return rounded(row.timed.wallMilliseconds, 1e6); }});
    }
    if (jobs.fromFile) {
        columns_.push_back({"job", [](const Row& row) { return std::uint64_t{row.job}; }});
    }
    for (const Column& column : columns_) {
        names_.push_back(column.name);
    }
}

io::Table DetectColumns::table(std::span<const Row> rows) const {
    io::Table table;
    table.columns = names_;
    table.rows = rows.size();
    table.cell = [this, rows](std::size_t row, std::size_t column) { return columns_[column].cell(rows[row]); };
    return table;
}

io::NamedCells statsCells(const CertifiedCounters& counters) {
    const auto number = [](std::uint64_t count) { return io::Cell(count); };
    return {{"clusters", number(counters.clusters)},
            {"clusters_kept", number(counters.clustersKept)},
            {"runs_kept", number(counters.runsKept)},
            {"large_parts", number(counters.largeParts)},
            {"bricks_seen", number(counters.bricksSeen)},
            {"cells_seen", number(counters.cellsSeen)},
            {"cells_listed", number(counters.cellsListed)},
            {"cells_certain", number(counters.cellsCertain)},
            {"cells_decided", number(counters.cellsDecided)},
            {"lanes", number(counters.lanes)},
            {"cells_open", number(counters.cellsOpen)},
            {"left", number(counters.left)},
            {"bricks_left", number(counters.bricksLeft)},
            {"cells_left", number(counters.cellsLeft)},
            {"rounds", number(counters.rounds)},
            {"room", number(counters.room)},
            {"most_clusters", number(counters.mostClusters)},
            {"most_runs", number(counters.mostRuns)},
            {"most_parts", number(counters.mostParts)},
            {"most_cells", number(counters.mostCells)},
            {"most_open", number(counters.mostOpen)},
            {"most_left", number(counters.mostLeft)},
            {"most_looks", number(counters.mostLooks)},
            {"most_looks_left", number(counters.mostLooksLeft)}};
}

io::NamedCells detectFacts(const std::string& device, const std::string& driver) {
    return {{"voxtact", programVersion()}, {"device", device}, {"driver", driver}};
}

std::string labelName(const DetectInputs& inputs, std::int32_t label) {
    return labelName(inputs.labelNames, label);
}

} // namespace voxtact::app

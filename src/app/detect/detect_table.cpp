// SPDX-License-Identifier: MIT
#include "app/detect/detect_table.h"

#include "app/detect/detect_files.h"
#include "app/version.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

/// To so many parts of one, so that the shortest text for it is short.
double rounded(double value, double parts) {
    return std::round(value * parts) / parts;
}

/// The background says nothing where there is something else.
std::vector<io::NamedCount> labelsOf(const DetectInputs& inputs, const Row& row) {
    const bool onlyBackground =
        std::all_of(row.labels.begin(), row.labels.end(), [](const LabelCount& entry) { return entry.label == 0; });
    std::vector<io::NamedCount> counts;
    for (const LabelCount& entry : row.labels) {
        if (entry.label != 0 || onlyBackground) {
            counts.push_back({entry.label, labelName(inputs, entry.label), entry.count});
        }
    }
    std::stable_sort(counts.begin(), counts.end(),
                     [](const io::NamedCount& a, const io::NamedCount& b) { return a.count > b.count; });
    return counts;
}

io::Cell verdictOf(const PairAnswer& answer) {
    return answer.hit        ? io::NumberWord{1, "yes"}
           : answer.possible ? io::NumberWord{2, "possible"}
                             : io::NumberWord{0, "no"};
}

/// JSON has no infinity: it is a word there.
io::Cell millimetres(double value) {
    return std::isinf(value) ? io::Cell(std::string("inf")) : io::Cell(value);
}

} // namespace

void DetectColumns::addClearance() {
    columns_.push_back({"clearance_lo", [](const Row& row) {
                            return row.clearance ? millimetres(roundedOutward(row.clearance->bounds).lo) : io::Cell();
                        }});
    columns_.push_back({"clearance_hi", [](const Row& row) {
                            return row.clearance ? millimetres(roundedOutward(row.clearance->bounds).hi) : io::Cell();
                        }});
}

void DetectColumns::addBounds() {
    for (const bool upper : {false, true}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            columns_.push_back({std::string(upper ? "max_" : "min_") + "xyz"[axis], [upper, axis](const Row& row) {
                                    return row.bounds
                                               ? io::Cell(rounded((upper ? row.bounds->hi : row.bounds->lo)[axis], 1e6))
                                               : io::Cell();
                                }});
        }
    }
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
    const Outputs outputs = options.extra.outputs();
    if (outputs.triangles) {
        columns_.push_back({"triangles", [](const Row& row) { return row.triangles; }});
    }
    if (outputs.contacts) {
        columns_.push_back({"contacts", [](const Row& row) { return row.contacts; }});
        columns_.push_back({"depth", [](const Row& row) {
                                return row.contacts > 0 ? io::Cell(rounded(row.depth, 1e6)) : io::Cell();
                            }});
    }
    if (outputs.labels) {
        columns_.push_back({"labels", [&](const Row& row) { return labelsOf(inputs, row); }});
    }
    if (outputs.bounds) {
        addBounds();
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
    const auto found = inputs.labelNames.find(label);
    return found == inputs.labelNames.end() ? std::to_string(label) : found->second;
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "cli/pairs/pair_table.h"

#include "cli/output/text_for_messages.h"
#include "cli/version.h"

#include <cmath>
#include <memory>

namespace voxtact::app {

namespace {

/// A nanometre: more digits say nothing.
constexpr double kParts = 1e6;

io::Cell verdictOf(const PairAnswer& answer) {
    return answer.hit        ? io::NumberWord{1, "yes"}
           : answer.possible ? io::NumberWord{2, "undecided"}
                             : io::NumberWord{0, "no"};
}

io::Cell pathCell(const std::string& path) {
    return io::PathName{path, fileNameOf(path)};
}

/// A certified no counts nothing, whatever an early exit would have left out.
bool isExact(const PairAnswer& answer) {
    const bool isNo = !answer.hit && !answer.possible && answer.projection == Projection::Certified;
    return answer.exactness == Exactness::Exact || (answer.exactness == Exactness::LowerBound && isNo);
}

/// A cell's integer cannot be negative, which a label can.
io::Cell labelCell(std::int32_t label) {
    return label < 0 ? io::Cell(static_cast<double>(label)) : io::Cell(static_cast<std::uint64_t>(label));
}

} // namespace

PairColumns::PairColumns(const PairOptions& options, const PairInputs& inputs) {
    const PairJobs& jobs = options.jobs;
    columns_ = {{"pose", [](const Line& line) { return line.row->pose; }},
                {"mesh", [&](const Line& line) { return pathCell(jobs.meshes[jobs.jobs[line.row->job].mesh]); }},
                {"volume", [&](const Line& line) { return pathCell(jobs.volumes[jobs.jobs[line.row->job].volume]); }}};
    if (options.measures()) {
        addMeasured(options, inputs);
    } else {
        columns_.push_back({"touch", [](const Line& line) { return verdictOf(line.row->timed.answer); }});
        options.question == Question::Touch ? addTouch(inputs) : addCount(options, inputs);
    }
    if (options.resample) {
        columns_.push_back({kResampledColumn, [&](const Line& line) {
                                return resampledCell(inputs.isResampled[jobs.jobs[line.row->job].volume] != 0);
                            }});
    }
    if (options.timing) {
        columns_.push_back({"gpu_ms", [](const Line& line) {
                                const std::optional<double>& gpu = line.row->timed.gpuMilliseconds;
                                return gpu ? io::Cell(rounded(*gpu, 1e6)) : io::Cell();
                            }});
        columns_.push_back(
            {"wall_ms", [](const Line& line) { return rounded(line.row->timed.wallMilliseconds, 1e6); }});
    }
    for (const Column& column : columns_) {
        names_.push_back(column.name);
    }
}

void PairColumns::addTouch(const PairInputs& inputs) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        columns_.push_back({std::string(1, "xyz"[axis]), [axis](const Line& line) {
                                const std::optional<WitnessPoint>& witness = line.row->witness;
                                return witness ? io::Cell(rounded(witness->position[axis], kParts) + 0.0) : io::Cell();
                            }});
    }
    columns_.push_back({"triangle", [](const Line& line) {
                            const std::optional<WitnessPoint>& witness = line.row->witness;
                            return witness && witness->triangle != kInsideMesh
                                       ? io::Cell(std::uint64_t{witness->triangle})
                                       : io::Cell();
                        }});
    const auto labelOf = [&inputs](const Line& line) {
        return inputs.labels->values[labelAt(*inputs.labels, line.row->witness->position)];
    };
    columns_.push_back({"label", [&inputs, labelOf](const Line& line) {
                            return inputs.labels && line.row->witness ? labelCell(labelOf(line)) : io::Cell();
                        }});
    if (!inputs.labelNames.empty()) {
        columns_.push_back({"label_name", [&inputs, labelOf](const Line& line) {
                                return line.row->witness ? io::Cell(labelName(inputs, labelOf(line))) : io::Cell();
                            }});
    }
}

void PairColumns::addCount(const PairOptions& options, const PairInputs& inputs) {
    const auto add = [this](const char* name, auto cell) {
        columns_.push_back({name, [cell](const Line& line) { return io::Cell(cell(line.row->timed.answer)); }});
    };
    add("count", [](const PairAnswer& answer) { return answer.count; });
    add("count_exact", [](const PairAnswer& answer) { return std::uint64_t{isExact(answer) ? 1U : 0U}; });
    add("method", [](const PairAnswer& answer) { return std::string(toString(answer.method)); });
    add("projection", [](const PairAnswer& answer) { return std::string(toString(answer.projection)); });
    for (ExtraColumn& extra : extraColumns(options.extra.outputs(), inputs.labelNames)) {
        columns_.push_back(
            {extra.name, [cell = std::move(extra.cell)](const Line& line) { return cell(line.row->extra); }});
    }
}

void PairColumns::addMeasured(const PairOptions& options, const PairInputs& inputs) {
    if (options.byLabel()) {
        columns_.push_back({"label", [](const Line& line) { return labelCell(line.measured->label); }});
        if (!inputs.labelNames.empty()) {
            columns_.push_back(
                {"label_name", [&inputs](const Line& line) { return labelName(inputs, line.measured->label); }});
        }
    }
    if (!options.measure.bands.empty()) {
        const std::vector<double>& limits = options.measure.bands;
        columns_.push_back({"from", [&limits](const Line& line) {
                                const std::uint32_t band = line.measured->band;
                                return band == 0 ? io::Cell() : io::Cell(limits[band - 1]);
                            }});
        columns_.push_back({"below", [&limits](const Line& line) {
                                const std::uint32_t band = line.measured->band;
                                return band == limits.size() ? io::Cell() : io::Cell(limits[band]);
                            }});
    }
    columns_.push_back({"lower", [](const Line& line) { return line.measured->lower; }});
    columns_.push_back({"upper", [](const Line& line) { return line.measured->upper; }});
    if (options.question == Question::Overlap && options.measure.bands.empty()) {
        columns_.push_back({"inside", [](const Line& line) { return std::string(toString(line.measured->inside)); }});
        if (!options.byLabel()) {
            columns_.push_back({"solid_lower", [](const Line& line) { return line.measured->solid.lower; }});
            columns_.push_back({"solid_upper", [](const Line& line) { return line.measured->solid.upper; }});
        }
    }
}

io::Table PairColumns::table(std::span<const Row> rows) const {
    const auto lines = std::make_shared<std::vector<Line>>();
    for (const Row& row : rows) {
        for (const Measured& measured : row.measured) {
            lines->push_back({&row, &measured});
        }
        if (row.measured.empty()) {
            lines->push_back({&row, nullptr});
        }
    }
    io::Table table;
    table.columns = names_;
    table.rows = lines->size();
    table.cell = [this, lines](std::size_t row, std::size_t column) { return columns_[column].cell((*lines)[row]); };
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

io::NamedCells pairFacts(const PairOptions& options, const std::string& device, const std::string& driver) {
    io::NamedCells facts{{"voxtact", programVersion()},
                         {"device", device},
                         {"driver", driver},
                         {"question", std::string(toString(options.question))},
                         {"opacity_threshold", options.transferFunction.threshold}};
    const auto addGiven = [&facts](const char* name, const std::string& text) {
        if (!text.empty()) {
            facts.emplace_back(name, text);
        }
    };
    addGiven("opacity", options.transferFunction.opacity.value_or(""));
    addGiven("transfer_function", options.transferFunction.path.string());
    addGiven("poses", options.view.poses.string());
    addGiven("labels", options.labels.path.string());
    if (options.touch.margin) {
        facts.emplace_back("margin", *options.touch.margin);
    }
    if (options.touch.uncertainty) {
        facts.emplace_back("uncertainty_mm", options.touch.uncertainty->distance);
        facts.emplace_back("uncertainty_degrees", options.touch.uncertainty->angle);
    }
    if (options.measures()) {
        facts.emplace_back("tolerance", options.measure.tolerance);
    }
    if (options.question == Question::Distance) {
        facts.emplace_back("max", options.measure.maximum);
    }
    if (options.question == Question::Count) {
        facts.emplace_back("resolution", options.method.resolution.value_or(kDefaultResolution));
    }
    return facts;
}

std::string labelName(const PairInputs& inputs, std::int32_t label) {
    return labelName(inputs.labelNames, label);
}

} // namespace voxtact::app

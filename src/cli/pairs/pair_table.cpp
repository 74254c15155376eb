// SPDX-License-Identifier: MIT
#include "cli/pairs/pair_table.h"

#include "cli/files/pair_files.h"
#include "cli/output/text_for_messages.h"
#include "cli/version.h"

#include <cmath>
#include <memory>

namespace voxtact::app {

namespace {

/// Steps per mm: more digits than a nanometre have no meaning.
constexpr double kParts = 1e6;

io::Cell verdictOf(const PairAnswer& answer) {
    return answer.hit        ? io::NumberWord{1, "yes"}
           : answer.possible ? io::NumberWord{2, "undecided"}
                             : io::NumberWord{0, "no"};
}

io::Cell pathCell(const std::string& path) {
    return io::PathName{path, fileNameOf(path)};
}

/// The count of a certified no is exactly 0, also after an early exit.
bool isExact(const PairAnswer& answer) {
    const bool isNo = !answer.hit && !answer.possible && answer.projection == Projection::Certified;
    return answer.exactness == Exactness::Exact || (answer.exactness == Exactness::LowerBound && isNo);
}

/// A label may be negative, which the integer of a cell cannot.
io::Cell labelCell(std::int32_t label) {
    return label < 0 ? io::Cell(static_cast<double>(label)) : io::Cell(static_cast<std::uint64_t>(label));
}

/// Returns the name of a number among comma-separated ones.
std::string choiceOf(std::string_view choices, std::size_t number) {
    for (; number > 0; --number) {
        choices.remove_prefix(choices.find(',') + 1);
    }
    return std::string(choices.substr(0, choices.find(',')));
}

io::Cell cellOf(const AnswerTable& table, const Column& column, std::size_t row, const PairOptions& options) {
    const double value = table.number(column, row);
    if (column.printed != Printed::Plain) {
        const Bounds bounds = roundedOutward({value, value}, options);
        return column.printed == Printed::Down ? bounds.lower : bounds.upper;
    }
    if (*column.choices != '\0') {
        return choiceOf(column.choices, static_cast<std::size_t>(value));
    }
    if (column.type == ColumnType::Double) {
        return std::isfinite(value) ? io::Cell(value) : io::Cell();
    }
    return column.type == ColumnType::Int32 ? labelCell(static_cast<std::int32_t>(value))
                                            : io::Cell(static_cast<std::uint64_t>(value));
}

} // namespace

PairColumns::PairColumns(const PairOptions& options, const PairInputs& inputs) {
    const PairJobs& jobs = options.jobs;
    columns_ = {{"pose", [](const Line& line) { return line.row->pose; }},
                {"mesh", [&](const Line& line) { return pathCell(jobs.meshes[jobs.jobs[line.row->job].mesh]); }},
                {"volume", [&](const Line& line) { return pathCell(jobs.volumes[jobs.jobs[line.row->job].volume]); }}};
    if (options.question.measures) {
        addMeasured(options, inputs);
    } else {
        columns_.push_back({"touch", [](const Line& line) { return verdictOf(line.row->timed.answer); }});
        options.isTouch() ? addTouch(inputs) : addCount(options, inputs);
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
    for (const PrintedColumn& column : columns_) {
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
    for (const Column& column : options.question.table(options.measure.settings.table())->columns) {
        if (column.printed == Printed::No) {
            continue;
        }
        columns_.push_back({column.name, [&column, &options](const Line& line) {
                                return cellOf(*line.measured->table, column, line.measured->row, options);
                            }});
        if (column.type == ColumnType::Int32 && !inputs.labelNames.empty()) {
            columns_.push_back({"label_name", [&column, &inputs](const Line& line) {
                                    const double label = line.measured->table->number(column, line.measured->row);
                                    return labelName(inputs, static_cast<std::int32_t>(label));
                                }});
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
            {"peak_clusters", number(counters.peakClusters)},
            {"peak_runs", number(counters.peakRuns)},
            {"peak_parts", number(counters.peakParts)},
            {"peak_cells", number(counters.peakCells)},
            {"peak_open", number(counters.peakOpen)},
            {"peak_left", number(counters.peakLeft)},
            {"peak_tests", number(counters.peakTests)},
            {"peak_tests_left", number(counters.peakTestsLeft)}};
}

io::NamedCells pairFacts(const PairOptions& options, const std::string& device, const std::string& driver) {
    io::NamedCells facts{{"voxtact", programVersion()},
                         {"device", device},
                         {"driver", driver},
                         {"question", std::string(options.question.name)},
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
    for (const Fact& fact : kFacts) {
        if (options.question.measures && fact.question == options.question.name && fact.kind == FactKind::Number &&
            !fact.option.empty()) {
            facts.emplace_back(fact.name, options.measure.settings.number(fact.name));
        }
    }
    if (options.isCount()) {
        facts.emplace_back("resolution", options.method.resolution.value_or(kDefaultResolution));
    }
    return facts;
}

std::string labelName(const PairInputs& inputs, std::int32_t label) {
    return labelName(inputs.labelNames, label);
}

} // namespace voxtact::app

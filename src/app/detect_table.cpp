// SPDX-License-Identifier: MIT
#include "app/detect_files.h"
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
std::vector<NamedCount> labelsOf(const DetectInputs& inputs, const Row& row) {
    const bool onlyBackground =
        std::all_of(row.labels.begin(), row.labels.end(), [](const LabelCount& entry) { return entry.label == 0; });
    std::vector<NamedCount> counts;
    for (const LabelCount& entry : row.labels) {
        if (entry.label != 0 || onlyBackground) {
            counts.push_back({entry.label, labelName(inputs, entry.label), entry.count});
        }
    }
    std::stable_sort(counts.begin(), counts.end(),
                     [](const NamedCount& a, const NamedCount& b) { return a.count > b.count; });
    return counts;
}

Cell verdictOf(const PairAnswer& answer) {
    return answer.hit ? NumberWord{1, "yes"} : answer.possible ? NumberWord{2, "possible"} : NumberWord{0, "no"};
}

struct Column {
    std::string name;
    std::function<Cell(const Row&)> cell;
};

void addBounds(std::vector<Column>& columns) {
    for (const bool upper : {false, true}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            columns.push_back({std::string(upper ? "max_" : "min_") + "xyz"[axis], [upper, axis](const Row& row) {
                                   return row.bounds
                                              ? Cell(rounded((upper ? row.bounds->hi : row.bounds->lo)[axis], 1e6))
                                              : Cell();
                               }});
        }
    }
}

std::vector<Column> columnsOf(const DetectOptions& options, const DetectInputs& inputs) {
    std::vector<Column> columns{
        {"pose", [](const Row& row) { return std::uint64_t{row.timed.pose}; }},
        {"mesh", [&](const Row& row) { return options.meshes.sources[row.timed.item]; }},
        {"volume", [&](const Row& row) { return options.volumes[row.volume]; }},
        {"hit", [](const Row& row) { return verdictOf(row.timed.answer); }},
        {"count", [](const Row& row) { return row.timed.answer.count; }},
        {"exact",
         [](const Row& row) { return std::uint64_t{row.timed.answer.exactness == Exactness::Exact ? 1U : 0U}; }},
        {"method", [](const Row& row) { return std::string(toString(row.timed.answer.method)); }},
        {"projection", [](const Row& row) { return std::string(toString(row.timed.answer.projection)); }}};
    const Outputs outputs = options.extra.outputs();
    if (outputs.triangles) {
        columns.push_back({"triangles", [](const Row& row) { return row.triangles; }});
    }
    if (outputs.contacts) {
        columns.push_back({"contacts", [](const Row& row) { return row.contacts; }});
        columns.push_back(
            {"depth", [](const Row& row) { return row.contacts > 0 ? Cell(rounded(row.depth, 1e6)) : Cell(); }});
    }
    if (outputs.labels) {
        columns.push_back({"labels", [&](const Row& row) { return labelsOf(inputs, row); }});
    }
    if (outputs.bounds) {
        addBounds(columns);
    }
    if (options.timing) {
        columns.push_back({"gpu_ms", [](const Row& row) {
                               const std::optional<double>& gpu = row.timed.gpuMilliseconds;
                               return gpu ? Cell(rounded(*gpu, 1e6)) : Cell();
                           }});
        columns.push_back({"wall_ms", [](const Row& row) { return rounded(row.timed.wallMilliseconds, 1e6); }});
    }
    return columns;
}

} // namespace

std::string labelName(const DetectInputs& inputs, std::int32_t label) {
    const auto found = inputs.labelNames.find(label);
    return found == inputs.labelNames.end() ? std::to_string(label) : found->second;
}

Table makeDetectTable(const DetectOptions& options, const DetectInputs& inputs, const DetectRun& run) {
    std::vector<Column> columns = columnsOf(options, inputs);
    Table table;
    for (const Column& column : columns) {
        table.columns.push_back(column.name);
    }
    table.rows = run.rows.size();
    table.cell = [columns = std::move(columns), &run](std::size_t row, std::size_t column) {
        return columns[column].cell(run.rows[row]);
    };
    table.facts = {{"voxtact", programVersion()}, {"device", run.device}, {"driver", run.driver}};
    if (options.timing) {
        const double seconds = run.wallMilliseconds / 1000;
        const double rate = seconds > 0 ? static_cast<double>(run.rows.size()) / seconds : 0;
        table.timing = {{"pairs", std::uint64_t{run.rows.size()}},
                        {"wall_ms", rounded(run.wallMilliseconds, 1e6)},
                        {"pairs_per_s", rounded(rate, 10)}};
    }
    return table;
}

Result<void> writeDetectOutputs(const DetectOptions& options, const DetectInputs& inputs, const DetectRun& run) {
    std::vector<Delivery> deliveries{{options.output.path, [&](std::ostream& out) -> Result<void> {
                                          writeTable(out, options.output.format(),
                                                     makeDetectTable(options, inputs, run));
                                          return {};
                                      }}};
    if (!options.extra.triangles.empty()) {
        deliveries.push_back({options.extra.triangles, [&](std::ostream& out) -> Result<void> {
                                  writeTriangles(out, options, run);
                                  return {};
                              }});
    }
    if (!options.extra.contacts.empty()) {
        deliveries.push_back({options.extra.contacts, [&](std::ostream& out) -> Result<void> {
                                  if (options.extra.contacts.extension() == ".ply") {
                                      writeContactsPly(out, options, run);
                                  } else {
                                      writeContactsCsv(out, options, inputs, run);
                                  }
                                  return {};
                              }});
    }
    return deliverAll(std::move(deliveries));
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "app/detect_run.h"
#include "app/version.h"

#include <cmath>

namespace voxtact::app {

namespace {

/// To so many parts of one, so that the shortest text for it is short.
double rounded(double value, double parts) {
    return std::round(value * parts) / parts;
}

Cell cellOf(const DetectOptions& options, const Row& row, std::size_t column) {
    const PairAnswer& answer = row.timed.answer;
    switch (column) {
    case 0:
        return std::uint64_t{row.timed.pose};
    case 1:
        return options.meshes.sources[row.timed.item];
    case 2:
        return options.volumes[row.volume];
    case 3:
        return std::uint64_t{answer.hit ? 1U : 0U};
    case 4:
        return answer.count;
    case 5:
        return std::uint64_t{answer.exactness == Exactness::Exact ? 1U : 0U};
    case 6:
        return std::string(toString(answer.method));
    case 7:
        return std::string(toString(answer.projection));
    case 8:
        return row.timed.gpuMilliseconds ? Cell(rounded(*row.timed.gpuMilliseconds, 1e6)) : Cell();
    default:
        return rounded(row.timed.wallMilliseconds, 1e6);
    }
}

} // namespace

Table makeDetectTable(const DetectOptions& options, const DetectRun& run) {
    Table table;
    table.columns = {"pose", "mesh", "volume", "hit", "count", "exact", "method", "projection"};
    table.rows = run.rows.size();
    table.cell = [&](std::size_t row, std::size_t column) { return cellOf(options, run.rows[row], column); };
    table.facts = {{"voxtact", programVersion()}, {"device", run.device}, {"driver", run.driver}};
    if (options.timing) {
        table.columns.insert(table.columns.end(), {"gpu_ms", "wall_ms"});
        const double seconds = run.wallMilliseconds / 1000;
        const double rate = seconds > 0 ? static_cast<double>(run.rows.size()) / seconds : 0;
        table.timing = {{"pairs", std::uint64_t{run.rows.size()}},
                        {"wall_ms", rounded(run.wallMilliseconds, 1e6)},
                        {"pairs_per_s", rounded(rate, 10)}};
    }
    return table;
}

} // namespace voxtact::app

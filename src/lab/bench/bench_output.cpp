// SPDX-License-Identifier: MIT
#include "lab/bench/bench_run.h"

#include "lab/compare/compare_output.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace voxtact::lab {

namespace {

using Json = nlohmann::ordered_json;

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : rounded(100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// Every column, with its name.
io::NamedCells cellsOf(const BenchRow& row) {
    io::NamedCells cells{{"mesh", row.mesh},
                         {"triangles", std::uint64_t{row.triangles}},
                         {"poses", row.poses},
                         {"engine", row.engine.name},
                         {"projection", row.engine.projection},
                         {"question", row.engine.question},
                         {"threads", row.engine.threads > 0 ? io::Cell(std::uint64_t{row.engine.threads}) : io::Cell()},
                         {"pairs", row.pairs},
                         {"contacts", row.contacts},
                         {"missed_percent", percent(row.missed, row.contacts)},
                         {"false_percent", percent(row.wrong, row.untouched)},
                         {"samples", std::uint64_t{row.wallRate.size()}}};
    const std::pair<const char*, const std::vector<double>*> samples[] = {{"pairs_per_s", &row.wallRate},
                                                                          {"pairs_per_cpu_s", &row.cpuRate},
                                                                          {"wall_ratio", &row.wallRatio},
                                                                          {"cpu_ratio", &row.cpuRatio}};
    for (const auto& [name, values] : samples) {
        const Spread spread = spreadOf(*values);
        cells.emplace_back(name, rounded(spread.median));
        cells.emplace_back(std::string(name) + "_min", rounded(spread.min));
        cells.emplace_back(std::string(name) + "_max", rounded(spread.max));
    }
    return cells;
}

/// What is left out of a table for people, to fit on a wide terminal.
constexpr std::array kNotInText{"triangles",           "pairs",      "samples",        "pairs_per_cpu_s_min",
                                "pairs_per_cpu_s_max", "wall_ratio", "wall_ratio_min", "wall_ratio_max"};

io::Table benchTable(const BenchResult& result, io::Format format) {
    return tableOf(rowsOf(result.rows, [format](const BenchRow& row) {
        io::NamedCells cells = cellsOf(row);
        if (format == io::Format::Text) {
            std::erase_if(
                cells, [](const auto& cell) { return std::ranges::find(kNotInText, cell.first) != kNotInText.end(); });
        }
        return cells;
    }));
}

std::string shortText(double value) {
    std::ostringstream text;
    text << std::setprecision(3) << value;
    return text.str();
}

/// How the first engine of each scene, yes or no on one thread, does beside FCL.
std::vector<std::string> sentences(const BenchResult& result) {
    std::vector<std::string> out;
    for (const BenchRow& row : result.rows) {
        if (row.engine.projection != "octree") {
            continue;
        }
        const Spread spread = spreadOf(row.cpuRatio);
        out.push_back(row.mesh + ", poses " + row.poses + ": cpu yes/no answers for " + shortText(1 / spread.median) +
                      " (" + shortText(1 / spread.max) + " to " + shortText(1 / spread.min) + ") times the pairs of " +
                      row.engine.name + " in the same CPU time; that misses " +
                      shortText(percent(row.missed, row.contacts)) + " % of the contacts, and calls " +
                      shortText(percent(row.wrong, row.untouched)) + " % of what does not touch one");
    }
    return out;
}

Json benchJson(const BenchSettings& settings, const BenchResult& result) {
    Json json = provenanceJson(result.machine);
    json["machine"] = machineJson(result.machine);
    json["scene"] = {{"volume", result.volume},
                     {"voxels", result.voxels},
                     {"threshold", result.threshold},
                     {"poses", settings.poses},
                     {"seed", settings.seed}};
    json["summary"] = sentences(result);
    json["repetitions"] = settings.repetitions;
    json["rows"] = io::rowsJson(benchTable(result, io::Format::Json));
    json["notes"] = allNotes(result.machine, result.notes);
    return json;
}

} // namespace

void writeBench(std::ostream& out, io::Format format, const BenchSettings& settings, const BenchResult& result) {
    if (format == io::Format::Json) {
        out << benchJson(settings, result).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    io::writeTable(out, format, benchTable(result, format));
    out << "# volume " << result.volume
        << (settings.mode == BenchMode::Outputs ? ", ratios of projections to the view by the same method, of outputs "
                                                  "to the bare count, round by round\n"
                                                : ", ratios to the first engine of each scene, round by round\n");
    for (const std::string& sentence : sentences(result)) {
        out << "# " << sentence << '\n';
    }
    writeMachine(out, result.machine, result.notes);
}

} // namespace voxtact::lab

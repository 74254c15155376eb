// SPDX-License-Identifier: MIT
#include "app/bench_run.h"

#include "app/compare_output.h"
#include "app/version.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace voxtact::app {

namespace {

using Json = nlohmann::ordered_json;

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : rounded(100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// Every column, with its name.
NamedCells cellsOf(const BenchRow& row) {
    NamedCells cells{{"mesh", row.mesh},
                     {"triangles", std::uint64_t{row.triangles}},
                     {"poses", row.poses},
                     {"engine", row.engine.name},
                     {"projection", row.engine.projection},
                     {"question", row.engine.question},
                     {"threads", row.engine.threads > 0 ? Cell(std::uint64_t{row.engine.threads}) : Cell()},
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

Table tableOf(const BenchResult& result, Format format) {
    Table table;
    std::vector<std::size_t> shown;
    const NamedCells all = cellsOf(result.rows.front());
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (format != Format::Text || std::ranges::find(kNotInText, all[i].first) == kNotInText.end()) {
            table.columns.push_back(all[i].first);
            shown.push_back(i);
        }
    }
    table.rows = result.rows.size();
    table.cell = [rows = &result.rows, shown](std::size_t row, std::size_t column) {
        return cellsOf((*rows)[row])[shown[column]].second;
    };
    return table;
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

Json benchJson(const BenchOptions& options, const BenchResult& result) {
    Json json{{"voxtact", programVersion()}, {"git_revision", gitRevision()}, {"command", options.command}};
    json["machine"] = machineJson(result.machine);
    json["scene"] = {{"volume", result.volume},
                     {"voxels", result.voxels},
                     {"threshold", options.transferFunction.threshold},
                     {"poses", options.poses},
                     {"seed", options.seed}};
    json["summary"] = sentences(result);
    json["repetitions"] = options.repetitions;
    json["rows"] = rowsJson(tableOf(result, Format::Json));
    json["notes"] = allNotes(result.machine, result.notes);
    return json;
}

} // namespace

void writeBench(std::ostream& out, const BenchOptions& options, const BenchResult& result) {
    const Format format = options.output.format();
    if (format == Format::Json) {
        out << benchJson(options, result).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    writeTable(out, format, tableOf(result, format));
    out << "# volume " << result.volume
        << (options.mode == BenchMode::Outputs ? ", ratios of projections to the view by the same method, of outputs "
                                                 "to the bare count, round by round\n"
                                               : ", ratios to the first engine of each scene, round by round\n");
    for (const std::string& sentence : sentences(result)) {
        out << "# " << sentence << '\n';
    }
    writeMachine(out, result.machine, result.notes);
}

} // namespace voxtact::app

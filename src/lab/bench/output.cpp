// SPDX-License-Identifier: MIT
#include "lab/bench/bench.h"

#include "lab/measure/columns.h"

#include <iomanip>
#include <ostream>
#include <sstream>

namespace voxtact::lab {

namespace {

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : rounded(100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

Row rowOf(const BenchRow& row) {
    Row out;
    out.add("mesh", row.mesh)
        .add("triangles", row.triangles)
        .add("poses", row.poses)
        .add("engine", row.engine.name)
        .add("projection", row.engine.projection)
        .add("question", row.engine.question)
        .add("threads", row.engine.threads > 0 ? std::optional(row.engine.threads) : std::nullopt)
        .add("pairs", row.pairs)
        .add("contacts", row.contacts)
        .add("missed_percent", percent(row.missed, row.contacts))
        .add("false_percent", percent(row.wrong, row.untouched))
        .add("samples", row.wallRate.size());
    const std::pair<const char*, const std::vector<double>*> samples[] = {{"pairs_per_s", &row.wallRate},
                                                                          {"pairs_per_cpu_s", &row.cpuRate},
                                                                          {"wall_ratio", &row.wallRatio},
                                                                          {"cpu_ratio", &row.cpuRatio}};
    for (const auto& [name, values] : samples) {
        out.add(name, *values, {"", "_min", "_max"});
    }
    return out;
}

/// What is left out of a table for people, to fit on a wide terminal.
constexpr std::array kNotInText{"triangles",           "pairs",      "samples",        "pairs_per_cpu_s_min",
                                "pairs_per_cpu_s_max", "wall_ratio", "wall_ratio_min", "wall_ratio_max"};

io::Table benchTable(const BenchResult& result, io::Format format) {
    std::vector<io::NamedCells> rows;
    for (const BenchRow& row : result.rows) {
        rows.push_back(rowOf(row).cells());
        if (format == io::Format::Text) {
            std::erase_if(rows.back(), [](const auto& cell) {
                return std::ranges::find(kNotInText, cell.first) != kNotInText.end();
            });
        }
    }
    return tableOf(std::move(rows));
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
    Json json = headJson(result.machine);
    json["scene"] = {{"volume", result.volume},
                     {"voxels", result.voxels},
                     {"threshold", result.threshold},
                     {"poses", settings.poses},
                     {"seed", settings.seed}};
    json["summary"] = sentences(result);
    json["repetitions"] = settings.repetitions;
    json["rows"] = io::rowsJson(benchTable(result, io::Format::Json));
    json["notes"] = allNotes({result.machine, {}, result.notes});
    return json;
}

} // namespace

void writeBench(std::ostream& out, io::Format format, const BenchSettings& settings, const BenchResult& result) {
    if (format == io::Format::Json) {
        writeJson(out, benchJson(settings, result));
        return;
    }
    io::writeTable(out, format, benchTable(result, format));
    out << "# volume " << result.volume
        << (settings.mode == BenchMode::Outputs ? ", ratios of projections to the view by the same method, of outputs "
                                                  "to the bare count, round by round\n"
                                                : ", ratios to the first engine of each scene, round by round\n");
    writeFindings(out, {result.machine, sentences(result), result.notes});
}

} // namespace voxtact::lab

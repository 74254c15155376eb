// SPDX-License-Identifier: MIT
#include "lab/bench/latency.h"
#include "lab/measure/columns.h"

#include <algorithm>
#include <ostream>

namespace voxtact::lab {

namespace {

/// Ticks that a quantile needs, so that one at least is beyond it.
constexpr std::size_t kForP99 = 100;
constexpr std::size_t kForP999 = 1000;

std::optional<double> quantile(const std::vector<double>& samples, double part, std::size_t needs = 1) {
    return samples.size() < needs ? std::nullopt : std::optional(quantileOf(samples, part));
}

Row rowOf(const LatencyRow& row) {
    const auto some = [](const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); };
    Row out;
    out.add("mesh", row.mesh)
        .add("triangles", row.triangles)
        .add("engine", row.engine.name)
        .add("projection", some(row.engine.projection))
        .add("question", some(row.engine.question))
        .add("threads", row.engine.threads > 0 ? std::optional(row.engine.threads) : std::nullopt)
        .add("recorded", some(row.engine.recorded))
        .add("awaited", some(row.engine.awaited))
        .add("ticks", row.ticks.size())
        .add("touching", row.touching)
        .add("rounding", row.rounding)
        .add("p50_us", quantile(row.ticks, 0.5))
        .add("p99_us", quantile(row.ticks, 0.99, kForP99))
        .add("p99_9_us", quantile(row.ticks, 0.999, kForP999))
        .add("max_us", quantile(row.ticks, 1))
        .add("record_p50_us", quantile(row.recording, 0.5));
    return out;
}

/// "compute, polled", "cpu on 2 threads"
std::string nameOf(const EngineFacts& engine) {
    if (engine.threads > 0) {
        return engine.name + " on " + std::to_string(engine.threads) + (engine.threads == 1 ? " thread" : " threads");
    }
    return engine.name + ", " + engine.awaited;
}

std::string times(const LatencyRow& row) {
    const std::optional<double> p99 = quantile(row.ticks, 0.99, kForP99);
    return nameOf(row.engine) + ": p50 " + shortNumber(quantileOf(row.ticks, 0.5)) +
           (p99 ? " us, p99 " + shortNumber(*p99) + " us" : " us");
}

/// Whether it answers sooner: by p99, or by p50 where one of the two has too few ticks for that.
bool isSooner(const LatencyRow& row, const LatencyRow& than) {
    const auto p99 = [](const LatencyRow& of) { return quantile(of.ticks, 0.99, kForP99); };
    const auto p50 = [](const LatencyRow& of) { return quantileOf(of.ticks, 0.5); };
    const bool both = p99(row) && p99(than);
    return both ? std::pair(*p99(row), p50(row)) < std::pair(*p99(than), p50(than)) : p50(row) < p50(than);
}

/// The soonest row of a question among those of the host or of the device.
const LatencyRow* soonest(const LatencyResult& result, const LatencyRow& asked, bool host) {
    const LatencyRow* best = nullptr;
    for (const LatencyRow& row : result.rows) {
        const bool same = row.mesh == asked.mesh && row.engine.projection == asked.engine.projection &&
                          row.engine.question == asked.engine.question && (row.engine.threads > 0) == host;
        if (same && !row.ticks.empty() && (best == nullptr || isSooner(row, *best))) {
            best = &row;
        }
    }
    return best;
}

/// What a loop that needs its answer now would take: of each question the soonest of the host and of the device.
std::vector<std::string> sentences(const LatencyResult& result) {
    std::vector<std::string> out;
    std::string last;
    for (const LatencyRow& row : result.rows) {
        const std::string question = row.mesh + ", " + row.engine.projection + " " + row.engine.question;
        if (row.engine.threads == 0 || question == last) {
            continue;
        }
        last = question;
        const LatencyRow* const host = soonest(result, row, true);
        const LatencyRow* const device = soonest(result, row, false);
        if (host != nullptr) {
            out.push_back(question + ": " + times(*host) + (device == nullptr ? "" : "; " + times(*device)));
        }
    }
    return out;
}

/// Notes of the result, and which rows are not of all ticks.
std::vector<std::string> notesOf(const LatencySettings& settings, const LatencyResult& result) {
    std::vector<std::string> notes = result.notes;
    if (std::ranges::any_of(result.rows, [&](const LatencyRow& row) { return row.ticks.size() < settings.ticks; })) {
        notes.push_back("rows of fewer than " + std::to_string(settings.ticks) +
                        " ticks are of the first ones: the engine's share of --time-limit was used up");
    }
    return notes;
}

/// What is left out of a table for people, to fit on a wide terminal.
constexpr std::array kNotInText{"triangles", "touching", "rounding"};

io::Table latencyTable(const LatencyResult& result, io::Format format) {
    std::vector<io::NamedCells> rows;
    for (const LatencyRow& row : result.rows) {
        rows.push_back(rowOf(row).cells());
        if (format == io::Format::Text) {
            std::erase_if(rows.back(), [](const auto& cell) {
                return std::ranges::find(kNotInText, cell.first) != kNotInText.end();
            });
        }
    }
    return tableOf(std::move(rows));
}

Json latencyJson(const LatencySettings& settings, const LatencyResult& result) {
    Json json = headJson(result.machine);
    json["scene"] = {{"volume", result.volume},
                     {"voxels", result.voxels},
                     {"threshold", result.threshold},
                     {"ticks", settings.ticks},
                     {"seed", settings.seed}};
    json["summary"] = sentences(result);
    json["rows"] = io::rowsJson(latencyTable(result, io::Format::Json));
    json["notes"] = allNotes({result.machine, {}, notesOf(settings, result)});
    return json;
}

} // namespace

void writeLatency(std::ostream& out, io::Format format, const LatencySettings& settings, const LatencyResult& result) {
    if (format == io::Format::Json) {
        writeJson(out, latencyJson(settings, result));
        return;
    }
    io::writeTable(out, format, latencyTable(result, format));
    out << "# volume " << result.volume << ", one pair a tick\n";
    writeFindings(out, {result.machine, sentences(result), notesOf(settings, result)});
}

} // namespace voxtact::lab

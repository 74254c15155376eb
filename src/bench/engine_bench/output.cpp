// SPDX-License-Identifier: MIT
#include "bench/engine_bench/bench.h"
#include "bench/measure/columns.h"
#include "core/base/text_stream.h"

#include <algorithm>
#include <iomanip>

namespace voxtact::lab {

namespace {

/// Minimum ticks of a quantile: at least one is beyond it.
constexpr std::size_t kForP99 = 100;
constexpr std::size_t kForP999 = 1000;

/// µs of ms.
std::optional<double> quantile(const std::vector<double>& samples, double part, std::size_t needs = 1) {
    return samples.size() < needs ? std::nullopt : std::optional(1000 * quantileOf(samples, part));
}

void addRateColumns(const BenchRow& row, Row& out) {
    out.add("pairs", row.pairs)
        .add("contacts", row.contacts)
        .add("missed_percent", percentOf(row.missed, row.contacts))
        .add("false_percent", percentOf(row.wrong, row.untouched))
        .add("samples", row.wallRate.size())
        .add("pairs_per_s", row.wallRate, {"", "_min", "_max"})
        .add("pairs_per_cpu_s", row.cpuRate, {"", "_min", "_max"})
        .add("wall_ratio", row.wallRatio, {"", "_min", "_max"})
        .add("cpu_ratio", row.cpuRatio, {"", "_min", "_max"})
        .add("no_contacts", row.untouched)
        .add("possible", row.pairs - row.contacts - row.untouched);
}

void addTickColumns(const BenchRow& row, Row& out) {
    out.addSome("recorded", row.engine.recorded)
        .addSome("awaited", row.engine.awaited)
        .add("ticks", row.wall.size())
        .add("touching", row.touching)
        .add("rounding", row.rounding)
        .add("p50_us", quantile(row.wall, 0.5))
        .add("p99_us", quantile(row.wall, 0.99, kForP99))
        .add("p99_9_us", quantile(row.wall, 0.999, kForP999))
        .add("max_us", quantile(row.wall, 1))
        .add("record_p50_us", quantile(row.recording, 0.5));
}

void addBatchColumns(const BenchRow& row, Row& out) {
    const double median = medianOf(row.wall);
    out.addSome("poses_on", row.engine.posesOn)
        .add("batch", row.pairs)
        .add("samples", row.wall.size())
        .add("rounding", row.rounding)
        .add("wall_ms", row.wall, {"_median", "_min", "_max"})
        .add("gpu_ms", row.gpu, {"_median"})
        .add("pairs_per_s", median > 0 ? std::optional(1000 * static_cast<double>(row.pairs) / median) : std::nullopt);
}

/// Output of a mode.
struct ModeOutput {
    void (*addColumns)(const BenchRow& row, Row& out);
    std::vector<const char*> notInText; ///< columns that are left out of the table for people
    const char* about;                  ///< behind the name of the volume
};

/// In the order of BenchMode.
const ModeOutput& outputOf(BenchMode mode) {
    static const std::vector<const char*> kNotOfRates{
        "triangles",           "pairs",      "samples",        "pairs_per_cpu_s_min",
        "pairs_per_cpu_s_max", "wall_ratio", "wall_ratio_min", "wall_ratio_max"};
    static const std::array<ModeOutput, 4> kOutputs{{
        {addRateColumns, kNotOfRates, ", ratios to the first engine of each scene, round by round"},
        {addRateColumns, kNotOfRates,
         ", ratios of projections to the view by the same method, of outputs to the bare count, round by round"},
        {addTickColumns, {"triangles", "touching", "rounding"}, ", one pair per tick"},
        {addBatchColumns, {}, ", a batch is a submission with a wait, or a call of the host"},
    }};
    return kOutputs.at(static_cast<std::size_t>(mode));
}

Row rowOf(const ModeOutput& mode, const BenchRow& row) {
    Row out;
    out.add("mesh", row.mesh).add("triangles", row.triangles);
    if (!row.poses.empty()) {
        out.add("poses", row.poses);
    }
    out.add("engine", row.engine.name)
        .addSome("projection", row.engine.projection)
        .addSome("question", row.engine.question)
        .add("threads", row.engine.threads > 0 ? std::optional(row.engine.threads) : std::nullopt);
    mode.addColumns(row, out);
    return out;
}

std::string shortText(double value) {
    TextStream text;
    text << std::setprecision(3) << value;
    return text.str();
}

/// Returns "; of the 8 contacts that misses 12.5 %"; empty without contacts.
std::string shareText(const char* what, std::uint64_t part, std::uint64_t whole) {
    const std::optional<double> percent = percentOf(part, whole);
    return percent ? "; of the " + grouped(whole) + what + shortText(*percent) + " %" : std::string();
}

/// Compares the first engine of each scene, yes or no on one thread, with FCL.
std::vector<std::string> besideFcl(const BenchResult& result) {
    std::vector<std::string> out;
    for (const BenchRow& row : result.rows) {
        if (row.engine.projection != "octree") {
            continue;
        }
        const Spread spread = spreadOf(row.cpuRatio);
        out.push_back(
            row.mesh + ", poses " + row.poses + ": cpu yes/no answers for " + shortText(1 / spread.median) + " (" +
            shortText(1 / spread.max) + " to " + shortText(1 / spread.min) + ") times the pairs of " + row.engine.name +
            " in the same CPU time" + shareText(" contacts that misses ", row.missed, row.contacts) +
            shareText(" poses that certainly do not touch it reports as contacts ", row.wrong, row.untouched));
    }
    return out;
}

/// "compute, polled", "cpu on 2 threads"
std::string engineText(const EngineFacts& engine) {
    return engine.name + (engine.threads > 0 ? " on " + counted(engine.threads, "thread")
                                             : ", " + engine.awaited + ", recorded " + engine.recorded);
}

/// "compute, polled, recorded once: p50 80.1 us, p99 120 us (500 ticks, 258 of them touch)"
std::string ticksText(const BenchRow& row) {
    const std::optional<double> p99 = quantile(row.wall, 0.99, kForP99);
    return engineText(row.engine) + ": p50 " + shortNumber(*quantile(row.wall, 0.5)) +
           (p99 ? " us, p99 " + shortNumber(*p99) + " us" : " us") + " (" + grouped(row.wall.size()) + " ticks, " +
           grouped(row.touching) + " of them touch)";
}

/// Returns true if it answers sooner: by p99, or by p50 if one of them has too few ticks.
bool isSooner(const BenchRow& row, const BenchRow& than) {
    const bool both = std::min(row.wall.size(), than.wall.size()) >= kForP99;
    const auto key = [both](const BenchRow& of) {
        return std::pair(both ? quantile(of.wall, 0.99) : std::nullopt, quantile(of.wall, 0.5));
    };
    return key(row) < key(than);
}

/// The soonest row of a question among those of the host or of the device; null where there is none.
const BenchRow* soonest(const BenchResult& result, const BenchRow& asked, bool host) {
    const BenchRow* best = nullptr;
    for (const BenchRow& row : result.rows) {
        const bool same = row.mesh == asked.mesh && row.engine.projection == asked.engine.projection &&
                          row.engine.question == asked.engine.question && (row.engine.threads > 0) == host;
        if (same && !row.wall.empty() && (best == nullptr || isSooner(row, *best))) {
            best = &row;
        }
    }
    return best;
}

/// Returns the fastest engines of a latency-bound loop: for each question, of the host and of the device.
std::vector<std::string> soonestTicks(const BenchResult& result) {
    std::vector<std::string> out;
    std::string last;
    for (const BenchRow& row : result.rows) {
        const std::string question = row.mesh + ", " + row.engine.projection + " " + row.engine.question;
        if (row.engine.threads == 0 || question == last) {
            continue;
        }
        last = question;
        const BenchRow* const host = soonest(result, row, true);
        const BenchRow* const device = soonest(result, row, false);
        if (host != nullptr) {
            out.push_back(question + ": " + ticksText(*host) + (device == nullptr ? "" : "; " + ticksText(*device)));
        }
    }
    return out;
}

/// Returns notes on the times of ticks.
void noteTicks(const BenchSettings& settings, const BenchResult& result, std::vector<std::string>& notes) {
    const auto isCut = [&](const BenchRow& of) { return of.wall.size() < settings.number; };
    if (result.disagreement.empty() && std::ranges::any_of(result.rows, isCut)) {
        notes.push_back(concat("rows of fewer than ", settings.number,
                               " ticks have only the first ticks: the engine's share of --time-limit ran out"));
    }
    std::vector<std::string> blind;
    for (const BenchRow& row : result.rows) {
        if (!row.engine.question.empty() && row.touching == 0) {
            blind.push_back(concat(engineText(row.engine), " (", row.engine.projection, " ", row.engine.question, ")"));
        }
    }
    if (!blind.empty()) {
        notes.push_back(
            "these rows have only poses without contact (a stroke begins outside), so all answers are no: " +
            joined(blind, ", "));
    }
}

/// Returns notes on the times of batches.
void noteBatches(const BenchSettings& settings, const BenchResult& result, std::vector<std::string>& notes) {
    const auto isCut = [&](const BenchRow& of) { return of.wall.size() < settings.repetitions; };
    if (result.disagreement.empty() && std::ranges::any_of(result.rows, isCut)) {
        notes.push_back(concat("rows of fewer than ", counted(settings.repetitions, "sample"),
                               ": the engine's share of --time-limit ran out"));
    }
}

} // namespace

void writeBench(std::ostream& out, io::Format format, const BenchSettings& settings, const BenchResult& result) {
    const BenchMode mode = settings.mode;
    const bool ticks = mode == BenchMode::Latency;
    const ModeOutput& how = outputOf(mode);
    const auto row = [&how](const BenchRow& of) { return rowOf(how, of); };
    Output output{.machine = result.machine, .members = {}, .about = "volume " + result.volume + how.about};
    output.notes = result.notes;
    output.sentences = ticks ? soonestTicks(result) : besideFcl(result);
    const auto touches = [](const BenchRow& of) { return of.touching > 0 || of.contacts > 0; };
    if (mode == BenchMode::Batches) {
        noteBatches(settings, result, output.notes);
    }
    if (ticks) {
        noteTicks(settings, result, output.notes);
    } else if (!result.rows.empty() && std::ranges::none_of(result.rows, touches)) {
        output.notes.emplace_back(kNothingTouches);
    }
    const std::vector<io::NamedCells> rows = cellsOf(result.rows, row);
    output.table = format == io::Format::Text ? tableWithout(how.notInText, rows) : tableOf(rows);
    output.members["scene"] = {{"volume", result.volume},
                               {"voxels", result.voxels},
                               {"threshold", result.threshold},
                               {"opacity", result.opacity},
                               {"tf_domain", {result.domain.lo, result.domain.hi}},
                               {"tf_size", result.tableSize},
                               {ticks ? "ticks" : "poses", settings.number},
                               {"seed", settings.seed}};
    if (mode != BenchMode::Batches) {
        output.members["summary"] = output.sentences;
    }
    if (!ticks) {
        output.members["repetitions"] = settings.repetitions;
    }
    output.members["rows"] = mode == BenchMode::Batches
                                 ? arrayOf(result.rows, [&](const BenchRow& of) { return row(of).json(); })
                                 : io::rowsJson(output.table);
    writeOutput(out, format, output);
}

} // namespace voxtact::lab

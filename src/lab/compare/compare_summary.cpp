// SPDX-License-Identifier: MIT
#include "lab/compare/compare_output.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::lab {

namespace {

std::string plural(std::uint64_t count, const std::string& unit) {
    const bool one = count == 1 && unit.ends_with('s');
    return grouped(count) + " " + (one ? unit.substr(0, unit.size() - 1) : unit);
}

/// Three significant digits.
std::string milliseconds(double value) {
    char text[32];
    static_cast<void>(std::snprintf(text, sizeof text,
                                    value < 1     ? "%.3f ms"
                                    : value < 100 ? "%.3g ms"
                                                  : "%.0f ms",
                                    value));
    return text;
}

/// "a = b = c" as "a, b and c".
std::string listed(std::string rule) {
    std::size_t last = rule.rfind(" = ");
    if (last != std::string::npos) {
        rule.replace(last, 3, " and ");
    }
    for (std::size_t at = rule.find(" = "); at != std::string::npos; at = rule.find(" = ")) {
        rule.replace(at, 3, ", ");
    }
    return rule;
}

std::string sentenceOf(const Verdict& verdict) {
    if (!verdict.unchecked.empty()) {
        return listed(verdict.rule) + ": not checked, " + verdict.unchecked;
    }
    if (verdict.failed()) {
        return "DISAGREEMENT: " + verdict.rule + ": pose " + std::to_string(verdict.first->pose) + ": " +
               verdict.first->text;
    }
    if (verdict.unit == "fragments") {
        return "of " + plural(verdict.compared, "fragments") + " that the device's rasteriser or the oracle has, " +
               grouped(verdict.differing) + " are of one side only" +
               (verdict.differing > 0 ? ", each within rounding of a decision" : "") + " (" + verdict.detail + ")";
    }
    const std::string where = (verdict.compared == 1 ? "the one pose" : "all " + plural(verdict.compared, "poses"));
    if (verdict.differing == 0) {
        const bool hits = verdict.rule.find(" hits where ") != std::string::npos;
        return hits ? verdict.rule + ", on " + where : listed(verdict.rule) + " count the same on " + where;
    }
    return listed(verdict.rule) + " differ on " + grouped(verdict.differing) + " of " +
           plural(verdict.compared, "poses") + ", by at most " + plural(verdict.largest, "fragments") + " (" +
           verdict.detail + ")";
}

/// The fastest that counts; a yes or no is another question.
const Series* fastest(const CompareResult& result, Mode mode, std::uint32_t batch) {
    const Series* best = nullptr;
    for (const Series& series : result.series) {
        const bool here = series.sweep == Sweep::Batch && series.mode == mode && series.batch == batch;
        if (!here || series.wall.empty() || series.method == toString(CountingMethod::QueryAny) ||
            series.method == "oracle") {
            continue;
        }
        if (best == nullptr || series.pairsPerSecond() > best->pairsPerSecond()) {
            best = &series;
        }
    }
    return best;
}

std::string speedOf(const Series& series, const std::string& what) {
    return "fastest " + what + ": " + series.method + " (" + milliseconds(spreadOf(series.wall).median) + ", " +
           grouped(static_cast<std::uint64_t>(std::llround(series.pairsPerSecond()))) + " pairs a second)";
}

} // namespace

std::vector<std::string> summarize(const CompareResult& result) {
    std::vector<std::string> sentences;
    for (const Verdict& verdict : result.verdicts) {
        sentences.push_back(sentenceOf(verdict));
    }
    if (const Series* best = fastest(result, Mode::Sync, 1)) {
        sentences.push_back(speedOf(*best, "for 1 pair, waited for"));
    }
    if (const Series* best = fastest(result, Mode::Pipelined, 1024)) {
        sentences.push_back(speedOf(*best, "for 1,024 pairs, in flight"));
    }
    return sentences;
}

} // namespace voxtact::lab

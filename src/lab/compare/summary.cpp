// SPDX-License-Identifier: MIT
#include "lab/compare/output.h"

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

std::string sentenceOf(const Verdict& verdict) {
    if (!verdict.unchecked.empty()) {
        return verdict.members + ": not checked, " + verdict.unchecked;
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
        return verdict.byRule ? verdict.rule + ", on " + where : verdict.members + " count the same on " + where;
    }
    return verdict.members + " differ on " + grouped(verdict.differing) + " of " + plural(verdict.compared, "poses") +
           ", by at most " + plural(verdict.largest, "fragments") + " (" + verdict.detail + ")";
}

std::string speedOf(const Series& series, const std::string& what) {
    return "fastest " + what + ": " + series.method + " (" + milliseconds(medianOf(series.wall)) + ", " +
           grouped(static_cast<std::uint64_t>(std::llround(*series.pairsPerSecond()))) + " pairs a second)";
}

} // namespace

std::vector<std::string> summarize(const CompareResult& result) {
    std::vector<std::string> sentences;
    for (const Verdict& verdict : result.verdicts) {
        sentences.push_back(sentenceOf(verdict));
    }
    struct Way {
        Mode mode;
        std::uint32_t batch;
        const char* name;
    };
    for (const Way& way :
         {Way{Mode::Sync, 1, "for 1 pair, waited for"}, Way{Mode::Pipelined, 1024, "for 1,024 pairs, in flight"}}) {
        const Series* const best = fastestOf(
            result.series, [&](const Series& series) { return series.mode == way.mode && series.batch == way.batch; });
        if (best != nullptr) {
            sentences.push_back(speedOf(*best, way.name));
        }
    }
    return sentences;
}

} // namespace voxtact::lab

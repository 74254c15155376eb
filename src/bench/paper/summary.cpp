// SPDX-License-Identifier: MIT
#include "bench/measure/numbers.h"
#include "bench/paper/paper.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>

namespace voxtact::lab {

namespace {

constexpr const char* kElsewhere = ", on other hardware";
/// The size of the table that the paper gives a time of.
constexpr std::uint32_t kPublishedEntries = 256;

/// The methods of `group` that were measured.
std::vector<std::string> measured(const PaperResult& result, std::initializer_list<CountingMethod> group) {
    std::vector<std::string> names;
    for (const CountingMethod method : group) {
        if (std::ranges::find(result.rows, toString(method), &PaperRow::method) != result.rows.end()) {
            names.emplace_back(toString(method));
        }
    }
    return names;
}

void addAgreement(const PaperResult& result, std::vector<std::string>& sentences) {
    if (!result.disagreement.empty()) {
        sentences.push_back("DISAGREEMENT: " + result.disagreement);
        return;
    }
    using enum CountingMethod;
    std::string where;
    for (const auto& group : {measured(result, {Query, Atomic, Subgroup}), measured(result, {Compute, Cpu})}) {
        if (group.size() > 1) {
            where += (where.empty() ? "" : ", and so do ") + listed(group) + (where.empty() ? " count the same" : "");
        }
    }
    if (!where.empty()) {
        sentences.push_back(where + ", on every pose of every scene; every timed frame gave these counts");
    }
    const std::vector<std::string> raster = measured(result, {Query, Atomic, Subgroup});
    if (!raster.empty() && !measured(result, {Cpu}).empty()) {
        sentences.push_back(roundingRule(raster.front(), toString(CountingMethod::Cpu)) +
                            ", on every pose; not checked by an oracle");
    }
}

/// A row with the median of something.
struct Found {
    const PaperRow* row = nullptr;
    double median = 0;
};

/// Returns the rows with the minimum and maximum of a value; empty if no row has it.
template <class Samples> std::optional<std::pair<Found, Found>> extremes(const PaperResult& result, Samples samplesOf) {
    std::vector<Found> all;
    for (const PaperRow& row : result.rows) {
        if (const std::vector<double> samples = samplesOf(row); !samples.empty()) {
            all.push_back({&row, medianOf(samples)});
        }
    }
    if (all.empty()) {
        return std::nullopt;
    }
    const auto [least, most] = std::ranges::minmax(all, {}, &Found::median);
    return std::pair(least, most);
}

std::string nameOf(const PaperRow& row, const PaperResult& result) {
    return row.method + " in " + result.scenes[row.scene].name;
}

/// "2.6 %", or "nothing that can be measured (noise: -1.8 %)".
std::string percentText(double median) {
    const std::string text = shortNumber(median) + " %";
    return median < 0 ? "nothing measurable (noise: " + text + ")" : text;
}

void addPercents(const PaperResult& result, std::vector<std::string>& sentences) {
    struct Way {
        const char* begin;
        std::vector<double> (*percent)(const PaperColumns&);
        std::string end;
    };
    const Way ways[] = {
        {"detection adds to a frame", overheadPercent,
         "; published: " + number(published::kOverhead.lo) + " to " + number(published::kOverhead.hi) + " %" +
             kElsewhere},
        {"detection alone takes, of the time of rendering,", collisionPercent, ""},
    };
    for (const Way& way : ways) {
        for (const PaperClock& clock : kPaperClocks) {
            const auto found = extremes(result, [&](const PaperRow& row) { return way.percent(row.*clock.columns); });
            if (found) {
                const auto& [least, most] = *found;
                sentences.push_back(concat(way.begin, " ", percentText(least.median), " (", nameOf(*least.row, result),
                                           ") to ", percentText(most.median), " (", nameOf(*most.row, result), "), ",
                                           clock.words, ", medians", way.end));
            }
        }
    }
}

/// On a slow renderer a small overhead is lost in how much its frames differ.
void addIntervals(const PaperResult& result, std::vector<std::string>& sentences) {
    for (const PaperClock& clock : kPaperClocks) {
        std::uint64_t all = 0;
        std::uint64_t apart = 0;
        for (const PaperRow& row : result.rows) {
            const auto interval = medianInterval(overheadPercent(row.*clock.columns), kConfidence);
            all += interval ? 1 : 0;
            apart += interval && (interval->low > 0 || interval->high < 0) ? 1 : 0;
        }
        const bool timed = std::ranges::any_of(
            result.rows, [&](const PaperRow& row) { return !overheadPercent(row.*clock.columns).empty(); });
        if (timed && all == 0) {
            sentences.push_back(concat("no interval (of 95 % or more) of what detection adds is known, ", clock.words,
                                       ": too few samples"));
        }
        if (all > 0) {
            sentences.push_back(concat("in ", grouped(apart), " of ", grouped(all),
                                       " rows the interval (of 95 % or more) of what detection adds leaves out 0, ",
                                       clock.words));
        }
    }
}

std::string pairsPerSecond(double milliseconds) {
    return grouped(static_cast<std::uint64_t>(std::llround(1000 / milliseconds))) + " pairs per second";
}

void addPairs(const PaperResult& result, std::vector<std::string>& sentences) {
    const auto found = extremes(result, [](const PaperRow& row) {
        const bool counts = row.scene == 0 && exactness(*countingMethodFromName(row.method)) == Exactness::Exact;
        return counts ? row.wall.collision : std::vector<double>();
    });
    const std::string there = "; published: " + grouped(static_cast<std::uint64_t>(published::kPairsPerSecond)) +
                              " pairs per second" + kElsewhere;
    if (found && found->first.median > 0) {
        sentences.push_back(concat("the fastest to count one pair, submitted and waited for alone, is ",
                                   nameOf(*found->first.row, result), ": ", shortNumber(found->first.median), " ms, ",
                                   pairsPerSecond(found->first.median), there));
    }
    const Series* const best = fastestOf(result.series, [](const Series&) { return true; });
    if (best != nullptr) {
        sentences.push_back(concat("the fastest in batches is ", best->method, " with ", grouped(best->batch),
                                   " pairs per submission (", toString(best->mode),
                                   "): ", pairsPerSecond(1000 / *best->pairsPerSecond()), there));
    }
}

void addPolygons(const PaperResult& result, std::vector<std::string>& sentences) {
    for (const LocalizeWay& way : result.polygons) {
        if (!way.unchecked.empty() || way.wall.empty()) {
            continue;
        }
        sentences.push_back(
            concat("which of ", grouped(result.polygonTriangles), " triangles touch on ", result.polygonPoses,
                   " poses, by the way ", way.name, ": ", shortNumber(medianOf(way.wall)), " ms per pair by wall clock",
                   way.queries ? ", " + grouped(*way.queries) + " queries in all" : "", "; ", grouped(way.triangles),
                   " found in all, ", grouped(way.missed), " of those that certainly touch are missed"));
    }
}

void addIntegration(const PaperResult& result, std::vector<std::string>& sentences) {
    const auto found = std::ranges::find(result.integration, kPublishedEntries, &IntegrationPoint::entries);
    if (found != result.integration.end() && !found->wall.empty()) {
        sentences.push_back(
            concat("the pre-integrated table of ", found->entries, "x", found->entries, " entries is made in ",
                   found->gpu.empty() ? "" : shortNumber(medianOf(found->gpu)) + " ms by GPU timestamps, ",
                   shortNumber(medianOf(found->wall)),
                   " ms by wall clock; published: ", number(published::kIntegrationMilliseconds), " ms", kElsewhere));
    }
}

} // namespace

std::string overheadText(const std::vector<double>& percents) {
    const double median = medianOf(percents);
    const std::optional<MedianInterval> interval = medianInterval(percents, kConfidence);
    return (median < 0 ? "noise" : shortNumber(median)) +
           (interval ? " (" + shortNumber(interval->low) + " to " + shortNumber(interval->high) + ")"
                     : " (no interval)");
}

std::vector<std::string> paperSummary(const PaperResult& result) {
    std::vector<std::string> sentences;
    for (const auto add : {addAgreement, addPercents, addIntervals, addPairs, addPolygons, addIntegration}) {
        add(result, sentences);
    }
    return sentences;
}

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "bench/compare/agreement.h"

#include "bench/measure/numbers.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

/// Compares a method that counts 0 or 1.
bool isAny(const NamedCounts& counts) {
    return counts.method == toString(CountingMethod::QueryAny);
}

/// "query 812, atomic 811"
std::string countText(std::span<const NamedCounts> group, std::size_t at) {
    std::string text;
    for (const NamedCounts& by : group) {
        text += concat(text.empty() ? "" : ", ", by.method, " ", by.counts[at]);
    }
    return text;
}

std::uint64_t difference(std::uint64_t a, std::uint64_t b) {
    return std::max(a, b) - std::min(a, b);
}

/// Returns the verdict on methods that must all count the same.
CompareVerdict verdictOn(const std::vector<std::string>& methods) {
    return {.rule = joined(methods, " = "), .members = listed(methods)};
}

/// Compares counts pose by pose: their difference `apart`, and its text. A rule reports its first violation, an
/// informational comparison the pose with the largest difference.
template <class Apart, class Text>
void comparePoses(std::span<const std::uint32_t> poses, CompareVerdict& verdict, Apart apart, Text text) {
    verdict.compared = poses.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const std::uint64_t difference = apart(i);
        if (difference == 0) {
            continue;
        }
        ++verdict.differing;
        if (!verdict.first || (!verdict.required && difference > verdict.largest)) {
            verdict.first = {poses[i], text(i)};
        }
        verdict.largest = std::max(verdict.largest, difference);
    }
}

std::string fragmentText(const DifferingFragment& differing) {
    const oracle::OracleFragment& fragment = differing.fragment;
    return concat("the fragment of triangle ", fragment.triangle, " at pixel ", fragment.x, ",", fragment.y,
                  differing.onDevice ? " is the device's, not the oracle's" : " is the oracle's, not the device's",
                  ", and rounding does not explain it");
}

/// The first rule that a pose breaks.
std::optional<std::string> faultOf(const FragmentCheck& check) {
    if (check.counted && *check.counted != check.onDevice) {
        return concat("the device lists ", check.onDevice, " fragments and counts ", *check.counted);
    }
    const auto fault = std::ranges::find(check.differing, oracle::Doubt::None, &DifferingFragment::doubt);
    return fault == check.differing.end() ? std::nullopt : std::optional(fragmentText(*fault));
}

/// The rule for the methods of a group: those that were run must count the same.
CompareVerdict judgeGroup(std::span<const NamedCounts> run, Coverage coverage, std::span<const std::uint32_t> poses) {
    if (!run.empty()) {
        return judgeEqual(run, poses);
    }
    std::vector<std::string> names;
    std::ranges::transform(methodsThatCount(coverage), std::back_inserter(names),
                           [](CountingMethod method) { return toString(method); });
    CompareVerdict verdict = verdictOn(names);
    verdict.unchecked = "none of them ran";
    return verdict;
}

} // namespace

std::string disagreementOf(const CompareVerdict& verdict) {
    return concat(verdict.rule, ": disagreement on pose ", verdict.first->pose, ": ", verdict.first->text);
}

std::vector<NamedCounts> countsBy(std::span<const NamedCounts> counts, Coverage coverage) {
    std::vector<NamedCounts> group;
    for (const CountingMethod method : methodsThatCount(coverage)) {
        std::ranges::copy_if(counts, std::back_inserter(group),
                             [method](const NamedCounts& one) { return one.method == toString(method); });
    }
    return group;
}

std::vector<CompareVerdict> judgeCounts(std::span<const NamedCounts> counts, std::span<const std::uint32_t> poses) {
    const std::vector<NamedCounts> raster = countsBy(counts, Coverage::Rasteriser);
    const std::vector<NamedCounts> exact = countsBy(counts, Coverage::Computed);
    const auto any = std::ranges::find_if(counts, isAny);
    std::vector<CompareVerdict> verdicts{judgeGroup(raster, Coverage::Rasteriser, poses)};
    if (any != counts.end() && !raster.empty()) {
        verdicts.push_back(judgeHits(*any, raster.front(), poses));
    }
    verdicts.push_back(judgeGroup(exact, Coverage::Computed, poses));
    if (!raster.empty() && !exact.empty()) {
        verdicts.push_back(tellDifference(raster.front(), exact.back(), poses));
        verdicts.push_back(judgeRounding(raster.front(), exact.back(), poses));
    } else if (any != counts.end() && !exact.empty()) {
        verdicts.push_back(judgeRounding(*any, exact.back(), poses));
    }
    return verdicts;
}

std::vector<std::uint32_t> touchingPoses(std::span<const NamedCounts> counts) {
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; !counts.empty() && i < counts.front().counts.size(); ++i) {
        if (std::ranges::any_of(counts, [i](const NamedCounts& by) { return by.counts[i] > 0; })) {
            places.push_back(i);
        }
    }
    return places;
}

CompareVerdict judgeEqual(std::span<const NamedCounts> group, std::span<const std::uint32_t> poses) {
    std::vector<std::string> methods;
    std::ranges::transform(group, std::back_inserter(methods), &NamedCounts::method);
    CompareVerdict verdict = verdictOn(methods);
    if (group.size() < 2) {
        verdict.unchecked = "there is no second method to compare with";
        return verdict;
    }
    const auto apart = [group](std::size_t i) {
        const auto [least, most] =
            std::ranges::minmax_element(group, {}, [i](const NamedCounts& one) { return one.counts[i]; });
        return most->counts[i] - least->counts[i];
    };
    comparePoses(poses, verdict, apart, [group](std::size_t i) { return countText(group, i); });
    return verdict;
}

CompareVerdict judgeHits(const NamedCounts& any, const NamedCounts& exact, std::span<const std::uint32_t> poses) {
    CompareVerdict verdict{.rule = any.method + " touches where " + exact.method + " does", .byRule = true};
    const auto hits = [](const NamedCounts& by, std::size_t i) { return by.counts[i] != 0; };
    comparePoses(
        poses, verdict, [&](std::size_t i) { return std::uint64_t{hits(any, i) == hits(exact, i) ? 0U : 1U}; },
        [&](std::size_t i) {
            return any.method + (hits(any, i) ? " hits, " : " misses, ") + countText({&exact, 1}, i);
        });
    verdict.largest = 0; // no difference of counts
    return verdict;
}

bool explainedByRounding(std::uint64_t raster, std::uint64_t host, bool yesNo) noexcept {
    if (yesNo) {
        return (raster > 0) == (host > 0) || host <= kRoundedFragments;
    }
    return difference(raster, host) <= host / 2 + kRoundedFragments;
}

std::string roundingRule(const std::string& raster, const std::string& host, bool yesNo) {
    const std::string fragments = std::to_string(kRoundedFragments) + " fragments";
    return yesNo
               ? raster + " touches where " + host + " counts more than " + fragments + ", and not where it counts none"
               : raster + " and " + host + " differ by at most (half of " + host + "'s count + " + fragments + ")";
}

CompareVerdict judgeRounding(const NamedCounts& raster, const NamedCounts& host, std::span<const std::uint32_t> poses) {
    const bool yesNo = isAny(raster);
    CompareVerdict verdict{.rule = roundingRule(raster.method, host.method, yesNo), .byRule = true};
    const NamedCounts both[] = {raster, host};
    const auto apart = [&](std::size_t i) -> std::uint64_t {
        const bool explained = explainedByRounding(raster.counts[i], host.counts[i], yesNo);
        return explained ? 0 : difference(raster.counts[i], host.counts[i]);
    };
    comparePoses(poses, verdict, apart, [&](std::size_t i) { return countText(both, i); });
    return verdict;
}

CompareVerdict tellDifference(const NamedCounts& one, const NamedCounts& other, std::span<const std::uint32_t> poses) {
    CompareVerdict verdict = verdictOn({one.method + " and " + other.method});
    verdict.required = false;
    std::uint64_t all = 0;
    std::uint64_t sum = 0;
    const auto apart = [&](std::size_t i) {
        all += other.counts[i];
        sum += difference(one.counts[i], other.counts[i]);
        return difference(one.counts[i], other.counts[i]);
    };
    const NamedCounts both[] = {one, other};
    comparePoses(poses, verdict, apart, [&](std::size_t i) { return countText(both, i); });
    verdict.detail = grouped(sum) + " of " + grouped(all) + " fragments in total";
    return verdict;
}

std::uint64_t countOf(oracle::Doubt doubt, std::span<const FragmentCheck> checks) {
    std::uint64_t count = 0;
    for (const FragmentCheck& check : checks) {
        count += static_cast<std::uint64_t>(std::ranges::count(check.differing, doubt, &DifferingFragment::doubt));
    }
    return count;
}

CompareVerdict judgeFragments(std::span<const FragmentCheck> checks) {
    CompareVerdict verdict{.rule = kFragmentRule, .members = kFragmentRule, .unit = "fragments"};
    for (const FragmentCheck& check : checks) {
        // In both, and on one side only: the union.
        verdict.compared += (check.onDevice + check.byOracle + check.differing.size()) / 2;
        verdict.differing += check.differing.size();
        verdict.largest = std::max<std::uint64_t>(verdict.largest, check.differing.size());
        if (const std::optional<std::string> fault = faultOf(check); fault && !verdict.first) {
            verdict.first = {check.pose, *fault};
        }
    }
    if (verdict.compared == 0 && !verdict.first) {
        verdict.unchecked = "neither has a fragment on these poses";
    }
    std::vector<std::string> reasons;
    for (const oracle::Doubt doubt : kDoubts) {
        if (const std::uint64_t count = countOf(doubt, checks); count > 0) {
            reasons.push_back(
                concat(count, " by ", doubt == oracle::Doubt::None ? "nothing that explains them" : toString(doubt)));
        }
    }
    verdict.detail = "on " + counted(checks.size(), "pose") + (reasons.empty() ? "" : ": ") + joined(reasons, ", ");
    return verdict;
}

} // namespace voxtact::lab

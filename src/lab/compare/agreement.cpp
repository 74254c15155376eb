// SPDX-License-Identifier: MIT
#include "lab/compare/agreement.h"

#include "core/method/method_table.h"
#include "lab/measure/numbers.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

std::string countText(const NamedCounts& counts, std::size_t at) {
    return counts.method + " " + std::to_string(counts.counts[at]);
}

std::string fragmentText(const DifferingFragment& fragment) {
    return "the fragment of triangle " + std::to_string(fragment.triangle) + " at pixel " + std::to_string(fragment.x) +
           "," + std::to_string(fragment.y) +
           (fragment.onDevice ? " is the device's, not the oracle's" : " is the oracle's, not the device's") +
           ", and rounding is no reason";
}

/// The first rule that a pose breaks.
std::optional<std::string> faultOf(const FragmentCheck& check) {
    if (check.counted && *check.counted != check.onDevice) {
        return "the device lists " + std::to_string(check.onDevice) + " fragments and counts " +
               std::to_string(*check.counted);
    }
    const auto fault = std::find_if(check.differing.begin(), check.differing.end(),
                                    [](const DifferingFragment& fragment) { return fragment.reason == kReasons[3]; });
    return fault == check.differing.end() ? std::nullopt : std::optional(fragmentText(*fault));
}

std::vector<NamedCounts> groupOf(std::span<const NamedCounts> counts, std::span<const CountingMethod> methods) {
    std::vector<NamedCounts> group;
    for (const CountingMethod method : methods) {
        std::ranges::copy_if(counts, std::back_inserter(group),
                             [method](const NamedCounts& one) { return one.method == toString(method); });
    }
    return group;
}

/// Of methods of which none was run.
Verdict noneRun(Coverage coverage) {
    std::string rule;
    for (const CountingMethod method : methodsThatCount(coverage)) {
        rule += (rule.empty() ? "" : " = ") + std::string(toString(method));
    }
    return notChecked(rule, "none of them was run");
}

} // namespace

std::vector<NamedCounts> rasterGroup(std::span<const NamedCounts> counts) {
    return groupOf(counts, methodsThatCount(Coverage::Rasteriser));
}

std::vector<NamedCounts> exactGroup(std::span<const NamedCounts> counts) {
    return groupOf(counts, methodsThatCount(Coverage::Computed));
}

std::vector<Verdict> judgeCounts(const std::vector<NamedCounts>& counts, std::span<const std::uint32_t> poses) {
    const std::vector<NamedCounts> raster = rasterGroup(counts);
    const std::vector<NamedCounts> exact = exactGroup(counts);
    const std::vector<NamedCounts> any = groupOf(counts, std::array{CountingMethod::QueryAny});
    std::vector<Verdict> verdicts;
    verdicts.push_back(raster.empty() ? noneRun(Coverage::Rasteriser) : judgeEqual(raster, poses));
    if (!any.empty() && !raster.empty()) {
        verdicts.push_back(judgeHits(any.front(), raster.front(), poses));
    }
    verdicts.push_back(exact.empty() ? noneRun(Coverage::Computed) : judgeEqual(exact, poses));
    if (!raster.empty() && !exact.empty()) {
        verdicts.push_back(tellDifference(raster.front(), exact.back(), poses));
    }
    return verdicts;
}

Verdict notChecked(std::string rule, std::string why) {
    Verdict verdict;
    verdict.rule = std::move(rule);
    verdict.unchecked = std::move(why);
    return verdict;
}

Verdict judgeEqual(std::span<const NamedCounts> group, std::span<const std::uint32_t> poses) {
    Verdict verdict;
    for (const NamedCounts& method : group) {
        verdict.rule += (verdict.rule.empty() ? "" : " = ") + method.method;
    }
    if (group.size() < 2) {
        verdict.unchecked = "there is no second method to compare with";
        return verdict;
    }
    verdict.compared = poses.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto [least, most] =
            std::minmax_element(group.begin(), group.end(),
                                [i](const NamedCounts& a, const NamedCounts& b) { return a.counts[i] < b.counts[i]; });
        const std::uint64_t difference = most->counts[i] - least->counts[i];
        if (difference == 0) {
            continue;
        }
        ++verdict.differing;
        verdict.largest = std::max(verdict.largest, difference);
        if (!verdict.first) {
            std::string text;
            for (const NamedCounts& method : group) {
                text += (text.empty() ? "" : ", ") + countText(method, i);
            }
            verdict.first = {poses[i], text};
        }
    }
    return verdict;
}

Verdict judgeHits(const NamedCounts& any, const NamedCounts& exact, std::span<const std::uint32_t> poses) {
    Verdict verdict;
    verdict.hits = true;
    verdict.rule = any.method + " hits where " + exact.method + " does";
    verdict.compared = poses.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const bool hit = any.counts[i] != 0;
        if (hit == (exact.counts[i] != 0)) {
            continue;
        }
        ++verdict.differing;
        if (!verdict.first) {
            verdict.first = {poses[i], any.method + (hit ? " hits, " : " misses, ") + countText(exact, i)};
        }
    }
    return verdict;
}

Verdict tellDifference(const NamedCounts& one, const NamedCounts& other, std::span<const std::uint32_t> poses) {
    Verdict verdict;
    verdict.rule = one.method + " and " + other.method;
    verdict.required = false;
    verdict.compared = poses.size();
    std::uint64_t all = 0;
    std::uint64_t apart = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto [least, most] = std::minmax(one.counts[i], other.counts[i]);
        const std::uint64_t difference = most - least;
        all += other.counts[i];
        apart += difference;
        if (difference == 0) {
            continue;
        }
        ++verdict.differing;
        if (difference > verdict.largest) {
            verdict.largest = difference;
            verdict.first = {poses[i], countText(one, i) + ", " + countText(other, i)};
        }
    }
    verdict.detail = grouped(apart) + " of " + grouped(all) + " fragments apart in all";
    return verdict;
}

std::array<std::uint64_t, 4> countReasons(std::span<const FragmentCheck> checks) {
    std::array<std::uint64_t, 4> counts{};
    for (const FragmentCheck& check : checks) {
        for (const DifferingFragment& fragment : check.differing) {
            const auto found = std::find(kReasons.begin(), kReasons.end(), fragment.reason);
            ++counts.at(std::min<std::size_t>(static_cast<std::size_t>(found - kReasons.begin()), 3));
        }
    }
    return counts;
}

Verdict judgeFragments(std::span<const FragmentCheck> checks) {
    Verdict verdict;
    verdict.rule = kFragmentRule;
    verdict.unit = "fragments";
    for (const FragmentCheck& check : checks) {
        // In both, and on one side only: the union.
        verdict.compared += (check.onDevice + check.byOracle + check.differing.size()) / 2;
        verdict.differing += check.differing.size();
        verdict.largest = std::max<std::uint64_t>(verdict.largest, check.differing.size());
        if (const std::optional<std::string> fault = faultOf(check); fault && !verdict.first) {
            verdict.first = {check.pose, *fault};
        }
    }
    const std::array<std::uint64_t, 4> reasons = countReasons(checks);
    verdict.detail = "on " + std::to_string(checks.size()) + " poses";
    bool any = false;
    for (std::size_t i = 0; i < reasons.size(); ++i) {
        if (reasons.at(i) > 0) {
            verdict.detail += std::string(any ? ", " : ": ") + std::to_string(reasons.at(i)) + " by " +
                              (i == 3 ? "nothing that explains them" : kReasons.at(i));
            any = true;
        }
    }
    return verdict;
}

} // namespace voxtact::lab

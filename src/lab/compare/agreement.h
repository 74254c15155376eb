// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/methods.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Who must agree with whom, judged from numbers alone: no device, no files.
namespace voxtact::lab {

/// What one method counted, a number a pose.
struct NamedCounts {
    std::string method;
    std::vector<std::uint64_t> counts;
};

/// The first pose on which a rule is broken.
struct Disagreement {
    std::uint32_t pose = 0; ///< its number in the list of poses
    std::string text;       ///< "query 812, atomic 811"
};

/// A row of the table of agreement.
struct Verdict {
    std::string rule;            ///< "query = atomic = subgroup"
    std::string unit = "poses";  ///< what is counted below
    bool hits = false;           ///< compared is whether they hit, not how often
    bool required = true;        ///< a difference is a disagreement; otherwise it is only told
    std::string unchecked;       ///< why there was nothing to compare; empty: it was compared
    std::uint64_t compared = 0;  ///< units
    std::uint64_t differing = 0; ///< of these
    std::uint64_t largest = 0;   ///< difference of two counts, in fragments
    std::string detail;          ///< a line for people
    std::string sweep = "none";  ///< the --sweep that meets it
    std::optional<Disagreement> first;

    [[nodiscard]] bool failed() const noexcept { return required && first.has_value(); }
};

/// Equal on every pose. `poses` holds the numbers of the poses that the counts belong to.
[[nodiscard]] Verdict judgeEqual(std::span<const NamedCounts> group, std::span<const std::uint32_t> poses);
/// A hit of the one (not zero) exactly where the other has a fragment.
[[nodiscard]] Verdict judgeHits(const NamedCounts& any, const NamedCounts& exact, std::span<const std::uint32_t> poses);
/// Two counts that rounding may tell apart: told, never a disagreement.
[[nodiscard]] Verdict tellDifference(const NamedCounts& one, const NamedCounts& other,
                                     std::span<const std::uint32_t> poses);

/// Of the methods that count the device's rasteriser's fragments, and of those that count the exact ones.
[[nodiscard]] std::vector<NamedCounts> rasterGroup(std::span<const NamedCounts> counts);
[[nodiscard]] std::vector<NamedCounts> exactGroup(std::span<const NamedCounts> counts);
/// The rules for counts: who must agree, and how far the two groups are apart.
[[nodiscard]] std::vector<Verdict> judgeCounts(const std::vector<NamedCounts>& counts,
                                               std::span<const std::uint32_t> poses);
[[nodiscard]] Verdict notChecked(std::string rule, std::string why);

/// A fragment that the rasteriser of the device has and the oracle has not, or the other way round.
struct DifferingFragment {
    std::uint32_t pose = 0;
    std::uint32_t triangle = 0;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    bool onDevice = false;
    std::string reason;      ///< "coverage", "coordinate", "opacity"; "none" is a disagreement
    double edgeDistance = 0; ///< pixels; negative outside
    double domainDistance = 0;
    double opacity = 0;
    double opacityLow = 0;
    double opacityHigh = 0;
};

/// One pose, fragment by fragment.
struct FragmentCheck {
    std::uint32_t pose = 0;
    std::uint64_t onDevice = 0; ///< fragments listed by the device
    std::uint64_t byOracle = 0;
    std::optional<std::uint64_t> counted; ///< by the methods that use the device's rasteriser
    std::vector<DifferingFragment> differing;
};

inline constexpr const char* kFragmentRule = "device's rasteriser and oracle, fragment by fragment";
/// Every fragment of one side only has its reason, and the device lists as many fragments as it counts.
[[nodiscard]] Verdict judgeFragments(std::span<const FragmentCheck> checks);

/// Differing fragments for each reason, in the order of kReasons.
inline constexpr std::array<const char*, 4> kReasons{"coverage", "coordinate", "opacity", "none"};
[[nodiscard]] std::array<std::uint64_t, 4> countReasons(std::span<const FragmentCheck> checks);

} // namespace voxtact::lab

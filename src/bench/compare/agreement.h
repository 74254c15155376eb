// SPDX-License-Identifier: MIT
#pragma once

#include "core/method/method_table.h"
#include "oracle/oracle.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Who must agree with whom, judged from numbers alone: no device, no files.
namespace voxtact::lab {

/// What one method counted, a number per pose.
struct NamedCounts {
    std::string method;
    std::vector<std::uint64_t> counts{};
};

/// The first pose on which a rule is broken.
struct Disagreement {
    std::uint32_t pose = 0; ///< its number in the list of poses
    std::string text;       ///< "query 812, atomic 811"
};

/// A row of the table of agreement.
struct CompareVerdict {
    std::string rule{};          ///< "query = atomic = subgroup"
    std::string members{};       ///< of the rule: "query, atomic and subgroup"
    std::string unit = "poses";  ///< what is counted below
    bool byRule = false;         ///< compared is what the rule says, not whether counts are equal
    bool required = true;        ///< a difference is a disagreement; otherwise it is only told
    std::string unchecked{};     ///< why there was nothing to compare; empty: it was compared
    std::uint64_t compared = 0;  ///< units; 0 where it is unchecked
    std::uint64_t differing = 0; ///< of these
    std::uint64_t largest = 0;   ///< difference of two counts, in fragments
    std::string detail{};        ///< a line for people
    std::string sweep = "none";  ///< the --sweep that meets it
    std::optional<Disagreement> first{};

    [[nodiscard]] bool failed() const noexcept { return required && first.has_value(); }
};

/// In words, of one that failed.
[[nodiscard]] std::string disagreementOf(const CompareVerdict& verdict);

/// Equal on every pose. `poses` holds the numbers of the poses that the counts belong to.
[[nodiscard]] CompareVerdict judgeEqual(std::span<const NamedCounts> group, std::span<const std::uint32_t> poses);
/// A hit of the one (not zero) exactly where the other has a fragment.
[[nodiscard]] CompareVerdict judgeHits(const NamedCounts& any, const NamedCounts& exact,
                                       std::span<const std::uint32_t> poses);
/// Fragments by which a rasteriser may count otherwise than the host, besides half of what the host counts.
inline constexpr std::uint64_t kRoundedFragments = 64;
/// Whether what a rasteriser counts can be what the host counts but for roundings at pixels' centres and between table
/// entries. `yesNo`: of a method that knows whether there are fragments, and not how many.
[[nodiscard]] bool explainedByRounding(std::uint64_t raster, std::uint64_t host, bool yesNo = false) noexcept;
/// In words.
[[nodiscard]] std::string roundingRule(const std::string& raster, const std::string& host, bool yesNo = false);
/// That holds on every pose.
[[nodiscard]] CompareVerdict judgeRounding(const NamedCounts& raster, const NamedCounts& host,
                                           std::span<const std::uint32_t> poses);
/// Two counts that rounding may tell apart: told, never a disagreement.
[[nodiscard]] CompareVerdict tellDifference(const NamedCounts& one, const NamedCounts& other,
                                            std::span<const std::uint32_t> poses);

/// Of the methods that count all fragments, of the device's rasteriser or the exact ones.
[[nodiscard]] std::vector<NamedCounts> countsBy(std::span<const NamedCounts> counts, Coverage coverage);
/// The places of the poses on which one of the methods counts anything.
[[nodiscard]] std::vector<std::uint32_t> touchingPoses(std::span<const NamedCounts> counts);
/// The rules for counts: who must agree, how far the two groups are apart, and that roundings explain it.
[[nodiscard]] std::vector<CompareVerdict> judgeCounts(std::span<const NamedCounts> counts,
                                                      std::span<const std::uint32_t> poses);

/// A fragment that the rasteriser of the device has and the oracle has not, or the other way round.
struct DifferingFragment {
    std::uint32_t pose = 0;
    oracle::OracleFragment fragment{};
    bool onDevice = false;
    oracle::Evidence evidence{};

    /// Why they may differ; none is a disagreement.
    [[nodiscard]] oracle::Doubt doubt() const noexcept { return evidence.doubt; }
};

/// One pose, fragment by fragment.
struct FragmentCheck {
    std::uint32_t pose = 0;
    std::uint64_t onDevice = 0; ///< fragments listed by the device
    std::uint64_t byOracle = 0;
    std::optional<std::uint64_t> counted{}; ///< by the methods that use the device's rasteriser
    std::vector<DifferingFragment> differing{};
};

inline constexpr const char* kFragmentRule = "device's rasteriser and oracle, fragment by fragment";
/// Every fragment of one side only has its reason, and the device lists as many fragments as it counts.
[[nodiscard]] CompareVerdict judgeFragments(std::span<const FragmentCheck> checks);

/// In the order in which they are told.
inline constexpr std::array<oracle::Doubt, 4> kDoubts{oracle::Doubt::Coverage, oracle::Doubt::Coordinate,
                                                      oracle::Doubt::Opacity, oracle::Doubt::None};
/// How many fragments differ for that reason.
[[nodiscard]] std::uint64_t countOf(oracle::Doubt doubt, std::span<const FragmentCheck> checks);

} // namespace voxtact::lab

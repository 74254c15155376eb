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

/// Counts of one method, one per pose.
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
    std::string unit = "poses";  ///< what the numbers below count
    bool byRule = false;         ///< tests the rule, not the equality of counts
    bool required = true;        ///< a difference is a disagreement; otherwise only reported
    std::string unchecked{};     ///< why nothing was compared; empty: compared
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
/// Touches (not zero) of one exactly where the other has a fragment.
[[nodiscard]] CompareVerdict judgeHits(const NamedCounts& any, const NamedCounts& exact,
                                       std::span<const std::uint32_t> poses);
/// Fragments by which a rasteriser may differ from the host, in addition to half of the host's count.
inline constexpr std::uint64_t kRoundedFragments = 64;
/// Returns true if rounding at pixel centres and between table entries explains the difference of a rasteriser's count
/// from the host's. `yesNo`: for a method that counts 0 or 1.
[[nodiscard]] bool explainedByRounding(std::uint64_t raster, std::uint64_t host, bool yesNo = false) noexcept;
/// In words.
[[nodiscard]] std::string roundingRule(const std::string& raster, const std::string& host, bool yesNo = false);
/// That holds on every pose.
[[nodiscard]] CompareVerdict judgeRounding(const NamedCounts& raster, const NamedCounts& host,
                                           std::span<const std::uint32_t> poses);
/// Two counts that rounding may separate: reported, never a disagreement.
[[nodiscard]] CompareVerdict tellDifference(const NamedCounts& one, const NamedCounts& other,
                                            std::span<const std::uint32_t> poses);

/// Methods that count all fragments, by the device's rasteriser or exactly.
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

/// In the order of the report.
inline constexpr std::array<oracle::Doubt, 4> kDoubts{oracle::Doubt::Coverage, oracle::Doubt::Coordinate,
                                                      oracle::Doubt::Opacity, oracle::Doubt::None};
/// Number of fragments that differ for that reason.
[[nodiscard]] std::uint64_t countOf(oracle::Doubt doubt, std::span<const FragmentCheck> checks);

} // namespace voxtact::lab

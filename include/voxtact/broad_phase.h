// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// Two boxes that overlap: their numbers, `first` < `second`.
struct BoxPair {
    std::uint32_t first = 0;  ///< number of a box in the first span
    std::uint32_t second = 0; ///< in the same span, or in the second one
    /// By `first`, then by `second`.
    // clang-tidy 14 takes the 0 that the compiler writes for a null pointer.
    auto operator<=>(const BoxPair&) const = default; // NOLINT(modernize-use-nullptr)
};

/// The broad phase: all pairs of closed boxes that share a point, sorted; touching counts. Sweep and prune along the
/// axis on which the centres vary most (Cohen et al., "I-COLLIDE", 1995, section 3). A box with a NaN or with
/// lo > hi overlaps nothing. O(n log n + overlaps along the axis).
[[nodiscard]] VOXTACT_API Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> boxes);

/// The same between two sets: `first` is a number in `left`, `second` one in `right`.
[[nodiscard]] VOXTACT_API Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> left,
                                                                        std::span<const Box> right);

/// The box of a box's eight corners under an affine matrix, rounded outward (what is exact stays exact): for the world
/// box of a mesh at a pose (world_from_object), or of a volume (world_from_texture of the box [0,1]^3). A box that
/// overlaps nothing, and a matrix that is not finite, give a box that overlaps nothing.
[[nodiscard]] VOXTACT_API Box transformBox(const Mat4& b_from_a, const Box& box) noexcept;

} // namespace voxtact

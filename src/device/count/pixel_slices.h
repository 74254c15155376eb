// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/pass_desc.h"
#include "vulkan/context_impl.h"

#include <cstdint>
#include <span>

namespace voxtact {

/// In how many slices the method `compute` deals the pixels of the large triangles of a work group: one where they are
/// small, so that their work group does all; more where they may have more pixels than one invocation should look at.
/// Each slice is a work group of its own.
class PixelSlices {
  public:
    /// Of a checked item, whose pairs are seen in a viewport of that size.
    PixelSlices(const ContextImpl& context, const PassDesc& desc, const Batch& batch, const BatchItem& item,
                VkExtent2D viewport) noexcept;

    /// Of the triangles of a work group.
    [[nodiscard]] std::uint32_t of(std::uint32_t group) const noexcept;
    /// The work groups from `first` on, and before `end`, that have as many slices as that one.
    [[nodiscard]] std::uint32_t endOf(std::uint32_t first, std::uint32_t end) const noexcept;

  private:
    std::span<const double> squaresBefore_; ///< MeshKnown::squaresBeforeGroup
    double scale_ = 0;                      ///< pixels an object unit, squared
    double viewport_ = 0;                   ///< pixels
    std::uint32_t ofUnknown_ = 1;           ///< where the host does not know the mesh
    std::uint32_t most_ = 1;
};

/// Rounds of the loops over pixels, of a lane, at most: llvmpipe ends loops after 65,535 (docs/facts.md).
inline constexpr double kMostPixelRounds = 49152;

} // namespace voxtact

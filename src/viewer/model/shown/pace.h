// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/shown/camera.h"

#include <array>

namespace voxtact::view {

/// How much of a picture a frame may make, from how long the ones before it took.
class Pace {
  public:
    /// Milliseconds that a frame's picture may take.
    explicit Pace(double budget) : budget_(budget) {}

    /// A coarse picture of so many pixels took so long.
    void tookCoarse(double pixels, double milliseconds);
    /// So many pixels of a fine one, which cost more each.
    void tookFine(double pixels, double milliseconds);

    /// Of the coarse picture: as large as fits, not larger than `full`, with its shape.
    [[nodiscard]] Extent coarse(const Extent& full) const;
    /// Rows of the fine picture for a frame; at least 1.
    [[nodiscard]] std::uint32_t rows(const Extent& full) const;

  private:
    double budget_;
    // Milliseconds per pixel: guesses for a slow machine, until something was measured.
    double coarseCost_ = 1e-3;
    double fineCost_ = 2e-3;
};

/// Of a picture that takes up the upper left part of a texture: how large that is, and how far a sample may go so that
/// none of the texels round it lies beyond. Shares of the texture's sides.
struct SampledPart {
    std::array<float, 2> used{1, 1};
    std::array<float, 2> most{1, 1};
};
[[nodiscard]] SampledPart sampledPart(const Extent& picture, const Extent& texture);

} // namespace voxtact::view

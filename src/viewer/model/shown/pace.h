// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/shown/camera.h"

#include <array>

namespace voxtact::view {

/// Chooses the size of a frame's picture from the duration of earlier ones.
class Pace {
  public:
    /// Milliseconds that a frame's picture may take.
    explicit Pace(double budget) : budget_(budget) {}

    /// Records the duration of a coarse picture of this number of pixels.
    void tookCoarse(double pixels, double milliseconds);
    /// Records the duration of pixels of a fine picture, which are slower.
    void tookFine(double pixels, double milliseconds);

    /// Size of the coarse picture: the largest that fits, at most `full`, with its aspect ratio.
    [[nodiscard]] Extent coarse(const Extent& full) const;
    /// Rows of the fine picture for a frame; at least 1.
    [[nodiscard]] std::uint32_t rows(const Extent& full) const;

  private:
    double budget_;
    // Milliseconds per pixel: guesses for a slow machine, until something was measured.
    double coarseCost_ = 1e-3;
    double fineCost_ = 2e-3;
};

/// Part of a texture in its upper left: its size, and the limit of sample positions whose texels all lie inside.
/// Fractions of the texture's sides.
struct SampledPart {
    std::array<float, 2> used{1, 1};
    std::array<float, 2> most{1, 1};
};
[[nodiscard]] SampledPart sampledPart(const Extent& picture, const Extent& texture);

} // namespace voxtact::view

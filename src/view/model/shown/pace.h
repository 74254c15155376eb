// SPDX-License-Identifier: MIT
#pragma once

#include "view/model/shown/camera.h"

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
    // Milliseconds a pixel: guesses for a slow machine, until something was measured.
    double coarseCost_ = 1e-3;
    double fineCost_ = 2e-3;
};

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"
#include "voxtact/data.h"
#include "voxtact/methods.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace voxtact {

/// The cameras of a projection for each pair, in the order of the PairTransforms.
class Cameras {
  public:
    /// A projection without camera places every point in the middle of the view volume, so that nothing is culled or
    /// clipped.
    Cameras(Projection projection, const View& view) noexcept;

    [[nodiscard]] std::span<const Mat4> clip_from_world() const noexcept { return std::span(matrices_).first(count_); }

  private:
    std::array<Mat4, 2> matrices_{};
    std::size_t count_ = 1;
};

/// Cameras of a projection.
[[nodiscard]] std::uint32_t viewsPerPair(Projection projection) noexcept;

/// Pixels along the side of the square viewport of the projection `dominant-axis`.
[[nodiscard]] std::uint64_t dominantSide(const Grid& grid, std::uint32_t samplesPerVoxel) noexcept;
[[nodiscard]] shader::DominantGrid dominantGrid(const Grid& grid) noexcept;
/// "dominant-axis with 4 samples per voxel needs a viewport of 1024x1024"
[[nodiscard]] std::string dominantNeeds(const Grid& grid, std::uint32_t samplesPerVoxel);

/// Refuses samples per voxel outside of 1 to kMaxSamplesPerVoxel.
[[nodiscard]] Result<void> checkSamples(std::uint32_t samplesPerVoxel);

} // namespace voxtact

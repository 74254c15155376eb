// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// What people do today: an exact Euclidean distance transform of the opaque voxels, by ITK. Of plain types alone, for
/// ITK's headers take long to compile.
namespace voxtact::bench {

/// Millimetres from the centre of each cell to that of the nearest opaque one.
class DistanceMap {
  public:
    /// Cubes of `side` mm, x fastest; ITK runs on one thread.
    DistanceMap(const std::array<std::uint32_t, 3>& size, double side, const std::vector<bool>& opaque);

    /// Linear between the centres. In cells, from the first one's corner on; clamped to where there are centres.
    [[nodiscard]] double at(const std::array<double, 3>& place) const;

    /// "ITK 5.2.1"
    [[nodiscard]] static std::string version();

  private:
    std::array<std::uint32_t, 3> size_;
    std::vector<float> distance_;
};

} // namespace voxtact::bench

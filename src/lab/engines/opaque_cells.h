// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxtact::lab {

/// Whether a value's opacity, by a table, reaches a threshold.
class IsOpaque {
  public:
    /// A table as sampleTable() gives it.
    IsOpaque(std::vector<float> table, const ValueRange& domain, double threshold)
        : table_(std::move(table)), domain_(domain), threshold_(threshold) {}

    [[nodiscard]] bool operator()(double value) const;

  private:
    std::vector<float> table_;
    ValueRange domain_;
    double threshold_;
};

/// The opaque voxels of a volume as cubes, which is how an octree has them.
struct OpaqueCells {
    std::array<std::uint32_t, 3> size{}; ///< cells
    double side = 0;                     ///< mm: the smallest spacing
    Mat4 world_from_cells{};             ///< rigid; cell (i, j, k) is from (i, j, k) * side to one side further on
    std::vector<bool> opaque;            ///< x fastest
    bool resampled = false;              ///< the voxels are no cubes: a cell has the value of the voxel at its centre
};

/// Unsupported where the axes of the grid are not at right angles. Expects a volume that checkVolume() accepts.
[[nodiscard]] Result<OpaqueCells> opaqueCells(const VolumeView& volume, const TransferFunctionDesc& function,
                                              double threshold);

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "viewer/model/files/coarser.h"
#include "core/base/refuse.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace voxtact::view {

namespace {

using Sides = std::array<std::uint32_t, 3>;

Sides blockOf(const Grid& grid, std::uint32_t factor) {
    Sides block{};
    std::ranges::transform(grid.size, block.begin(),
                           [factor](std::uint32_t size) { return size / factor < 2 ? 1 : factor; });
    return block;
}

/// A voxel's centre is its block's, as if no block were cut off.
Grid gridOf(const Grid& grid, const Sides& block) {
    Grid out = grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.size[axis] = (grid.size[axis] + block[axis] - 1) / block[axis];
        out.spacing[axis] = grid.spacing[axis] * block[axis];
        const double shift = grid.spacing[axis] * (block[axis] - 1) / 2;
        for (std::size_t i = 0; i < 3; ++i) {
            out.origin[i] += shift * grid.direction[3 * axis + i];
        }
    }
    return out;
}

template <class Scalar> Scalar nearest(double mean) {
    return static_cast<Scalar>(std::is_integral_v<Scalar> ? std::nearbyint(mean) : mean);
}

template <class Scalar> class Blocks {
  public:
    Blocks(const VolumeData& from, VolumeData& to, const Sides& block)
        : from_(&from), to_(&to), block_(block), sums_(to.grid.size[0]), counts_(to.grid.size[0]) {}

    void makeRow(std::uint32_t y, std::uint32_t z) {
        std::ranges::fill(sums_, 0.0);
        std::ranges::fill(counts_, 0U);
        const Sides& size = from_->grid.size;
        for (std::uint32_t k = z * block_[2]; k < std::min((z + 1) * block_[2], size[2]); ++k) {
            for (std::uint32_t j = y * block_[1]; j < std::min((y + 1) * block_[1], size[1]); ++j) {
                addRow(j, k);
            }
        }
        const std::size_t at = (std::size_t{z} * to_->grid.size[1] + y) * to_->grid.size[0];
        for (std::size_t x = 0; x < sums_.size(); ++x) {
            const Scalar value = nearest<Scalar>(sums_[x] / counts_[x]);
            std::memcpy(to_->voxels.data() + (at + x) * sizeof(Scalar), &value, sizeof value);
        }
    }

  private:
    void addRow(std::uint32_t j, std::uint32_t k) {
        const Sides& size = from_->grid.size;
        const std::byte* const row = from_->voxels.data() + (std::size_t{k} * size[1] + j) * size[0] * sizeof(Scalar);
        for (std::uint32_t i = 0; i < size[0]; ++i) {
            Scalar value{};
            std::memcpy(&value, row + i * sizeof(Scalar), sizeof value);
            sums_[i / block_[0]] += static_cast<double>(value);
            ++counts_[i / block_[0]];
        }
    }

    const VolumeData* from_;
    VolumeData* to_;
    Sides block_;
    std::vector<double> sums_; ///< of a row of the new volume
    std::vector<std::uint32_t> counts_;
};

template <class Scalar>
bool fill(const VolumeData& from, VolumeData& to, const Sides& block, const std::function<bool(double)>& tell) {
    Blocks<Scalar> blocks(from, to, block);
    for (std::uint32_t z = 0; z < to.grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < to.grid.size[1]; ++y) {
            blocks.makeRow(y, z);
        }
        if (tell && !tell((z + 1.0) / to.grid.size[2])) {
            return false;
        }
    }
    return true;
}

} // namespace

Result<VolumeData> coarser(const VolumeData& volume, std::uint32_t factor, const std::function<bool(double)>& tell) {
    if (factor < 2) {
        return refuse("the factor must be 2 or more");
    }
    const Sides block = blockOf(volume.grid, factor);
    VolumeData out;
    out.grid = gridOf(volume.grid, block);
    out.type = volume.type;
    out.name = volume.name;
    out.voxels.resize(voxelCount(out.grid) * bytesPerVoxel(out.type));
    bool done = false;
    switch (volume.type) {
    case ScalarType::UInt8:
        done = fill<std::uint8_t>(volume, out, block, tell);
        break;
    case ScalarType::Int16:
        done = fill<std::int16_t>(volume, out, block, tell);
        break;
    case ScalarType::UInt16:
        done = fill<std::uint16_t>(volume, out, block, tell);
        break;
    case ScalarType::Float32:
        done = fill<float>(volume, out, block, tell);
        break;
    }
    return done ? Result<VolumeData>(std::move(out)) : Error{ErrorCode::Cancelled, 0, "cancelled"};
}

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#include "cpu/stored_image.h"
#include "core/voxel_visit.h"
#include "cpu/stored_voxels.h"

#include <algorithm>
#include <cstring>

namespace voxtact::cpu {

namespace {

/// A look-up of two neighbours reads four bytes.
constexpr std::size_t kSlack = 4;

std::uint8_t keep(std::uint8_t voxel) {
    return voxel;
}
std::uint16_t keep(std::uint16_t voxel) {
    return voxel;
}
std::uint16_t keep(std::int16_t voxel) {
    return static_cast<std::uint16_t>(static_cast<int>(voxel) + 32768);
}
float keep(float voxel) {
    return voxel;
}

Stored storedAs(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return Stored::UInt8;
    case ScalarType::Int16:
    case ScalarType::UInt16:
        return Stored::UInt16;
    case ScalarType::Float32:
        break;
    }
    return Stored::Float;
}

template <class Scalar> void fill(const Grid& grid, const Scalar* voxels, StoredImage& image) {
    using Kept = decltype(keep(*voxels));
    const auto strideZ = static_cast<std::size_t>(image.stride[2]);
    image.bytes.resize(strideZ * (grid.size[2] + std::size_t{2}) * sizeof(Kept) + kSlack);
    std::byte* to = image.bytes.data();
    const auto put = [&to](Scalar voxel) {
        const Kept kept = keep(voxel);
        std::memcpy(to, &kept, sizeof kept);
        to += sizeof kept;
    };
    const auto source = [](std::size_t padded, std::uint32_t size) {
        return std::clamp<std::size_t>(padded, 1, size) - 1;
    };
    for (std::size_t z = 0; z < grid.size[2] + std::size_t{2}; ++z) {
        for (std::size_t y = 0; y < grid.size[1] + std::size_t{2}; ++y) {
            const Scalar* row =
                voxels + (source(z, grid.size[2]) * grid.size[1] + source(y, grid.size[1])) * grid.size[0];
            put(row[0]);
            for (std::size_t x = 0; x < grid.size[0]; ++x) {
                put(row[x]);
            }
            put(row[grid.size[0] - 1]);
        }
    }
}

/// The padded voxels that the cells of a brick have corners at.
struct Extent {
    std::int64_t first;
    std::int64_t end;
};

Extent extentOf(std::int32_t brick, std::int32_t size) {
    const std::int64_t first = std::int64_t{brick} << kBrickShift;
    return {first, std::min(first + (1 << kBrickShift) + 1, std::int64_t{size} + 2)};
}

template <class Kept> void rangesOf(const StoredImage& image, const Kept* voxels, BrickRanges& out) {
    for (std::int32_t brickZ = 0; brickZ < out.count[2]; ++brickZ) {
        for (std::int32_t brickY = 0; brickY < out.count[1]; ++brickY) {
            for (std::int32_t brickX = 0; brickX < out.count[0]; ++brickX) {
                const Extent extentX = extentOf(brickX, image.size[0]);
                const Extent extentY = extentOf(brickY, image.size[1]);
                const Extent extentZ = extentOf(brickZ, image.size[2]);
                Kept lo = voxels[extentX.first + extentY.first * image.stride[1] + extentZ.first * image.stride[2]];
                Kept hi = lo;
                for (std::int64_t z = extentZ.first; z < extentZ.end; ++z) {
                    for (std::int64_t y = extentY.first; y < extentY.end; ++y) {
                        const Kept* row = voxels + y * image.stride[1] + z * image.stride[2];
                        for (std::int64_t x = extentX.first; x < extentX.end; ++x) {
                            lo = std::min(lo, row[x]);
                            hi = std::max(hi, row[x]);
                        }
                    }
                }
                out.lo.push_back(storedValue(lo));
                out.hi.push_back(storedValue(hi));
            }
        }
    }
}

} // namespace

StoredImage::StoredImage(const VolumeView& volume) : type(storedAs(volume.type)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size[axis] = static_cast<std::int32_t>(volume.grid.size[axis]);
    }
    stride = {1, std::int64_t{size[0]} + 2, (std::int64_t{size[0]} + 2) * (std::int64_t{size[1]} + 2)};
    visitVoxels(volume, [&](const auto* voxels) { fill(volume.grid, voxels, *this); });
}

BrickRanges::BrickRanges(const StoredImage& image) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count[axis] = brickCount(image.size[axis]);
    }
    image.visit([&](const auto* voxels) { rangesOf(image, voxels, *this); });
}

} // namespace voxtact::cpu

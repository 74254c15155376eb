// SPDX-License-Identifier: MIT
#include "host/scene/stored_image.h"
#include "core/volume/voxel_visit.h"
#include "host/scene/stored_voxels.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace voxtact::cpu {

namespace {

/// A lookup of two neighbours reads four bytes.
constexpr std::size_t kBytesBehind = 4;

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
/// Inverts keep().
template <class Scalar> Scalar kept(decltype(keep(Scalar{})) voxel) {
    if constexpr (std::is_same_v<Scalar, std::int16_t>) {
        return static_cast<std::int16_t>(static_cast<int>(voxel) - 32768);
    } else {
        return voxel;
    }
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
    image.bytes.resize(strideZ * (grid.size[2] + std::size_t{2}) * sizeof(Kept) + kBytesBehind);
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

/// Padded voxels along an axis.
struct Extent {
    std::int64_t first;
    std::int64_t end;
};

/// Range of stored voxels; the outermost ones are stored twice.
Extent copiesOf(std::uint32_t first, std::uint32_t end, std::int32_t size) {
    const bool last = end == static_cast<std::uint32_t>(size);
    return {first == 0 ? 0 : std::int64_t{first} + 1, std::int64_t{end} + (last ? 2 : 1)};
}

template <class Scalar>
void replaceRow(StoredImage& image, const VoxelRow& row, const std::byte* voxels, std::size_t step) {
    using Kept = decltype(keep(Scalar{}));
    const Extent extentX = copiesOf(row.firstX, row.endX, image.size[0]);
    const Extent extentY = copiesOf(row.y, row.y + 1, image.size[1]);
    const Extent extentZ = copiesOf(row.z, row.z + 1, image.size[2]);
    const auto keptAt = [&](std::int64_t x) {
        const std::int64_t source = std::clamp<std::int64_t>(x - 1, row.firstX, std::int64_t{row.endX} - 1);
        Scalar voxel;
        std::memcpy(&voxel, voxels + static_cast<std::size_t>(source - row.firstX) * step, sizeof voxel);
        return keep(voxel);
    };
    for (std::int64_t z = extentZ.first; z < extentZ.end; ++z) {
        for (std::int64_t y = extentY.first; y < extentY.end; ++y) {
            std::byte* to =
                image.bytes.data() + static_cast<std::size_t>(z * image.stride[2] + y * image.stride[1]) * sizeof(Kept);
            for (std::int64_t x = extentX.first; x < extentX.end; ++x) {
                const Kept value = keptAt(x);
                std::memcpy(to + static_cast<std::size_t>(x) * sizeof value, &value, sizeof value);
            }
        }
    }
}

template <class Scalar> void copyRow(const StoredImage& image, const VoxelRow& row, std::byte* voxels) {
    using Kept = decltype(keep(Scalar{}));
    const std::int64_t first =
        (std::int64_t{row.z} + 1) * image.stride[2] + (std::int64_t{row.y} + 1) * image.stride[1] + 1;
    const std::byte* from = image.bytes.data() + static_cast<std::size_t>(first) * sizeof(Kept);
    for (std::size_t x = row.firstX; x < row.endX; ++x, voxels += sizeof(Scalar)) {
        Kept voxel;
        std::memcpy(&voxel, from + x * sizeof voxel, sizeof voxel);
        const auto value = kept<Scalar>(voxel);
        std::memcpy(voxels, &value, sizeof value);
    }
}

/// The padded voxels that the cells of a brick have corners at.
Extent extentOf(std::int32_t brick, std::int32_t size) {
    const std::int64_t first = std::int64_t{brick} << kBrickShift;
    return {first, std::min(first + (1 << kBrickShift) + 1, std::int64_t{size} + 2)};
}

/// Bricks of a box, both ends inclusive.
struct Bricks {
    std::array<std::int32_t, 3> lo{};
    std::array<std::int32_t, 3> hi{};
};

/// The bricks that edited voxels are a corner in.
Bricks bricksAround(const StoredImage& image, const BrickRanges& ranges, const VoxelBox& edited) {
    Bricks bricks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Extent copies = copiesOf(edited.first[axis], edited.first[axis] + edited.size[axis], image.size[axis]);
        // A brick's first layer of corners is also the last one of the brick before.
        const std::int64_t first = std::max<std::int64_t>(copies.first - 1, 0) >> kBrickShift;
        const std::int64_t last = (copies.end - 1) >> kBrickShift;
        bricks.lo[axis] = static_cast<std::int32_t>(first);
        bricks.hi[axis] = static_cast<std::int32_t>(std::min<std::int64_t>(last, ranges.count[axis] - 1));
    }
    return bricks;
}

template <class Kept>
void rangesOf(const StoredImage& image, const Kept* voxels, const Bricks& bricks, BrickRanges& out) {
    for (std::int32_t brickZ = bricks.lo[2]; brickZ <= bricks.hi[2]; ++brickZ) {
        for (std::int32_t brickY = bricks.lo[1]; brickY <= bricks.hi[1]; ++brickY) {
            for (std::int32_t brickX = bricks.lo[0]; brickX <= bricks.hi[0]; ++brickX) {
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
                const auto brick =
                    static_cast<std::size_t>((std::int64_t{brickZ} * out.count[1] + brickY) * out.count[0] + brickX);
                out.lo[brick] = storedValue(lo);
                out.hi[brick] = storedValue(hi);
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

void StoredImage::replace(const VoxelRow& row, ScalarType from, const std::byte* voxels, std::size_t step) {
    switch (from) {
    case ScalarType::UInt8:
        return replaceRow<std::uint8_t>(*this, row, voxels, step);
    case ScalarType::Int16:
        return replaceRow<std::int16_t>(*this, row, voxels, step);
    case ScalarType::UInt16:
        return replaceRow<std::uint16_t>(*this, row, voxels, step);
    case ScalarType::Float32:
        break;
    }
    replaceRow<float>(*this, row, voxels, step);
}

void StoredImage::copy(const VoxelRow& row, ScalarType as, std::byte* voxels) const {
    switch (as) {
    case ScalarType::UInt8:
        return copyRow<std::uint8_t>(*this, row, voxels);
    case ScalarType::Int16:
        return copyRow<std::int16_t>(*this, row, voxels);
    case ScalarType::UInt16:
        return copyRow<std::uint16_t>(*this, row, voxels);
    case ScalarType::Float32:
        break;
    }
    copyRow<float>(*this, row, voxels);
}

BrickRanges::BrickRanges(const StoredImage& image) {
    Bricks all;
    std::size_t bricks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count[axis] = brickCount(image.size[axis]);
        all.hi[axis] = count[axis] - 1;
        bricks *= static_cast<std::size_t>(count[axis]);
    }
    lo.resize(bricks);
    hi.resize(bricks);
    image.visit([&](const auto* voxels) { rangesOf(image, voxels, all, *this); });
}

void BrickRanges::update(const StoredImage& image, const VoxelBox& edited) {
    const Bricks touched = bricksAround(image, *this, edited);
    image.visit([&](const auto* voxels) { rangesOf(image, voxels, touched, *this); });
}

} // namespace voxtact::cpu

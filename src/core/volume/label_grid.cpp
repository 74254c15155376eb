// SPDX-License-Identifier: MIT
#include "core/volume/label_grid.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/distance.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

std::string toText(const Vec3& vector) {
    return number(vector[0]) + ", " + number(vector[1]) + ", " + number(vector[2]);
}

std::string toText(const std::array<std::uint32_t, 3>& size) {
    return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]);
}

/// In voxels of the volume.
Vec3 voxelAt(const Mat4& texture_from_world, const Grid& volume, const Vec3& world) {
    Vec3 voxel = transformPoint(texture_from_world, world);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        voxel[axis] = voxel[axis] * volume.size[axis] - 0.5;
    }
    return voxel;
}

/// Offset of the label map in the volume, and the maximum distance of its corners from whole voxels.
struct GridOffset {
    Vec3 first{};
    double off = 0;
};

Result<GridOffset> offsetOf(const Grid& labels, const Grid& volume) {
    const Result<Mat4> texture_from_world = textureFromWorld(volume);
    VOXTACT_TRY(texture_from_world);
    const Mat4 world_from_index = worldFromIndex(labels);
    GridOffset offset;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vec3 voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxel[axis] = (corner >> axis & 1U) != 0 ? labels.size[axis] - 1.0 : 0.0;
        }
        const Vec3 there = voxelAt(*texture_from_world, volume, transformPoint(world_from_index, voxel));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            offset.first[axis] = corner == 0 ? std::round(there[axis]) : offset.first[axis];
            offset.off = std::max(offset.off, std::abs(there[axis] - offset.first[axis] - voxel[axis]));
        }
    }
    return offset;
}

bool isInside(const Grid& labels, const Grid& volume, const Vec3& first) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(first[axis] >= 0 && first[axis] + labels.size[axis] <= volume.size[axis])) {
            return false;
        }
    }
    return true;
}

/// Returns the differences of a label map's grid.
std::string differenceOf(const Grid& labels, const Grid& volume, const GridOffset& offset) {
    constexpr double kAlike = 1e-3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double voxels = kAlike / labels.size[axis]; // that add up over the map
        if (!(std::abs(labels.spacing[axis] / volume.spacing[axis] - 1) <= voxels)) {
            return "its spacing is " + toText(labels.spacing) + " mm, that of the volume " + toText(volume.spacing) +
                   " mm";
        }
        for (std::size_t row = 0; row < 3; ++row) {
            if (!(std::abs(labels.direction[3 * axis + row] - volume.direction[3 * axis + row]) <= voxels)) {
                return "its axis " + std::string(1, "xyz"[axis]) + " runs along another direction";
            }
        }
    }
    const Result<Mat4> texture_from_world = textureFromWorld(volume);
    Vec3 first = texture_from_world.ok() ? voxelAt(*texture_from_world, volume, labels.origin) : offset.first;
    for (double& voxel : first) {
        voxel = std::round(voxel * 1000) / 1000 + 0.0;
    }
    const bool isWhole = offset.off <= kAlike;
    return "its " + toText(labels.size) + " voxels begin at voxel " + toText(first) + " of the volume's " +
           toText(volume.size) +
           (!isWhole                                  ? ", not at a whole one"
            : !isInside(labels, volume, offset.first) ? ", and reach beyond them"
                                                      : "");
}

Error notOnGrid(const Grid& labels, const Grid& volume, const GridOffset& offset, const std::string& which) {
    return {ErrorCode::Unsupported, 0,
            which + ": the label map is not on the grid of the volume: " + differenceOf(labels, volume, offset) +
                "; resample it to that"};
}

} // namespace

Result<void> checkLabelGrid(const Grid& labels, const Grid& volume, const std::string& which) {
    constexpr double kApart = 1e-4; // voxels
    const Result<GridOffset> offset = offsetOf(labels, volume);
    VOXTACT_TRY(offset);
    const bool isOnGrid = labels.size == volume.size && offset->off <= kApart && offset->first == Vec3{};
    return isOnGrid ? Result<void>() : notOnGrid(labels, volume, *offset, which);
}

Result<LabelData> labelsOnGrid(const LabelData& labels, const Grid& volume, const std::string& which) {
    return guard([&]() -> Result<LabelData> {
        constexpr double kApart = 1e-3; // voxels
        const Result<GridOffset> offset = offsetOf(labels.grid, volume);
        VOXTACT_TRY(offset);
        if (offset->off > kApart || !isInside(labels.grid, volume, offset->first)) {
            return notOnGrid(labels.grid, volume, *offset, which);
        }
        const auto none = std::ranges::lower_bound(labels.values, 0) - labels.values.begin();
        LabelData out{volume, {}, labels.values};
        out.indices.assign(static_cast<std::size_t>(voxelCount(volume)), static_cast<std::uint16_t>(none));
        const auto [columns, rows, slices] = labels.grid.size;
        const std::uint16_t* from = labels.indices.data();
        for (std::uint32_t slice = 0; slice < slices; ++slice) {
            for (std::uint32_t row = 0; row < rows; ++row, from += columns) {
                const std::size_t line = (static_cast<std::size_t>(offset->first[2]) + slice) * volume.size[1] +
                                         static_cast<std::size_t>(offset->first[1]) + row;
                std::copy_n(from, columns,
                            out.indices.begin() +
                                static_cast<std::ptrdiff_t>(line * volume.size[0] +
                                                            static_cast<std::size_t>(offset->first[0])));
            }
        }
        return out;
    });
}

Result<LabelData> labelsOnGrid(const LabelData& labels, const Grid& volume) {
    VOXTACT_TRY(checkGrid(volume));
    VOXTACT_TRY(checkGrid(labels.grid));
    if (voxelCount(labels.grid) != labels.indices.size() || !std::ranges::binary_search(labels.values, 0)) {
        return refuse("the label map is none of makeLabels()");
    }
    return labelsOnGrid(labels, volume, "the label map");
}

Result<void> checkMeasuredLabels(std::span<const std::int32_t> labels) {
    if (labels.size() > kMaxMeasuredLabels) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(labels.size()) + " labels are asked for, one call measures at most " +
                         std::to_string(kMaxMeasuredLabels) + "; ask for fewer"};
    }
    return {};
}

Error noLabelsToMeasure(const std::string& which) {
    return refuse(which + ": labels is null, and clearances to labels are asked for");
}

} // namespace voxtact

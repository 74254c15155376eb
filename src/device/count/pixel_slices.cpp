// SPDX-License-Identifier: MIT
#include "device/count/pixel_slices.h"
#include "core/base/infinity.h"
#include "core/geometry/projection.h"
#include "core/method/method_table.h"
#include "device/scene/scene_impl.h"
#include "exact/exact.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxtact {

namespace {

constexpr double kPieces = EXACT_MAX_CORNERS - 2; // of a triangle that is clipped, each of as many pixels
constexpr double kInfinite = kInfinity;

/// The length of a row of a matrix, without what it moves points by.
double lengthOfRow(const Mat4& m, std::size_t row) noexcept {
    return std::hypot(m[row], m[4 + row], m[8 + row]);
}

/// The least w of the points of a box.
double leastW(const Mat4& m, const Box& box) noexcept {
    double sum = m[15];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double element = m[4 * axis + 3];
        sum += std::min(element * box.lo[axis], element * box.hi[axis]);
    }
    return sum;
}

/// By how many pixels, at most, two points of what is seen of an edge are apart along x or y, for each unit of the
/// edge's length. x/w changes by no more than (|dx| + |x/w| |dw|) / w, and |x/w| is no more than 1 where it is seen.
double pixelsOfUnit(const Mat4& clip_from_object, const Box& box, VkExtent2D viewport) noexcept {
    const double w = leastW(clip_from_object, box);
    if (!(w > 0)) {
        return kInfinite;
    }
    const double ofW = lengthOfRow(clip_from_object, 3);
    const double x = (lengthOfRow(clip_from_object, 0) + ofW) * viewport.width;
    const double y = (lengthOfRow(clip_from_object, 1) + ofW) * viewport.height;
    return std::max(x, y) / (2 * w);
}

/// The same for the grid of the projection `dominant-axis`.
double dominantPixelsOfUnit(const Grid& grid, const Mat4& texture_from_object, VkExtent2D viewport) noexcept {
    double longest = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        longest = std::max(longest, lengthOfRow(texture_from_object, row) * grid.size[row]);
    }
    return longest * static_cast<double>(dominantGrid(grid).clipScale) * viewport.width / 2;
}

} // namespace

PixelSlices::PixelSlices(const ContextImpl& context, const PassDesc& desc, const Batch& batch, const BatchItem& item,
                         VkExtent2D viewport) noexcept
    : viewport_(static_cast<double>(viewport.width) * viewport.height),
      most_(context.limits.maxComputeWorkGroupCount[2]) {
    const MeshImpl& mesh = item.mesh->impl();
    squaresBefore_ = mesh.known.squaresBeforeGroup;
    if (squaresBefore_.empty() || !mesh.known.facts || item.poses != nullptr) {
        squaresBefore_ = {};
        scale_ = kInfinite;
        // What costs every wrapped mesh something is done where it must be.
        ofUnknown_ = context.endsLongLoops ? 0 : 1;
        return;
    }
    const Mat4& texture_from_world = item.volume->impl().texture_from_world;
    const Cameras cameras(desc.projection, batch.view);
    double scale = 0;
    for (const Mat4& world_from_object : item.world_from_object) {
        if (rowOf(desc.projection).voxelGrid) {
            scale = std::max(scale, dominantPixelsOfUnit(item.volume->impl().grid,
                                                         multiply(texture_from_world, world_from_object), viewport));
            continue;
        }
        for (const Mat4& clip_from_world : cameras.clip_from_world()) {
            scale = std::max(
                scale, pixelsOfUnit(multiply(clip_from_world, world_from_object), mesh.known.facts->bounds, viewport));
        }
    }
    scale_ = scale * scale;
}

std::uint32_t PixelSlices::of(std::uint32_t group) const noexcept {
    constexpr double kLanes = VOXTACT_COMPUTE_GROUP;
    if (ofUnknown_ == 1 && squaresBefore_.empty()) {
        return 1;
    }
    // A triangle whose longest side is e pixels has less than (e + 2)^2 in its box, and that is at most 2 e^2 + 8.
    double pixels = kLanes * viewport_;
    if (!squaresBefore_.empty()) {
        const double known = 2 * scale_ * (squaresBefore_[group + 1] - squaresBefore_[group]) + 8 * kLanes;
        pixels = known < pixels ? known : pixels; // it may not be a number
    }
    const double slices = std::ceil(kPieces * pixels / (kLanes * kMostPixelRounds));
    // Of a few sizes, so that work groups beside each other have the same.
    const auto rounded = std::bit_ceil(static_cast<std::uint32_t>(std::clamp(slices, 1.0, 65536.0)));
    return std::min(rounded, most_);
}

std::uint32_t PixelSlices::endOf(std::uint32_t first, std::uint32_t end) const noexcept {
    const std::uint32_t slices = of(first);
    std::uint32_t next = first + 1;
    while (next < end && of(next) == slices) {
        ++next;
    }
    return next;
}

} // namespace voxtact

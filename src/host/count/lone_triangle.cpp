// SPDX-License-Identifier: MIT
#include "host/count/lone_triangle.h"
#include "exact/dominant.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using namespace shader;

/// Covers the rounding of exactFragment() many times over, in units of the largest term.
constexpr float kTriangleMargin = 0x1p-18F;
constexpr float kMostRatio = 4096;
constexpr float kLargestCoordinate = 1e6F;

struct Range {
    float lo;
    float hi;
};

Range rangeOf(float a, float b, float c) {
    return {std::min({a, b, c}), std::max({a, b, c})};
}

/// The ratio of the largest 1/w of the corners to the smallest.
float ratioOf(const ExactTriangle& triangle) {
    if (triangle.affine) {
        return 1;
    }
    const Range q = rangeOf(triangle.q0, triangle.q0 + triangle.q1q0, triangle.q0 + triangle.q2q0);
    return q.lo > 0 ? q.hi / q.lo : kMostRatio;
}

/// The coordinates of the corners along one axis, and of everything between them.
Range coordinates(const ExactTriangle& triangle, float base, float u, float v, float ratio) {
    const float q1 = triangle.q0 + triangle.q1q0;
    const float q2 = triangle.q0 + triangle.q2q0;
    const Range range = triangle.affine ? rangeOf(base, base + u, base + v)
                                        : rangeOf(base / triangle.q0, (base + u) / q1, (base + v) / q2);
    // Minimum and maximum of three ignore a NaN.
    if (!std::isfinite(base + u + v) || !std::isfinite(range.lo) || !std::isfinite(range.hi)) {
        return {-kLargestCoordinate, kLargestCoordinate};
    }
    const float margin = std::max(std::abs(range.lo), std::abs(range.hi)) * ratio * kTriangleMargin;
    return {range.lo - margin, range.hi + margin};
}

std::int32_t brickOf(float coordinate, float slack, std::int32_t size) {
    const float shifted = std::clamp(coordinate, 0.0F, 1.0F) * static_cast<float>(size) - 0.5F + slack;
    return std::clamp(static_cast<std::int32_t>(std::floor(shifted)) + 1, 0, size) >> kBrickShift;
}

/// Returns the class of a box of texture coordinates.
BrickClass boxClass(const PairJob& job, const Range (&ranges)[3]) {
    BrickBox box;
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(ranges[axis].lo > -kLargestCoordinate && ranges[axis].hi < kLargestCoordinate)) {
            return kMixedBrick;
        }
        if (job.view.rangeTest && (ranges[axis].hi < 0 || ranges[axis].lo > 1)) {
            return kClearBrick;
        }
        inside = inside && ranges[axis].lo >= 0 && ranges[axis].hi <= 1;
        const std::int32_t size = job.volume.image.size[axis];
        const float slack = 0x1p-14F + static_cast<float>(size) * 0x1p-22F;
        box.lo[axis] = brickOf(ranges[axis].lo, -slack, size);
        box.hi[axis] = brickOf(ranges[axis].hi, slack, size);
    }
    const BrickClass found = job.occupancy.within(box);
    return found == kOpaqueBrick && job.view.rangeTest && !inside ? kMixedBrick : found;
}

/// The range of a form over a cluster's box, and its error.
Range overCluster(const Form& form, const MeshImpl& mesh, std::size_t cluster) {
    const float centre = form.x * mesh.centreX[cluster] + form.y * mesh.centreY[cluster] +
                         form.z * mesh.centreZ[cluster] + form.constant;
    const float half = std::abs(form.x) * mesh.halfX[cluster] + std::abs(form.y) * mesh.halfY[cluster] +
                       std::abs(form.z) * mesh.halfZ[cluster] + form.margin;
    return {centre - half, centre + half};
}

} // namespace

std::size_t setUpLone(const PairJob& job, const LoneTriangle& lone, ExactTriangle (&out)[EXACT_MAX_CORNERS]) {
    const MeshImpl& mesh = job.mesh;
    const std::uint32_t firstVertex = mesh.clusters[lone.cluster].firstVertex;
    const std::uint32_t vertices[3] = {firstVertex + mesh.corner0[lone.triangle],
                                       firstVertex + mesh.corner1[lone.triangle],
                                       firstVertex + mesh.corner2[lone.triangle]};
    ExactCorner corners[EXACT_MAX_CORNERS];
    for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = exactVertex(job.transform, mesh.x[vertices[i]], mesh.y[vertices[i]], mesh.z[vertices[i]]);
    }
    if (job.view.rangeTest && exactBeyond(corners[0], corners[1], corners[2])) {
        return 0;
    }
    if (job.dominantAxis != nullptr && !dominantProject(corners[0], corners[1], corners[2], *job.dominantAxis)) {
        return 0;
    }
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
        inside = inside && exactInside(corners[i], job.view.guardX, job.view.guardY);
    }
    const int count = inside ? 3 : exactClip(3, corners, job.view.guardX, job.view.guardY);
    std::size_t made = 0;
    for (int i = 1; i + 1 < count; ++i) {
        made +=
            exactSetUp(corners[0], corners[i], corners[i + 1], job.view.width, job.view.height, out[made]) ? 1U : 0U;
    }
    return made;
}

BrickClass triangleClass(const PairJob& job, const ExactTriangle& triangle) noexcept {
    const float ratio = ratioOf(triangle);
    if (!(ratio < kMostRatio)) {
        return kMixedBrick;
    }
    const Range ranges[3] = {coordinates(triangle, triangle.tx, triangle.ux, triangle.vx, ratio),
                             coordinates(triangle, triangle.ty, triangle.uy, triangle.vy, ratio),
                             coordinates(triangle, triangle.tz, triangle.uz, triangle.vz, ratio)};
    return boxClass(job, ranges);
}

bool isClear(const PairJob& job, std::size_t cluster) noexcept {
    if (!job.cull.usable) {
        return false;
    }
    for (const Form& form : job.cull.outside) {
        if (overCluster(form, job.mesh, cluster).hi < 0) {
            return true;
        }
    }
    // Perspective would make coordinates off by more than the margin.
    if (!job.orthographic) {
        return false;
    }
    const Range ranges[3] = {overCluster(job.cull.texture[0], job.mesh, cluster),
                             overCluster(job.cull.texture[1], job.mesh, cluster),
                             overCluster(job.cull.texture[2], job.mesh, cluster)};
    return boxClass(job, ranges) == kClearBrick;
}

} // namespace voxtact::cpu

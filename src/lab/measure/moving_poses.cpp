// SPDX-License-Identifier: MIT
#include "lab/measure/moving_poses.h"

#include "core/base/try.h"
#include "lab/measure/random_poses.h"
#include "voxtact/motion.h"

#include <algorithm>
#include <cmath>

namespace voxtact::lab {

namespace {

/// Voxels from the pose around the onset.
constexpr double kOutside = 10;
constexpr double kInside = 2;
/// Of a stroke: in, out, and then on to the next one's begin.
constexpr std::uint32_t kTicksIn = 125;

Mat4 movedBy(const Mat4& pose, const Vec3& direction, double length) {
    Mat4 out = pose;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[12 + axis] += direction[axis] * length;
    }
    return out;
}

/// Unit vector from one point to another; up where they are the same.
Vec3 directionTo(const Vec3& from, const Vec3& to) {
    Vec3 way{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double length = std::hypot(way[0], way[1], way[2]);
    if (length == 0) {
        return {0, 0, 1};
    }
    for (double& coordinate : way) {
        coordinate /= length;
    }
    return way;
}

Vec3 middleOf(const Box& box) {
    Vec3 middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        middle[axis] = (box.lo[axis] + box.hi[axis]) / 2;
    }
    return middle;
}

/// Where a stroke begins, and how deep it goes.
struct Stroke {
    Mat4 outside;
    Mat4 inside;
};

Result<Mat4> poseAt(const Stroke& stroke, const Stroke& next, std::uint32_t tick, const Vec3& centre) {
    const auto part = [](std::uint32_t ticks, std::uint32_t of) { return static_cast<double>(ticks) / of; };
    if (tick < kTicksIn) {
        return poseBetween(stroke.outside, stroke.inside, part(tick, kTicksIn), Interpolation::Slerp, centre);
    }
    if (tick < 2 * kTicksIn) {
        return poseBetween(stroke.inside, stroke.outside, part(tick - kTicksIn, kTicksIn), Interpolation::Slerp,
                           centre);
    }
    return poseBetween(stroke.outside, next.outside, part(tick - 2 * kTicksIn, kTicksPerStroke - 2 * kTicksIn),
                       Interpolation::Slerp, centre);
}

} // namespace

Result<std::vector<Mat4>> movingPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count, std::uint64_t seed,
                                      const std::function<Result<bool>(const Mat4&)>& touches) {
    const Result<MeshFacts> facts = checkMesh(mesh);
    VOXTACT_TRY(facts);
    const std::uint32_t strokes = (count + kTicksPerStroke - 1) / kTicksPerStroke;
    const Result<std::vector<Mat4>> onset = onsetPoses(grid, mesh, strokes, seed, touches);
    VOXTACT_TRY(onset);
    const Vec3 centre = middleOf(facts->bounds);
    const Vec3 middle = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    const double voxel = *std::ranges::min_element(grid.spacing);
    std::vector<Stroke> all;
    for (const Mat4& pose : *onset) {
        const Vec3 outward = directionTo(middle, transformPoint(pose, centre));
        all.push_back({movedBy(pose, outward, kOutside * voxel), movedBy(pose, outward, -kInside * voxel)});
    }
    std::vector<Mat4> poses;
    poses.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t stroke = i / kTicksPerStroke;
        const Result<Mat4> pose = poseAt(all[stroke], all[(stroke + 1) % all.size()], i % kTicksPerStroke, centre);
        VOXTACT_TRY(pose);
        poses.push_back(*pose);
    }
    return poses;
}

} // namespace voxtact::lab

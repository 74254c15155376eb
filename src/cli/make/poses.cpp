// SPDX-License-Identifier: MIT
#include "cli/make/poses.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "voxtact/motion.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace voxtact {

namespace {

constexpr double kMargin = 0.1; ///< of the box's side
/// Starts for each pose around the onset.
constexpr std::uint64_t kTries = 100;
/// Precision of the onset, in voxels.
constexpr double kOnsetError = 1.0 / 64;
/// Start of a stroke: voxels outside the onset.
constexpr double kOutside = 10;
constexpr double kInside = 2;
/// Ticks inwards and outwards; the rest moves to the next stroke.
constexpr std::uint32_t kTicksIn = 125;

/// The standard specifies the generator exactly, but not std::uniform_real_distribution.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Returns a number in [0, 1) with 53 random bits.
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
    std::size_t below(std::size_t end) { return static_cast<std::size_t>(unit() * static_cast<double>(end)); }

  private:
    std::mt19937_64 engine_;
};

/// Returns a random point of the unit disc, other than the origin.
glm::dvec2 inUnitDisc(Random& random) {
    glm::dvec2 point;
    do {
        point.x = random.between(-1, 1);
        point.y = random.between(-1, 1);
    } while (glm::dot(point, point) >= 1 || glm::dot(point, point) == 0);
    return point;
}

/// Returns a uniformly random rotation (Marsaglia 1972). Uses only square roots: sine and cosine differ between
/// libraries.
Mat4 randomRotation(Random& random) {
    const glm::dvec2 a = inUnitDisc(random);
    const glm::dvec2 b = inUnitDisc(random);
    const double scale = std::sqrt((1 - glm::dot(a, a)) / glm::dot(b, b));
    const glm::dmat4 matrix = glm::mat4_cast(glm::dquat(b.y * scale, a.x, a.y, b.x * scale));
    Mat4 rotation{};
    std::copy_n(glm::value_ptr(matrix), rotation.size(), rotation.begin());
    return rotation;
}

/// Returns a random rotation that puts a random vertex at a random point of the box, enlarged by `margin`.
Mat4 randomPose(const Mat4& world_from_texture, const MeshView& mesh, double margin, Random& random) {
    Mat4 world_from_object = randomRotation(random);
    const std::size_t vertex = random.below(mesh.positions.size() / 3) * 3;
    const Vec3 turned = transformPoint(
        world_from_object, {mesh.positions[vertex], mesh.positions[vertex + 1], mesh.positions[vertex + 2]});
    Vec3 texture{};
    for (double& coordinate : texture) {
        coordinate = random.between(-margin, 1 + margin);
    }
    const Vec3 target = transformPoint(world_from_texture, texture);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        world_from_object[12 + axis] = target[axis] - turned[axis];
    }
    return world_from_object;
}

Mat4 movedBy(const Mat4& pose, const Vec3& direction, double length) {
    Mat4 out = pose;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[12 + axis] += direction[axis] * length;
    }
    return out;
}

/// Returns the maximum distance that separates a touching mesh from a volume.
double farthest(const Grid& grid, const MeshView& mesh) {
    Vec3 lo{mesh.positions[0], mesh.positions[1], mesh.positions[2]};
    Vec3 hi = lo;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        lo[i % 3] = std::min(lo[i % 3], mesh.positions[i]);
        hi[i % 3] = std::max(hi[i % 3], mesh.positions[i]);
    }
    double sides = 0; // an upper bound of all diagonals, also of sheared volumes
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sides += grid.size[axis] * grid.spacing[axis];
    }
    return std::hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]) + sides;
}

/// Returns the unit vector from one point to another; up if they are equal.
Vec3 directionTo(const Vec3& from, const Vec3& to) {
    Vec3 direction{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    if (length == 0) {
        return {0, 0, 1};
    }
    for (double& coordinate : direction) {
        coordinate /= length;
    }
    return direction;
}

} // namespace

std::vector<Mat4> randomPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count, std::uint64_t seed) {
    std::vector<Mat4> poses;
    poses.reserve(count);
    forRandomPoses(grid, mesh, count, seed, [&](const Mat4& pose) {
        poses.push_back(pose);
        return true;
    });
    return poses;
}

void forRandomPoses(const Grid& grid, const MeshView& mesh, std::uint64_t count, std::uint64_t seed,
                    const std::function<bool(const Mat4&)>& take) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    Random random(seed);
    for (std::uint64_t i = 0; i < count && take(randomPose(world_from_texture, mesh, kMargin, random)); ++i) {
    }
}

std::vector<Mat4> asFloats(std::vector<Mat4> poses) {
    for (Mat4& pose : poses) {
        std::ranges::transform(pose, pose.begin(),
                               [](double element) { return static_cast<double>(static_cast<float>(element)); });
    }
    return poses;
}

Result<std::vector<Mat4>> onsetPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count, std::uint64_t seed,
                                     const std::function<Result<bool>(const Mat4&)>& touches) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    const double voxel = *std::ranges::min_element(grid.spacing);
    const double maxDistance = farthest(grid, mesh);
    Random random(seed);
    std::vector<Mat4> poses;
    for (std::uint64_t tries = 0; poses.size() < count; ++tries) {
        if (tries == kTries * count) {
            return refuse("no poses around the onset of contact: of " + std::to_string(tries) + " random poses only " +
                          std::to_string(poses.size()) + " touch");
        }
        const Mat4 start = randomPose(world_from_texture, mesh, 0, random);
        const Vec3 direction = transformPoint(randomRotation(random), {0, 0, 1});
        double inside = 0;
        double outside = maxDistance;
        const Result<bool> begins = touches(start);
        VOXTACT_TRY(begins);
        while (*begins && outside - inside > voxel * kOnsetError) {
            const double middle = (inside + outside) / 2;
            const Result<bool> hit = touches(movedBy(start, direction, middle));
            VOXTACT_TRY(hit);
            (*hit ? inside : outside) = middle;
        }
        if (*begins) {
            const double length = inside + voxel * random.between(-kOnsetInside, kOnsetOutside);
            poses.push_back(movedBy(start, direction, length));
        }
    }
    return poses;
}

Result<std::vector<Mat4>> movingPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count, std::uint64_t seed,
                                      const std::function<Result<bool>(const Mat4&)>& touches) {
    const Result<MeshFacts> facts = checkMesh(mesh);
    VOXTACT_TRY(facts);
    const std::uint32_t strokes = (count + kTicksPerStroke - 1) / kTicksPerStroke;
    const Result<std::vector<Mat4>> onset = onsetPoses(grid, mesh, strokes, seed, touches);
    VOXTACT_TRY(onset);
    const auto& [lo, hi] = facts->bounds;
    const Vec3 centre{(lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, (lo[2] + hi[2]) / 2};
    const Vec3 middle = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    const double voxel = *std::ranges::min_element(grid.spacing);
    std::vector<Mat4> outside;
    std::vector<Mat4> inside;
    for (const Mat4& pose : *onset) {
        const Vec3 outward = directionTo(middle, transformPoint(pose, centre));
        outside.push_back(movedBy(pose, outward, kOutside * voxel));
        inside.push_back(movedBy(pose, outward, -kInside * voxel));
    }
    std::vector<Mat4> poses;
    poses.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t stroke = i / kTicksPerStroke;
        const std::uint32_t tick = i % kTicksPerStroke;
        const Mat4 stops[] = {outside[stroke], inside[stroke], outside[stroke], outside[(stroke + 1) % strokes]};
        const std::size_t leg = std::min(tick / kTicksIn, 2U);
        const std::uint32_t ticks = leg < 2 ? kTicksIn : kTicksPerStroke - 2 * kTicksIn;
        const double part = (tick - static_cast<double>(leg) * kTicksIn) / ticks;
        const Result<Mat4> pose = poseBetween(stops[leg], stops[leg + 1], part, Interpolation::Slerp, centre);
        VOXTACT_TRY(pose);
        poses.push_back(*pose);
    }
    return poses;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "app/random_poses.h"

#include <cmath>
#include <random>

namespace voxtact::app {

namespace {

constexpr double kMargin = 0.1; ///< of the box's side

/// The generator is fixed by the standard; std::uniform_real_distribution is not.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// [0, 1), 53 bits.
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
    std::size_t below(std::size_t end) { return static_cast<std::size_t>(unit() * static_cast<double>(end)); }

  private:
    std::mt19937_64 engine_;
};

struct DiscPoint {
    double x = 0;
    double y = 0;
    double squared = 0;
};

DiscPoint inUnitDisc(Random& random) {
    DiscPoint point;
    do {
        point.x = random.between(-1, 1);
        point.y = random.between(-1, 1);
        point.squared = point.x * point.x + point.y * point.y;
    } while (point.squared >= 1 || point.squared == 0);
    return point;
}

/// Uniform over all rotations (Marsaglia 1972). Square roots only: sine and cosine differ from library to library.
Mat4 randomRotation(Random& random) {
    const DiscPoint a = inUnitDisc(random);
    const DiscPoint b = inUnitDisc(random);
    const double scale = std::sqrt((1 - a.squared) / b.squared);
    const double x = a.x;
    const double y = a.y;
    const double z = b.x * scale;
    const double w = b.y * scale;
    Mat4 rotation = identity();
    rotation[0] = 1 - 2 * (y * y + z * z);
    rotation[1] = 2 * (x * y + w * z);
    rotation[2] = 2 * (x * z - w * y);
    rotation[4] = 2 * (x * y - w * z);
    rotation[5] = 1 - 2 * (x * x + z * z);
    rotation[6] = 2 * (y * z + w * x);
    rotation[8] = 2 * (x * z + w * y);
    rotation[9] = 2 * (y * z - w * x);
    rotation[10] = 1 - 2 * (x * x + y * y);
    return rotation;
}

} // namespace

std::vector<Mat4> randomPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count, std::uint64_t seed) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    Random random(seed);
    std::vector<Mat4> poses;
    poses.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        Mat4 world_from_object = randomRotation(random);
        const std::size_t vertex = random.below(mesh.positions.size() / 3) * 3;
        const Vec3 turned = transformPoint(
            world_from_object, {mesh.positions[vertex], mesh.positions[vertex + 1], mesh.positions[vertex + 2]});
        Vec3 texture{};
        for (double& coordinate : texture) {
            coordinate = random.between(-kMargin, 1 + kMargin);
        }
        const Vec3 target = transformPoint(world_from_texture, texture);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            world_from_object[12 + axis] = target[axis] - turned[axis];
        }
        poses.push_back(world_from_object);
    }
    return poses;
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstring>
#include <functional>
#include <random>
#include <span>
#include <vector>

namespace voxtact::test {

/// A grid over the unit cube of world space: texture space and world space are the same.
Grid unitGrid(std::uint32_t x, std::uint32_t y, std::uint32_t z);
inline Grid unitGrid(std::uint32_t n) {
    return unitGrid(n, n, n);
}

/// A volume whose voxel (x, y, z) is `value(x, y, z)`.
template <class Scalar>
VolumeData makeVolume(const Grid& grid, ScalarType type,
                      const std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)>& value) {
    VolumeData out;
    out.grid = grid;
    out.type = type;
    out.voxels.resize(voxelCount(grid) * sizeof(Scalar));
    std::size_t at = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x, at += sizeof(Scalar)) {
                const auto voxel = static_cast<Scalar>(value(x, y, z));
                std::memcpy(out.voxels.data() + at, &voxel, sizeof voxel);
            }
        }
    }
    return out;
}
VolumeData makeBytes(const Grid& grid, const std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)>& value);

/// Rounded, as buffers of the caller's have them.
inline std::vector<float> floatsOf(std::span<const double> values) {
    std::vector<float> out;
    for (const double value : values) {
        out.push_back(static_cast<float>(value));
    }
    return out;
}

/// The MR head of Debian's mricron-data, or what VOXTACT_TEST_HEAD names in its place.
const char* headPath();

/// Two triangles: the corners in order round the rectangle.
MeshData makeRectangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// The rectangle [x0,x1] x [y0,y1] at z.
MeshData makeFlat(double x0, double x1, double y0, double y1, double z);
/// Twelve triangles.
MeshData makeCube(double lo, double hi);

/// World x and y in [lo,hi] fill the viewport, z in [-10,10] is between near and far.
View flatView(double lo, double hi, std::uint32_t width, std::uint32_t height);

/// A rotation from a uniformly random quaternion.
Mat4 randomRotation(std::mt19937_64& random);
/// A rotation and a translation of up to 100 mm along each axis.
Mat4 randomMotion(std::mt19937_64& random);
/// The volume after a rigid motion of the world.
VolumeData moved(VolumeData volume, const Mat4& motion);
double uniform(std::mt19937_64& random, double lo, double hi);
/// Like uniform(), as a float.
inline float drawn(std::mt19937_64& random, double lo, double hi) {
    return static_cast<float>(uniform(random, lo, hi));
}
/// Random poses whose object origin is within `grow` times the box of the volume.
std::vector<Mat4> randomPoses(const Grid& grid, std::size_t count, double grow, std::mt19937_64& random);
/// A pose whose elements are floats, as one on a device.
Mat4 floatPose(const Mat4& pose);
/// True if tests run in the long form: VOXTACT_TEST_LONG is set; ./run test --long.
bool longTests();
/// Number of random cases of a test: `whole` in the long form, otherwise a `part`-th of it.
std::size_t randomCases(std::size_t whole, std::size_t part);
/// The seed of this run: printed, and taken from VOXTACT_TEST_SEED where that is set.
std::uint64_t testSeed();

/// A ramp 0..1 over [0,255].
std::span<const ControlPoint> byteRamp();

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace voxtact::test {

/// A pair that owns its data.
struct OracleScene {
    MeshData mesh;
    VolumeData volume;
    std::vector<ControlPoint> points{{0, 0}, {255, 1}};
    ValueRange domain{0, 255};
    std::uint32_t tableSize = kDefaultTableSize;
    View view;
    Mat4 world_from_object = identity();
    double threshold = 0.5;

    [[nodiscard]] oracle::OraclePair pair() const {
        return {mesh.view(), volume.view(), {points, domain, tableSize}, view, world_from_object, threshold};
    }
};

using VoxelFunction = std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)>;
/// A uint8 image of n^3 voxels over the unit cube of world space: texture space and world space are the same.
VolumeData makeUnitImage(std::uint32_t n, const VoxelFunction& value);

void addTriangle(MeshData& mesh, const Vec3& a, const Vec3& b, const Vec3& c);
/// Two triangles: the corners in order round the rectangle.
void addRectangle(MeshData& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Orthographic along +z: shows the square from (lo, lo) to (hi, hi) and depths from lo to hi.
View squareView(double lo, double hi, std::uint32_t width, std::uint32_t height);
/// From the camera's origin, looking along its +z, y down, 90 degrees wide and high.
View perspectiveView(const Mat4& world_from_camera, double nearPlane, double farPlane, std::uint32_t size);

/// A random turn and the offset.
Mat4 randomPose(std::mt19937& random, const Vec3& offset);
double uniform(std::mt19937& random, double lo, double hi);
/// VOXTACT_TEST_SEED, or `usual`. Prints which.
std::uint32_t testSeed(std::uint32_t usual);

/// A built-in image and mesh, the mesh somewhere in the image at random.
OracleScene randomScene(std::mt19937& random, const std::string& volume);

} // namespace voxtact::test

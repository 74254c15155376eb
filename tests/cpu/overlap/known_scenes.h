// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/oracle_scenes.h"

#include <random>
#include <string>
#include <vector>

/// Scenes whose overlap is known beforehand, to hold both the engine and its judge against.
namespace voxtact::test {

struct KnownScene {
    std::string name;
    OracleScene scene;
    double wanted = 0; ///< mm^3
    double slack = 0;  ///< mm^3, how far off that may be
};

/// Opaque from a value on.
[[nodiscard]] std::vector<ControlPoint> opaqueFrom(double value);
/// Anisotropic, turned, sheared and left-handed grids, of some ten voxels a side.
[[nodiscard]] Grid randomSmallGrid(std::mt19937_64& random);
/// Every voxel is `gradient` times its number, plus `offset`: whole numbers.
[[nodiscard]] VolumeData linearImage(const Grid& grid, const std::array<int, 3>& gradient, int offset);
/// Of the largest ball around the middle of the image in which linear images are linear, mm.
[[nodiscard]] double linearRadius(const Grid& grid);
[[nodiscard]] Vec3 middleOf(const Grid& grid);
/// Of 16-bit voxels, at a place in index space.
[[nodiscard]] double valueAt(const VolumeData& volume, const Vec3& index);

/// Solids without self-intersections, somewhere in a linear image: a half space is opaque.
[[nodiscard]] KnownScene halfSpaceScene(std::mt19937_64& random);
/// A box along the grid's axes, partly outside of an image that is opaque all over, or from a voxel's centre on up to
/// the face of the image, and exactly at the limit in its outermost half voxel.
[[nodiscard]] KnownScene boxScene(std::mt19937_64& random);
/// A box in an image of products of whole numbers, which interpolation keeps: hyperbolas bound the opaque region.
[[nodiscard]] KnownScene saddleScene(std::mt19937_64& random);
/// Two balls: the mesh, and the one that is opaque.
[[nodiscard]] KnownScene lensScene(std::mt19937_64& random);

} // namespace voxtact::test

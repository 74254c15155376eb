// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

/// Closed meshes, and volumes that are known beforehand.
namespace voxtact::test {

/// Twelve triangles that face outwards.
[[nodiscard]] MeshData solidBox(const Vec3& lo, const Vec3& hi);
/// A regular polygon of `sides` corners, from -height/2 to height/2 along z; not convex where `star` pulls every other
/// corner in.
[[nodiscard]] MeshData solidPrism(std::uint32_t sides, double radius, double height, bool star = false);
/// An octahedron whose edges are cut in 2^level parts, with its corners on a sphere around the origin.
[[nodiscard]] MeshData solidBall(double radius, std::uint32_t level);

/// Facing the other way.
[[nodiscard]] MeshData reversed(MeshData mesh);
/// Both surfaces in one mesh.
[[nodiscard]] MeshData joined(MeshData mesh, const MeshData& other);
/// Each triangle with vertices of its own.
[[nodiscard]] MeshData unshared(const MeshData& mesh);
/// Its vertices moved by a function of them.
[[nodiscard]] MeshData mapped(MeshData mesh, const std::function<Vec3(const Vec3&)>& map);
[[nodiscard]] MeshData transformed(const MeshData& mesh, const Mat4& matrix);
/// Boxes, prisms, balls with and without noise, shells, and unions of them, of about that size around the origin. Not
/// all are free of self-intersections, and parts may face inwards.
[[nodiscard]] MeshData randomSolid(std::mt19937_64& random, double size);

/// Of a surface after an affine map, at a point off it: the sum of the solid angles of its triangles.
[[nodiscard]] int windingNumber(const MeshData& mesh, const Mat4& pose, const Vec3& point);
/// Of a surface after an affine map: positive where it faces outwards.
[[nodiscard]] double signedVolume(const MeshData& mesh, const Mat4& pose = identity());
/// Of the part of a surface's signed volume where a linear function, `gradient` times the place plus `offset`, is at
/// least 0. Exact up to roundings: a sum of tetrahedra, each cut by the plane.
[[nodiscard]] double signedVolumeAbove(const MeshData& mesh, const Mat4& pose, const Vec3& gradient, double offset);

/// Of what two balls share.
[[nodiscard]] double lensVolume(double radius, double other, double distance);

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voxtact {

/// A point of a ring. `turn` in [0,1) says how far round it is: rings are joined where their turns agree.
struct RingPoint {
    Vec3 position{};
    double turn = 0;
};

/// Ascending turns, counter-clockwise seen from the end of the axis that the rings are strung on. One point is a pole.
using Ring = std::vector<RingPoint>;

/// A triangle mesh before its coordinates are rounded to float.
struct Surface {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> corners; ///< three a triangle
};

inline constexpr std::uint32_t kMaxBuiltinTriangles = 1U << 24;

/// The closed surface of genus 0 through the rings; the first and the last one must be poles. Between two rings there
/// are as many triangles as they have segments, and a pole has none.
[[nodiscard]] Surface loft(std::span<const Ring> rings);

/// Refuses the numbers of triangles that no closed surface of genus 0 has, or that are outside
/// [minimum, kMaxBuiltinTriangles]; names the nearest possible ones.
[[nodiscard]] Result<void> checkTriangleCount(const std::string& shape, std::uint32_t triangles, std::uint32_t minimum);

[[nodiscard]] MeshData toMesh(Surface surface, std::string name);

} // namespace voxtact

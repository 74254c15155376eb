// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "samples/edge_split.h"
#include "samples/loft.h"
#include "voxtact/samples.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxtact {

namespace {

constexpr Vec3 kHalfAxes{20, 30, 40};
constexpr std::uint32_t kOctahedron = 8;

Vec3 onEllipsoid(const Vec3& direction) {
    const double length =
        std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    return {kHalfAxes[0] * (direction[0] / length), kHalfAxes[1] * (direction[1] / length),
            kHalfAxes[2] * (direction[2] / length)};
}

/// The ring of an octahedron whose edges are cut in `parts`, `steps` below the upper or above the lower pole. Its
/// points are whole numbers, so the surface has all the symmetries of its planes to the last bit.
Ring octahedronRing(std::uint32_t parts, std::uint32_t steps, bool upper) {
    constexpr std::array<std::array<int, 2>, 4> kCorners{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const double height = (upper ? 1.0 : -1.0) * static_cast<double>(parts - steps);
    if (steps == 0) {
        return {{onEllipsoid({0, 0, height}), 0}};
    }
    Ring ring;
    ring.reserve(std::size_t{4} * steps);
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        const auto& start = kCorners[quarter];
        const auto& end = kCorners[(quarter + 1) % 4];
        for (std::uint32_t i = 0; i < steps; ++i) {
            const double toStart = steps - i;
            const double toEnd = i;
            const Vec3 point{start[0] * toStart + end[0] * toEnd, start[1] * toStart + end[1] * toEnd, height};
            ring.push_back({onEllipsoid(point), (quarter * static_cast<double>(steps) + i) / (4.0 * steps)});
        }
    }
    return ring;
}

Surface octahedralEllipsoid(std::uint32_t parts) {
    std::vector<Ring> rings;
    for (std::uint32_t steps = 0; steps <= parts; ++steps) {
        rings.push_back(octahedronRing(parts, steps, false));
    }
    for (std::uint32_t steps = parts; steps-- > 0;) {
        rings.push_back(octahedronRing(parts, steps, true));
    }
    return loft(rings);
}

} // namespace

Result<MeshData> makeEllipsoid(std::uint32_t triangles) {
    return guard([&]() -> Result<MeshData> {
        VOXTACT_TRY(checkTriangleCount("an ellipsoid", triangles, kOctahedron));
        std::uint32_t parts = 1;
        while (kOctahedron * (parts + 1) * (parts + 1) <= triangles) {
            ++parts;
        }
        Surface surface = octahedralEllipsoid(parts);
        splitLongestEdges(surface, triangles, [](const Vec3& middle) {
            return onEllipsoid({middle[0] / kHalfAxes[0], middle[1] / kHalfAxes[1], middle[2] / kHalfAxes[2]});
        });
        return toMesh(std::move(surface), "ellipsoid");
    });
}

} // namespace voxtact

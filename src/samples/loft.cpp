// SPDX-License-Identifier: MIT
#include "samples/loft.h"
#include "core/base/refuse.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace voxtact {

namespace {

double squaredDistance(const Vec3& a, const Vec3& b) {
    const double x = a[0] - b[0];
    const double y = a[1] - b[1];
    const double z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/// A ring with the number of its first point in the surface. The point after the last one is the first again.
struct PlacedRing {
    const Ring& ring;
    std::uint32_t first;

    std::size_t segments() const { return ring.size() > 1 ? ring.size() : 0; }
    std::uint32_t index(std::size_t i) const { return first + static_cast<std::uint32_t>(i % ring.size()); }
    const Vec3& position(std::size_t i) const { return ring[i % ring.size()].position; }
    double turn(std::size_t i) const { return i < ring.size() ? ring[i].turn : 1.0; }
};

bool advanceLower(const PlacedRing& lower, std::size_t i, const PlacedRing& upper, std::size_t j) {
    if (i == lower.segments() || j == upper.segments()) {
        return i < lower.segments();
    }
    const double lowerTurn = lower.turn(i + 1);
    const double upperTurn = upper.turn(j + 1);
    if (lowerTurn != upperTurn) {
        return lowerTurn < upperTurn;
    }
    return squaredDistance(lower.position(i + 1), upper.position(j)) <=
           squaredDistance(lower.position(i), upper.position(j + 1));
}

void join(const PlacedRing& lower, const PlacedRing& upper, std::vector<std::uint32_t>& corners) {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < lower.segments() || j < upper.segments()) {
        if (advanceLower(lower, i, upper, j)) {
            corners.insert(corners.end(), {lower.index(i), lower.index(i + 1), upper.index(j)});
            ++i;
        } else {
            corners.insert(corners.end(), {lower.index(i), upper.index(j + 1), upper.index(j)});
            ++j;
        }
    }
}

} // namespace

Surface loft(std::span<const Ring> rings) {
    Surface surface;
    for (std::size_t r = 0; r < rings.size(); ++r) {
        const auto first = static_cast<std::uint32_t>(surface.points.size());
        for (const RingPoint& point : rings[r]) {
            surface.points.push_back(point.position);
        }
        if (r > 0) {
            const auto below = first - static_cast<std::uint32_t>(rings[r - 1].size());
            join({rings[r - 1], below}, {rings[r], first}, surface.corners);
        }
    }
    return surface;
}

Result<void> checkTriangleCount(const std::string& shape, std::uint32_t triangles, std::uint32_t minimum) {
    std::string why;
    if (triangles < minimum) {
        why = "the shape needs at least " + std::to_string(minimum);
    } else if (triangles > kMaxBuiltinTriangles) {
        why = "the most is " + std::to_string(kMaxBuiltinTriangles);
    } else if (triangles % 2 != 0) {
        why = "a closed surface of genus 0 has an even number, and the nearest are " + std::to_string(triangles - 1) +
              " and " + std::to_string(triangles + 1);
    } else {
        return {};
    }
    return refuse(shape + " with " + std::to_string(triangles) + (triangles == 1 ? " triangle" : " triangles") +
                  " is not possible: " + why);
}

MeshData toMesh(Surface surface, std::string name) {
    MeshData mesh;
    mesh.positions.reserve(surface.points.size() * 3);
    for (const Vec3& point : surface.points) {
        for (const double coordinate : point) {
            mesh.positions.push_back(static_cast<double>(static_cast<float>(coordinate)));
        }
    }
    mesh.indices = std::move(surface.corners);
    mesh.name = std::move(name);
    return mesh;
}

} // namespace voxtact

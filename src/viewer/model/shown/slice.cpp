// SPDX-License-Identifier: MIT
#include "viewer/model/shown/slice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::view {

SlicePlace slicePlace(const SliceKind& kind, const Grid& grid, const Vec3& cursor, const Extent& extent) {
    SlicePlace place;
    const auto sides = [](std::uint32_t side) { return std::max<std::uint32_t>(side, 1); };
    place.clip_from_world = viewFrom(kind.direction, grid, std::nullopt, sides(extent.width), sides(extent.height));
    // The framing of a good grid is not singular.
    place.world_from_clip = inverse(place.clip_from_world).value();
    // Every point has the cursor's coordinate along the slice's axis.
    for (std::size_t column = 0; column < 3; ++column) {
        place.world_from_clip[4 * column + kind.axis] = 0;
    }
    place.world_from_clip[12 + kind.axis] = cursor[kind.axis];
    return place;
}

Vec3 worldAt(const SlicePlace& place, const Point2& at) {
    return transformPoint(place.world_from_clip, {2 * at[0] - 1, 2 * at[1] - 1, 0});
}

Point2 pictureAt(const SlicePlace& place, const Vec3& world) {
    const Vec3 clip = transformPoint(place.clip_from_world, world);
    return {(clip[0] + 1) / 2, (clip[1] + 1) / 2};
}

std::vector<OutlinePiece> outline(const MeshView& mesh, const Mat4& world_from_object, std::size_t axis, double at,
                                  const SlicePlace& place) {
    std::vector<Vec3> points;
    points.reserve(mesh.positions.size() / 3);
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        points.push_back(
            transformPoint(world_from_object, {mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]}));
    }
    std::vector<OutlinePiece> pieces;
    for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
        std::array<Point2, 2> ends{};
        std::size_t found = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& a = points[mesh.indices[first + i]];
            const Vec3& b = points[mesh.indices[first + (i + 1) % 3]];
            if ((a[axis] < at) == (b[axis] < at) || found == ends.size()) {
                continue;
            }
            const double share = (at - a[axis]) / (b[axis] - a[axis]);
            ends[found++] = pictureAt(
                place, {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])});
        }
        if (found == ends.size()) {
            pieces.push_back({ends[0], ends[1], static_cast<std::uint32_t>(first / 3)});
        }
    }
    return pieces;
}

int decimalsOn(const Grid& grid, int decimals) {
    constexpr int kMostMore = 6;
    const double voxel = *std::ranges::min_element(grid.spacing);
    // Tenths of a voxel are distinguishable.
    return decimals + std::clamp(-1 - static_cast<int>(std::floor(std::log10(voxel))), 0, kMostMore);
}

std::string mmText(const Grid& grid, int decimals, double mm) {
    const int number = decimalsOn(grid, decimals);
    const double parts = std::pow(10, number);
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", number, std::abs(mm * parts) < 0.5 ? 0.0 : mm);
    return text;
}

} // namespace voxtact::view

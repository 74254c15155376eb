// SPDX-License-Identifier: MIT
#include "detect/certified/certified_rounds.h"
#include "core/method/certified_constants.h"
#include "detect/batch.h"
#include "detect/certified/certified_queues.h"
#include "gpu/scene_impl.h"

#include <array>
#include <cmath>

namespace voxtact {

namespace {

/// Looks at a triangle with a side of e voxels, over e^2. A triangle is large from 27 cells on, so that e is at least
/// 1.9. It meets less than 4 (e/8 + 2)^2 bricks, of 512 cells each, and the cells of its box are less than (e + 3)^3:
/// the lesser of the two is never more than 58 e^2. Its box has less than (e/8 + 2)^3 bricks, for another 4.
constexpr double kLooksOfSquare = 64;

/// The same with a margin that reaches G voxels along an axis, B = 2 G + 3. A triangle with a side of e voxels looks at
/// the cells of its box, of a side of e + B, at most. While e is no more than B, that is less than
/// B^3 + 3 B^2 e + 4 B e^2, and 3 B^2 e is no more than B^3 / 8 + 18 B e^2. A longer one, 3 voxels at least, has
/// columns of bricks over (e + B + 13)^2 < 41 e^2 voxels of the plane across the axis that it is steepest along, each
/// of 4 + G / 2 bricks at most near the plane of the triangle: 328 (4 + G / 2) e^2 cells. Their bricks are fewer by
/// far, but for the small triangles, which have 27 and less than a 64th of the cells more. What the triangles of a run
/// look at together, before each of them does, are no more cells than their own, and 512 bricks: 32 for each of 16.
struct MarginLooks {
    double ofTriangle;
    double ofSquare;
};

MarginLooks marginLooks(const Grid& grid, double margin) {
    const std::array<double, 3> reach = voxelsOfMargin(grid, margin);
    const double most = std::max({reach[0], reach[1], reach[2]});
    const double box = 2 * most + 3;
    constexpr double kBricks = 32;
    constexpr double kWithBricks = 2 + 1.0 / 64;
    return {kWithBricks * 1.125 * box * box * box + kBricks, kWithBricks * std::max(22 * box, 328 * (4 + most / 2))};
}

/// The most that a pose makes of a length, in voxels, squared.
double squaredScale(const Grid& grid, const Mat4& texture_from_world, const Mat4& world_from_object) noexcept {
    const Mat4 texture_from_object = multiply(texture_from_world, world_from_object);
    double most = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        double sum = 0;
        for (std::size_t column = 0; column < 3; ++column) {
            const double element = texture_from_object[4 * column + row] * grid.size[row];
            sum += element * element;
        }
        most = std::max(most, sum);
    }
    return most;
}

} // namespace

std::uint32_t clustersOf(const MeshLooks& looks, std::uint32_t queueRoom, bool stopAtFirst) noexcept {
    return clustersOfRound(looks.before.empty() ? std::min(queueRoom, kMostRoomAnywhere) : queueRoom, stopAtFirst);
}

MeshLooks meshLooks(const BatchItem& item, double margin) noexcept {
    const MeshImpl& mesh = item.mesh->impl();
    MeshLooks looks;
    looks.pairs = static_cast<std::uint32_t>(item.pairs());
    looks.clusters = groupsOf(*item.mesh);
    looks.before = mesh.known.squaresBefore;
    if (looks.before.empty()) {
        return looks;
    }
    const VolumeImpl& volume = item.volume->impl();
    double scale = 0;
    if (item.poses != nullptr) {
        const double most = item.poses->impl().mostScale;
        scale = most * most * squaredScale(volume.grid, volume.texture_from_world, identity());
    }
    for (const Mat4& world_from_object : item.world_from_object) {
        scale = std::max(scale, squaredScale(volume.grid, volume.texture_from_world, world_from_object));
    }
    double diagonal = 0;
    for (const std::uint32_t size : volume.grid.size) {
        diagonal += static_cast<double>(size) * size;
    }
    looks.scale = kLooksOfSquare * scale;
    looks.most = kLooksOfSquare * VOXTACT_CLUSTER_TRIANGLES * diagonal;
    if (margin > 0) {
        const MarginLooks with = marginLooks(volume.grid, margin);
        looks.scale = with.ofSquare * scale;
        looks.each = with.ofTriangle * VOXTACT_CLUSTER_TRIANGLES;
        double cells = 3; // twice, and bricks
        for (const std::uint32_t size : volume.grid.size) {
            cells *= size + 1.0;
        }
        looks.most = cells * VOXTACT_CLUSTER_TRIANGLES;
    }
    return looks;
}

} // namespace voxtact

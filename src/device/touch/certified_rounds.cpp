// SPDX-License-Identifier: MIT
#include "device/touch/certified_rounds.h"
#include "device/detector/batch.h"
#include "device/scene/scene_impl.h"
#include "device/touch/certified_queues.h"

#include <algorithm>

namespace voxtact {

namespace {

/// Looks at a triangle with a side of e voxels, over e^2. A triangle is large from 27 cells on, so that e is at least
/// 1.9. It meets less than 4 (e/8 + 2)^2 bricks, of 512 cells each, and the cells of its box are less than (e + 3)^3:
/// the lesser of the two is never more than 58 e^2. Its box has less than (e/8 + 2)^3 bricks, for another 4.
constexpr double kLooksOfSquare = 64;

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

MeshLooks meshLooks(const BatchItem& item) noexcept {
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
        const double most = item.poses->impl().maxScale;
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
    return looks;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "host/search/search.h"
#include "core/base/infinity.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;
using glm::length;

} // namespace

Found ClosestSearch::run(MeshPlace& mesh, const VolumeImpl& volume, const OpaquePart& part,
                         const SearchedPart& searched, const SearchGoal& goal, const OpenPairs* from,
                         CancelFlag cancel) {
    mesh_ = &mesh;
    volume_ = &volume;
    part_ = &part;
    searched_ = &searched;
    goal_ = goal;
    cancel_ = cancel;
    found_ = {};
    error_ = {mesh.error()};
    boxes_.begin(volume, part, searched, error_);
    bool improved = false;
    heap_.clear();
    rows_.count = 0;
    offered_.clear();
    dropped_.clear();
    dive_.reset();
    if (goal.known) {
        const MeshPoint onMesh = nearestOnMesh(mesh, *goal.known, kInfinity);
        found_.offer(error_.above(onMesh.distance), onMesh.triangle, onMesh.point, *goal.known, true);
    }
    if (from == nullptr && !mayBeWithin(goal.maximum)) {
        found_.lo = goal.maximum;
        return found_;
    }
    begin(from);
    while (goesOn()) {
        ++found_.steps;
        open(next());
        if (!improved && found_.hi < kInfinity && !mesh.isSwept()) {
            improved = true;
            if (found_.hi > goal.enough) {
                improve();
            }
        }
    }
    if (dive_) {
        push(*dive_);
    }
    if (!heap_.empty()) {
        found_.lo = std::min(found_.lo, heap_.least());
    }
    found_.lo = std::min(found_.lo, found_.hi);
    return found_;
}

OpenPairs ClosestSearch::left() const {
    OpenPairs open = dropped_;
    heap_.addTo(open);
    return open;
}

bool ClosestSearch::goesOn() {
    constexpr std::uint64_t kMostInDoubt = 1000;
    if (isCancelled(cancel_)) {
        return false;
    }
    if (decides() && found_.lo <= 0 && (!goal_.untilMet || ++stepsInDoubt_ > kMostInDoubt)) {
        return false; // it is not separated, which answers the query
    }
    if (found_.hi <= goal_.enough || (!dive_ && (heap_.empty() || heap_.least() >= cut()))) {
        return false;
    }
    // Rounding has set the lower bound already: some more steps may find a nearer point, and then it is enough.
    if (!dive_ && heap_.least() >= found_.lo && ++stepsInDoubt_ > kMostInDoubt) {
        return false;
    }
    found_.exhausted = found_.steps == goal_.maxSteps;
    return !found_.exhausted;
}

/// Tests quickly whether a cell within that distance of a box of the mesh may be opaque.
bool ClosestSearch::mayBeWithin(double distance) const {
    if (!(distance + error_.absolute < kInfinity)) {
        return true;
    }
    const VolumeSpace& space = part_->space;
    dvec3 around; // voxels
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kRounding = 1e-6;
        const dvec3 row(space.voxel_from_local[0][axis], space.voxel_from_local[1][axis],
                        space.voxel_from_local[2][axis]);
        around[axis] = (distance + error_.absolute) * length(row) * (1 + kRounding) + kRounding;
    }
    const auto mayBeNear = [&](const RunBox& box) {
        dvec3 lo;
        dvec3 hi;
        mesh_->voxelBounds(box, lo, hi);
        CellBox cells;
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            const double from = lo[axis] - around[axis] + space.centre[axis];
            const double to = hi[axis] + around[axis] + space.centre[axis];
            const std::int32_t last = volume_->image.size[at] - 1;
            if (to < -0.5 || from > last + 0.5) {
                return false;
            }
            // NaN is anywhere.
            cells.lo[at] = from > -1 ? std::min(static_cast<std::int32_t>(std::floor(from)), last) : -1;
            cells.hi[at] = to < last ? static_cast<std::int32_t>(std::floor(to)) : last;
        }
        return part_->occupancy.mayBeOpaque(*volume_, cells);
    };
    bool found = false;
    const MeshImpl& mesh = mesh_->mesh();
    mesh.tree.descend(0, static_cast<std::uint32_t>(mesh.clusters.size()), mayBeNear, [&](std::uint32_t /*run*/) {
        found = true;
        return false;
    });
    return found;
}

void ClosestSearch::begin(const OpenPairs* from) {
    stepsInDoubt_ = 0;
    for (std::size_t shift = 0; shift < diameters_.size(); ++shift) {
        diameters_[shift] = std::ldexp(length(part_->space.spacing), static_cast<int>(shift));
    }
    if (from == nullptr) {
        beginWithAll();
        return;
    }
    for (const Pair& pair : *from) {
        push(pair);
    }
}

void ClosestSearch::beginWithAll() {
    const std::uint32_t top = searched_->pyramid().levels() - 1;
    Pair pair;
    pair.shift = static_cast<std::uint8_t>(top + kBrickShift);
    const std::uint32_t level = mesh_->mesh().tree.levels() - 1;
    if (level == 0) {
        openCluster(pair);
        return;
    }
    pair.meshLevel = static_cast<std::int8_t>(level);
    for (pair.mesh = 0; pair.mesh < mesh_->mesh().tree.boxes(level).size(); ++pair.mesh) {
        offer(pair);
    }
}

ClosestSearch::Pair ClosestSearch::next() {
    if (dive_) {
        const Pair pair = *dive_;
        dive_.reset();
        return pair;
    }
    return heap_.pop();
}

/// Until a point is found, opens the nearest part of a pair immediately, even if another pair is nearer: later offers
/// are then pruned earlier.
void ClosestSearch::push(const Pair& pair) {
    Pair kept = pair;
    if (found_.hi == kInfinity && !found_.exhausted) {
        if (!dive_) {
            dive_ = pair;
            return;
        }
        if (dive_->isAfter(pair)) {
            std::swap(kept, *dive_);
        }
    }
    heap_.push(kept);
}

/// Drops the rest of a pair without division.
void ClosestSearch::drop(const Pair& pair) {
    found_.lo = std::min(found_.lo, pair.lo);
    dropped_.push_back(pair);
}

/// From the first certain point to the closest point of the mesh, and from there to about the closest opaque point, so
/// that most later offers are pruned at once.
void ClosestSearch::improve() {
    const MeshPoint onMesh = nearestOnMesh(*mesh_, found_.inVolume, found_.hi);
    if (found_.isOpaque && onMesh.distance < found_.hi) {
        found_.offer(error_.above(onMesh.distance), onMesh.triangle, onMesh.point, found_.inVolume, true);
    }
    const OpaquePoint opaque = nearestOpaque(*part_, *searched_, *volume_, found_.onMesh, found_.hi, nearMemory());
    if (opaque.distance < found_.hi) {
        found_.offer(error_.above(opaque.distance), found_.triangle, found_.onMesh, opaque.point, true);
    }
}

} // namespace voxtact::cpu

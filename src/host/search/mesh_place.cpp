// SPDX-License-Identifier: MIT
#include "host/search/mesh_place.h"
#include "core/base/infinity.h"
#include "core/geometry/recentre.h"
#include "host/search/cells/cluster_culling.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// Relative to the largest term of a coordinate: a distance takes a few dozen operations on such terms.
constexpr double kRelativeError = 0x1p-46;
/// Outside of these squares of distances may overflow, or vanish.
constexpr double kLeast = 1e-100;
constexpr double kGreatest = 1e100;

} // namespace

void MeshPlace::begin(const MeshImpl& mesh, const VolumeSpace& space, const Mat4& world_from_object,
                      const std::optional<Sweep>& sweep) {
    // Another mesh may have the same address; after 2^32 pairs all places are invalid.
    const bool fits = whole_ && clusters_.size() == mesh.clusters.size() && vertices_[2].size() == mesh.x.size() &&
                      boxes_.size() == mesh.tree.levels() && boxes_[0].size() == mesh.tree.boxes(0).size();
    if (!fits || ++pair_ == 0) {
        whole_ = false;
        boxes_.assign(mesh.tree.levels(), {});
        for (std::uint32_t level = 0; level < mesh.tree.levels(); ++level) {
            boxes_[level].resize(mesh.tree.boxes(level).size());
        }
        clusters_.assign(mesh.clusters.size(), 0);
        placed_.resize(clusters_.size());
        for (std::vector<double>& row : vertices_) {
            row.resize(mesh.x.size());
        }
        pair_ = 1;
        whole_ = true;
    }
    mesh_ = &mesh;
    space_ = &space;
    for (int column = 0; column < 3; ++column) {
        const auto at = static_cast<std::size_t>(4 * column);
        local_from_object_[column] = {world_from_object[at], world_from_object[at + 1], world_from_object[at + 2]};
    }
    voxel_from_object_ = space.voxel_from_local * local_from_object_;
    origin_ = dvec3(world_from_object[12], world_from_object[13], world_from_object[14]) - space.middle;
    const Mat4 world_from_floats = worldFromFloats(world_from_object, mesh.origin);
    floats_ = dvec3(world_from_floats[12], world_from_floats[13], world_from_floats[14]) - space.middle;
    sweep_ = sweep ? std::optional(sweep->from(space.middle)) : std::nullopt;
    findError(world_from_object);
}

void MeshPlace::findError(const Mat4& world_from_object) {
    double largest = 0;
    double squares = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        double sum = std::abs(world_from_object[12 + row]);
        for (std::size_t column = 0; column < 3; ++column) {
            squares += world_from_object[4 * column + row] * world_from_object[4 * column + row];
            const Box& bounds = mesh_->facts.bounds;
            const double vertex = std::max(std::abs(bounds.lo[column]), std::abs(bounds.hi[column]));
            sum += std::abs(world_from_object[4 * column + row]) * vertex;
        }
        largest = std::max(largest, sum);
    }
    const double magnitude = largest + space_->magnitude;
    const bool usable = magnitude > kLeast && magnitude < kGreatest;
    // The pose stretches no vector by more than the root of its squares.
    const double ofVertices = (1 + 0x1p-40) * std::sqrt(squares) * mesh_->origin.rounding;
    error_ = usable ? kRelativeError * magnitude * space_->condition + ofVertices : kInfinity;
}

void MeshPlace::voxelBounds(const RunBox& box, dvec3& lo, dvec3& hi) const {
    if (sweep_) {
        const PlacedBox inPlace = placed(box, sweep_->each != nullptr ? sweep_->eachScale * sweep_->each->most : 0);
        lo = inPlace.lo;
        hi = inPlace.hi;
        return;
    }
    const dvec3 least(static_cast<double>(box.lo[0]), static_cast<double>(box.lo[1]), static_cast<double>(box.lo[2]));
    const dvec3 most(static_cast<double>(box.hi[0]), static_cast<double>(box.hi[1]), static_cast<double>(box.hi[2]));
    const dvec3 middle = voxel_from_object_ * (0.5 * (least + most)) + space_->toVoxel(floats_);
    const dvec3 half = 0.5 * (most - least);
    const dvec3 extent = glm::abs(voxel_from_object_[0]) * half.x + glm::abs(voxel_from_object_[1]) * half.y +
                         glm::abs(voxel_from_object_[2]) * half.z;
    lo = middle - extent;
    hi = middle + extent;
}

const PlacedBox& MeshPlace::box(std::uint32_t level, std::uint32_t node) {
    Slot<PlacedBox>& slot = boxes_[level][node];
    if (slot.pair != pair_) {
        slot.pair = pair_;
        const bool own = sweep_ && sweep_->each != nullptr;
        slot.placed =
            placed(mesh_->tree.boxes(level)[node], own ? sweep_->eachScale * sweep_->each->boxes[level][node] : 0);
    }
    return slot.placed;
}

dvec3 MeshPlace::towards(const dvec3& to, const dvec3& from, double by) noexcept {
    const dvec3 off = to - from;
    const double size = length(off);
    return size > by ? from + by / size * off : to;
}

PlacedBox MeshPlace::placed(const RunBox& box, double own) const {
    dvec3 middle;
    PlacedBox out;
    dvec3 diagonal(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        // Exact in double.
        const double lo = static_cast<double>(box.lo[at]);
        const double hi = static_cast<double>(box.hi[at]);
        middle[axis] = (lo + hi) / 2;
        out.sides[at] = local_from_object_[axis] * ((hi - lo) / 2);
        diagonal += glm::abs(out.sides[at]);
    }
    out.middle = local_from_object_ * middle + floats_;
    const dvec3 centre = space_->toVoxel(out.middle);
    dvec3 extent(0);
    for (const dvec3& side : out.sides) {
        extent += glm::abs(space_->toVoxel(side));
    }
    out.diameter = 2 * length(diagonal);
    out.lo = centre - extent;
    out.hi = centre + extent;
    if (sweep_) {
        out.own = own;
        out.wide = sweep_->wide(out) + own;
        for (int axis = 0; axis < 3; ++axis) {
            const Direction along(glm::row(space_->voxel_from_local, axis), &*sweep_);
            out.hi[axis] = along.reach(out);
            out.lo[axis] = -Direction(-along.normal(), &*sweep_).reach(out);
        }
    }
    return out;
}

std::uint32_t MeshPlace::countOfCluster(std::uint32_t cluster) const {
    const ClusterPlace& place = mesh_->clusters[cluster];
    std::uint32_t triangles = place.triangleCount;
    while (triangles > 0 && mesh_->numbers[place.firstTriangle + triangles - 1] == kNoTriangle) {
        --triangles;
    }
    return triangles;
}

std::uint32_t MeshPlace::count(std::uint32_t run) const {
    const std::uint32_t from = first(run);
    std::uint32_t count = 0;
    while (count < kRunTriangles && mesh_->numbers[from + count] != kNoTriangle) {
        ++count;
    }
    return count;
}

dvec3 MeshPlace::vertex(std::size_t at) const {
    return {vertices_[0][at], vertices_[1][at], vertices_[2][at]};
}

MeshPlace::PlacedVertex MeshPlace::placedVertex(const dvec3& local, double own) const {
    const dvec3 voxel = space_->toVoxel(local);
    PlacedVertex out{voxel, voxel, 0, own};
    if (sweep_) {
        out.wide = sweep_->wide(local) + own;
        for (int axis = 0; axis < 3; ++axis) {
            const dvec3 row = glm::row(space_->voxel_from_local, axis);
            const double beside = length(row) * out.wide;
            out.hi[axis] = sweep_->reach(row, local) + beside;
            out.lo[axis] = -sweep_->reach(-row, local) - beside;
        }
    }
    return out;
}

void MeshPlace::placeCluster(std::uint32_t cluster) {
    const ClusterPlace& place = mesh_->clusters[cluster];
    const PlaceJob job{local_from_object_,
                       floats_,
                       space_->voxel_from_local,
                       {&mesh_->x[place.firstVertex], &mesh_->y[place.firstVertex], &mesh_->z[place.firstVertex]},
                       {&mesh_->corner0[place.firstTriangle], &mesh_->corner1[place.firstTriangle],
                        &mesh_->corner2[place.firstTriangle]},
                       place.vertexCount,
                       place.triangleCount};
    const std::array<double*, 3> local{&vertices_[0][place.firstVertex], &vertices_[1][place.firstVertex],
                                       &vertices_[2][place.firstVertex]};
    placeVertices(job, local);
    placeTriangles(job, {local[0], local[1], local[2]}, placed_[cluster]);
    if (sweep_) {
        placeSwept(cluster);
    }
}

/// Transforms the swept volume.
void MeshPlace::placeSwept(std::uint32_t cluster) {
    const ClusterPlace& place = mesh_->clusters[cluster];
    clusterVertices_.resize(std::max<std::size_t>(clusterVertices_.size(), place.vertexCount));
    for (std::size_t i = 0; i < place.vertexCount; ++i) {
        const std::size_t at = place.firstVertex + i;
        const double own = sweep_->each != nullptr ? sweep_->eachScale * sweep_->each->vertices[at] : 0;
        clusterVertices_[i] = placedVertex(vertex(at), own);
    }
    PlacedCluster& out = placed_[cluster];
    for (std::uint32_t i = 0; i < countOfCluster(cluster); ++i) {
        const std::size_t at = std::size_t{place.firstTriangle} + i;
        PlacedVertex all = clusterVertices_[mesh_->corner0[at]];
        for (const std::uint8_t corner : {mesh_->corner1[at], mesh_->corner2[at]}) {
            const PlacedVertex& one = clusterVertices_[corner];
            all.lo = glm::min(all.lo, one.lo);
            all.hi = glm::max(all.hi, one.hi);
            all.wide = std::max(all.wide, one.wide);
            all.own = std::max(all.own, one.own);
        }
        for (int axis = 0; axis < 3; ++axis) {
            out.lo[static_cast<std::size_t>(axis)][i] = all.lo[axis];
            out.hi[static_cast<std::size_t>(axis)][i] = all.hi[axis];
        }
        out.wide[i] = all.wide;
        out.own[i] = all.own;
    }
}

void MeshPlace::addCorners(std::uint32_t cluster, std::uint64_t triangles, PointList& points) const {
    const ClusterPlace& place = mesh_->clusters[cluster];
    points.wide = 0;
    std::array<bool, PointList::kMost> added{};
    for (std::uint64_t left = triangles; left != 0; left &= left - 1) {
        const auto number = static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t at = std::size_t{place.firstTriangle} + number;
        if (sweep_) {
            points.wide = std::max(points.wide, placed_[cluster].wide[number]);
        }
        for (const std::uint8_t corner : {mesh_->corner0[at], mesh_->corner1[at], mesh_->corner2[at]}) {
            if (!added[corner]) {
                added[corner] = true;
                const dvec3 point = vertex(std::size_t{place.firstVertex} + corner);
                points.x[points.count] = point.x;
                points.y[points.count] = point.y;
                points.z[points.count] = point.z;
                ++points.count;
            }
        }
    }
}

} // namespace voxtact::cpu

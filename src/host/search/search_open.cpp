// SPDX-License-Identifier: MIT
// What a pair is divided into, and which of that is still looked for.
#include "core/base/infinity.h"
#include "host/search/cells/cluster_culling.h"
#include "host/search/search.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dot;
using glm::dvec3;
using glm::length;

/// Bounds of a brick's cells are tighter than those of larger boxes: the volume's are opened first where sizes are
/// alike. By so much they may be smaller; a sweep's boxes are looser, too.
constexpr double kPreferVolume = 3;
constexpr double kPreferVolumeOfSweep = 2;

} // namespace

template <class Visit> void ClosestSearch::forTriangles(const Pair& pair, const Visit& visit) {
    const PlacedCluster& triangles = mesh_->cluster(pair.mesh);
    for (std::uint64_t left = pair.triangles; left != 0; left &= left - 1) {
        const auto number = static_cast<unsigned>(std::countr_zero(left));
        visit(number, triangles.triangle(number));
    }
}

template <class Bound> bool ClosestSearch::keep(Pair& pair, const Bound& bound) {
    std::uint64_t kept = 0;
    double least = kInfinity;
    forTriangles(pair, [&](unsigned number, const PlacedTriangle& triangle) {
        const double lo = std::max(pair.lo, bound(triangle));
        if (closes(lo)) {
            return;
        }
        kept |= std::uint64_t{1} << number;
        if (lo < least) {
            least = lo;
            pair.nearest = static_cast<std::uint8_t>(number);
        }
    });
    pair.triangles = kept;
    pair.lo = least;
    return kept != 0;
}

template <class Culling> bool ClosestSearch::keepBy(Pair& pair, const Culling& cull) {
    const RemainingTriangles left =
        cull(CullingJob{mesh_->cluster(pair.mesh), pair.triangles, pair.lo, cut(), error_.absolute});
    found_.lo = std::min(found_.lo, left.leastGone);
    pair.triangles = left.kept;
    pair.nearest = left.nearest;
    pair.lo = left.least;
    return left.kept != 0;
}

bool ClosestSearch::keepAlong(Pair& pair, const Direction& along, double least) {
    if (!mesh_->isSwept()) {
        const std::array<LeastAlong, 1> directions{LeastAlong(along, least)};
        return keepBy(pair, [&](const CullingJob& job) { return cullAlong(job, directions); });
    }
    return keep(pair, [&](const PlacedTriangle& triangle) {
        const double reach = along.reach(triangle);
        return along.length() > 0 ? error_.below((least - reach) / along.length()) : 0;
    });
}

void ClosestSearch::open(const Pair& pair) {
    const double prefer = mesh_->isSwept() ? kPreferVolumeOfSweep : kPreferVolume;
    if (pair.isLeaf()) {
        openLeaf(pair);
    } else if (pair.meshLevel == kTriangles) {
        if (pair.shift > leastShift()) {
            openVolume(pair);
        } else {
            openCells(pair);
        }
    } else if (pair.shift > leastShift() && boxOf(pair)->diameter < prefer * diameters_[pair.shift]) {
        openVolume(pair);
    } else if (pair.meshLevel > kClusters) {
        openBox(pair);
    } else {
        openCluster(pair);
    }
}

void ClosestSearch::openBox(const Pair& pair) {
    OpaqueBox region;
    if (!boxes_.opaque(pair.cube(), region)) {
        return;
    }
    Pair child = pair;
    --child.meshLevel;
    const auto boxes =
        static_cast<std::uint32_t>(mesh_->mesh().tree.boxes(static_cast<std::uint32_t>(child.meshLevel)).size());
    const std::uint32_t first = pair.mesh * ClusterTree::kFanOut;
    for (child.mesh = first; child.mesh < std::min(first + ClusterTree::kFanOut, boxes); ++child.mesh) {
        offerBox(child, *boxOf(child), region);
    }
}

/// A box of the mesh, and the opaque part of a box of the volume.
void ClosestSearch::offerBox(Pair pair, const PlacedBox& box, const OpaqueBox& region) {
    pair.lo = std::max(pair.lo, boxes_.gap(region, box.lo, box.hi));
    if (closes(pair.lo)) {
        return;
    }
    const dvec3 middle = part_->space.toWorld(region.middle());
    const Direction along = mesh_->along(middle - mesh_->near(box, middle));
    pair.lo = std::max(pair.lo, boxes_.apart(region, along, along.reach(box)));
    if (!closes(pair.lo)) {
        push(pair);
    }
}

/// Around the mesh's half of the pair; null where the tree has none.
const PlacedBox* ClosestSearch::boxOf(const Pair& pair) {
    const auto level = static_cast<std::uint32_t>(std::max<int>(pair.meshLevel, kClusters));
    return level < mesh_->mesh().tree.levels() ? &mesh_->box(level, pair.mesh) : nullptr;
}

void ClosestSearch::openCluster(const Pair& pair) {
    Pair child = pair;
    child.meshLevel = kTriangles;
    child.triangles = ~std::uint64_t{0} >> (kClusterTriangles - mesh_->countOfCluster(pair.mesh));
    OpaqueBox region;
    if (!boxes_.opaque(child.cube(), region)) {
        return;
    }
    // All by the normal of their box, then each by its own.
    const dvec3 middle = part_->space.toWorld(region.middle());
    const PlacedBox* box = boxOf(child);
    const Direction along = box != nullptr ? mesh_->along(middle - mesh_->near(*box, middle)) : from(child, middle);
    if (keepAlong(child, along, boxes_.least(region, along.normal())) && sift(child, region)) {
        push(child);
    }
}

void ClosestSearch::openVolume(const Pair& pair) {
    Pair child = pair;
    OpaqueBox region;
    if (pair.meshLevel == kTriangles && !pair.sifted && !(boxes_.opaque(pair.cube(), region) && sift(child, region))) {
        return;
    }
    child.sifted = false;
    --child.shift;
    for (unsigned i = 0; i < 8; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            child.node[axis] = 2 * pair.node[axis] + static_cast<std::int32_t>(i >> axis & 1U);
        }
        offer(child);
    }
}

void ClosestSearch::openCells(const Pair& pair) {
    OpaqueBox region;
    Pair cell = pair;
    if (!boxes_.opaque(pair.cube(), region) || !(pair.sifted || sift(cell, region))) {
        return;
    }
    if (!mesh_->isSwept() && found_.hi - cell.lo > diameters_[0]) {
        lookInto(cell, region);
    }
    gather(cell);
    const Direction direction = from(cell, part_->space.toWorld(region.middle()));
    const dvec3 along = direction.normal() * part_->space.local_from_voxel;
    const dvec3 lowest = glm::min(along, dvec3(0));
    const double base = dot(along, region.corner) + lowest.x + lowest.y + lowest.z - direction.reach(corners_);
    cullCells({*region.known, region.cells, along, base, direction.inverse(), cell.lo, cut(), error_.absolute}, cells_);
    found_.lo = std::min(found_.lo, cells_.leastGone);
    const NodePlace first{(pair.node[0] << pair.shift) & ~(kBrickSide - 1),
                          (pair.node[1] << pair.shift) & ~(kBrickSide - 1),
                          (pair.node[2] << pair.shift) & ~(kBrickSide - 1)};
    cell.shift = 0;
    cell.sifted = false;
    for (std::int32_t z = region.cells.lo[2]; z <= region.cells.hi[2]; ++z) {
        for (std::int32_t y = region.cells.lo[1]; y <= region.cells.hi[1]; ++y) {
            const auto number = static_cast<std::size_t>(y + kBrickSide * z);
            for (unsigned row = cells_.kept[number]; row != 0; row &= row - 1) {
                const std::int32_t x = std::countr_zero(row);
                cell.lo = cells_.lo[number * kBrickSide + static_cast<std::size_t>(x)];
                cell.node = {first[0] + x, first[1] + y, first[2] + z};
                if (mesh_->isSwept()) {
                    offerPiece(cell, part_->cell(*volume_, cell.node));
                } else {
                    addCell(cell);
                }
            }
        }
    }
    offerCells();
}

void ClosestSearch::addCell(const Pair& pair) {
    if (rows_.count == PieceRows::kMost) {
        offerCells();
    }
    part_->addCell(*volume_, pair.node, rows_);
    offered_.push_back(pair);
}

void ClosestSearch::offerCells() {
    makeTerms(rows_);
    offerRows();
}

void ClosestSearch::offer(Pair pair) {
    OpaqueBox region;
    if (!boxes_.whole(pair.cube(), region)) {
        return;
    }
    const PlacedBox* box = boxOf(pair);
    pair.lo = box != nullptr ? std::max(pair.lo, boxes_.gap(region, box->lo, box->hi)) : pair.lo;
    if (closes(pair.lo) || (pair.shift <= kBrickShift && !boxes_.narrow(pair.cube(), region))) {
        return;
    }
    if (pair.meshLevel != kTriangles) {
        offerBox(pair, *box, region);
        return;
    }
    const Direction along = from(pair, part_->space.toWorld(region.middle()));
    gather(pair);
    pair.lo = std::max(pair.lo, boxes_.apart(region, along, along.reach(corners_)));
    if (!closes(pair.lo)) {
        push(pair);
    }
}

/// Keeps the triangles that may be near enough to a box.
bool ClosestSearch::sift(Pair& pair, const OpaqueBox& region) {
    pair.sifted = true;
    if (!mesh_->isSwept()) {
        return keepBy(pair, [&](const CullingJob& job) {
            return cullByBox(job, part_->space, {region.lo, region.hi});
        });
    }
    const dvec3 middle = part_->space.toWorld(region.middle());
    return keep(pair, [&](const PlacedTriangle& triangle) {
        const double lo = boxes_.gap(region, triangle.lo, triangle.hi);
        if (lo >= cut()) {
            return lo;
        }
        const Direction along = mesh_->along(middle - mesh_->near(triangle, middle));
        return std::max(lo, boxes_.wholeApart(region, along, along.reach(triangle)));
    });
}

void ClosestSearch::gather(const Pair& pair) {
    corners_.count = 0;
    static_cast<void>(mesh_->cluster(pair.mesh));
    mesh_->addCorners(pair.mesh, pair.triangles, corners_);
}

/// Returns the direction from the previously nearest triangle to a point.
Direction ClosestSearch::from(const Pair& pair, const dvec3& point) {
    return mesh_->along(point - mesh_->near(mesh_->triangle(pair.mesh, pair.nearest), point));
}

void ClosestSearch::offerPiece(Pair pair, const PartCell& cell) {
    CellPiece piece = pieceAt(cell, pair.place());
    if (!piece.mayBeOpaque(part_->intervals) || !searched_->meets(pair.place())) {
        return;
    }
    const PieceBounds bounds = piece.bounds(part_->space);
    if (const Direction along = from(pair, bounds.middle); along.length() > 0) {
        pair.lo = std::max(pair.lo, error_.below(PieceAlong(bounds, part_->space, along).from(along.reach(corners_))));
    }
    if (!closes(pair.lo)) {
        push(pair);
    }
}

/// The nearer a point is known, the fewer cells are offered.
void ClosestSearch::lookInto(const Pair& pair, const OpaqueBox& region) {
    const PlacedTriangle nearest = mesh_->triangle(pair.mesh, pair.nearest);
    const std::uint32_t number = pair.mesh * kClusterTriangles + pair.nearest;
    const dvec3 onMesh = nearest.near(part_->space.toWorld(region.middle()));
    const unsigned up = static_cast<unsigned>(kBrickShift) - pair.shift;
    const NodePlace brick{pair.node[0] >> up, pair.node[1] >> up, pair.node[2] >> up};
    const OpaquePoint opaque = nearestInBrick(*part_, *searched_, *volume_, brick, onMesh, found_.hi, nearMemory());
    if (opaque.distance < found_.hi) {
        const dvec3 nearer = nearest.near(opaque.point);
        found_.offer(error_.above(opaque.distance), number, onMesh, opaque.point, true);
        found_.offer(error_.above(glm::distance(nearer, opaque.point)), number, nearer, opaque.point, true);
    }
}

void ClosestSearch::offerRows() {
    findRanges(rows_);
    std::uint64_t left = 0;
    for (std::size_t i = 0; i < rows_.count; ++i) {
        ValueRange hull;
        if (part_->intervals.meet(rows_.lo[i], rows_.hi[i], hull) && searched_->meets(offered_[i].place())) {
            rows_.hullLo[i] = hull.lo;
            rows_.hullHi[i] = hull.hi;
            left |= std::uint64_t{1} << i;
        }
    }
    if (left != 0) {
        const Pair& any = offered_.front();
        findApart({mesh_->cluster(any.mesh), any.nearest, corners_, part_->space, cut(), error_.absolute}, rows_);
    }
    for (; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        Pair& pair = offered_[i];
        pair.lo = std::max(pair.lo, rows_.apart[i]);
        if (!closes(pair.lo)) {
            push(pair);
        }
    }
    rows_.count = 0;
    offered_.clear();
}

bool ClosestSearch::keepByPiece(Pair& pair, const CellPiece& piece, const PieceBounds& bounds) {
    // The nearest triangle's normal serves most of the others, which share a corner with it or are farther off.
    const PieceAlong shared(bounds, part_->space, from(pair, bounds.middle));
    if (!mesh_->isSwept()) {
        const LeastAlong along(shared.direction, shared.least);
        return keepBy(pair, [&](const CullingJob& job) { return cullByPiece(job, part_->space, bounds, along); });
    }
    const dvec3 ascent = piece.ascent(part_->space);
    const dvec3 other = dot(ascent, shared.direction.normal()) < 0 ? -ascent : ascent;
    const std::array<PieceAlong, 2> always{shared, PieceAlong(bounds, part_->space, mesh_->along(other))};
    PieceAlong own;
    return keep(pair, [&](const PlacedTriangle& triangle) {
        double lo = 0;
        for (const PieceAlong& one : always) {
            lo = std::max(lo, error_.below(one.from(triangle)));
            if (lo >= cut()) {
                return lo;
            }
        }
        // Triangles that share the closest corner are seen along the same normal.
        const dvec3 normal = bounds.middle - mesh_->near(triangle, bounds.middle);
        if (normal != own.direction.normal()) {
            own = PieceAlong(bounds, part_->space, mesh_->along(normal));
        }
        return std::max(lo, error_.below(own.from(triangle)));
    });
}

void ClosestSearch::openLeaf(const Pair& pair) {
    const PartCell cell = part_->cell(*volume_, pair.node);
    CellPiece piece = pieceAt(cell, pair.place());
    if (!piece.mayBeOpaque(part_->intervals)) {
        return;
    }
    const PieceBounds bounds = piece.bounds(part_->space);
    Pair child = pair;
    if (!keepByPiece(child, piece, bounds)) {
        return;
    }
    // The full test costs as much as all of these.
    const PlacedTriangle nearest = mesh_->triangle(pair.mesh, child.nearest);
    const dvec3 normal = PieceDistance(*part_, *searched_, cell, piece, *mesh_, nearest, goal_.tolerance / 8)
                             .run(pair.place(), error_, pair.mesh * kClusterTriangles + child.nearest, found_);
    const PieceAlong seen(bounds, part_->space, mesh_->along(normal));
    if (!keepAlong(child, seen.direction, seen.least)) {
        return;
    }
    const bool inDoubt = !piece.someOpaque(part_->intervals);
    const double diameter = 2 * length(part_->space.spacing * piece.half());
    const bool small = diameter < goal_.finest;
    if (pair.depth == kMostDepth || (inDoubt && (piece.isFlat() || small)) || (goal_.coarsely && small)) {
        drop(child);
        return;
    }
    ++child.depth;
    gather(child);
    for (unsigned i = 0; i < 8; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            child.piece[axis] = static_cast<std::uint16_t>(2 * pair.piece[axis] + (i >> axis & 1U));
        }
        if (mesh_->isSwept()) {
            offerPiece(child, cell);
        } else {
            rows_.add(cell, child.place());
            offered_.push_back(child);
        }
    }
    offerRows();
}

} // namespace voxtact::cpu

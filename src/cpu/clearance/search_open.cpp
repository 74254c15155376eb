// SPDX-License-Identifier: MIT
// What a pair is divided into, and which of that is still looked for.
#include "cpu/clearance/piece_look.h"
#include "cpu/clearance/search.h"

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
/// alike.
constexpr double kPreferVolume = 2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

template <class Visit> void ClosestSearch::forTriangles(const Pair& pair, const Visit& visit) {
    const PlacedTriangle* triangles = mesh_->cluster(pair.mesh);
    for (std::uint64_t left = pair.triangles; left != 0; left &= left - 1) {
        const auto number = static_cast<unsigned>(std::countr_zero(left));
        visit(number, triangles[number]);
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

void ClosestSearch::open(const Pair& pair) {
    if (pair.isLeaf()) {
        openLeaf(pair);
    } else if (pair.meshLevel == kTriangles) {
        if (pair.shift > kLeastShift) {
            openVolume(pair);
        } else {
            openCells(pair);
        }
    } else if (pair.shift > kLeastShift && boxOf(pair)->diameter < kPreferVolume * diameters_[pair.shift]) {
        openVolume(pair);
    } else if (pair.meshLevel > kClusters) {
        openBox(pair);
    } else {
        openCluster(pair);
    }
}

void ClosestSearch::openBox(const Pair& pair) {
    Pair child = pair;
    --child.meshLevel;
    const auto boxes =
        static_cast<std::uint32_t>(mesh_->mesh().tree.boxes(static_cast<std::uint32_t>(child.meshLevel)).size());
    const std::uint32_t first = pair.mesh * ClusterTree::kFanOut;
    for (child.mesh = first; child.mesh < std::min(first + ClusterTree::kFanOut, boxes); ++child.mesh) {
        offer(child);
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
    // All of them by the normal of their box, then each by its own.
    const dvec3 middle = part_->space.toWorld(region.middle());
    const PlacedBox* box = boxOf(child);
    const Direction along = box != nullptr ? mesh_->along(middle - mesh_->near(*box, middle)) : from(child, middle);
    if (along.length() > 0) {
        const double least = boxes_.least(region, along.normal());
        if (!keep(child, [&](const PlacedTriangle& triangle) {
                return error_.below((least - along.reach(triangle)) / along.length());
            })) {
            return;
        }
    }
    if (sift(child, region)) {
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
    gather(cell);
    const Direction direction = from(cell, part_->space.toWorld(region.middle()));
    const dvec3 along = direction.normal() * part_->space.local_from_voxel;
    const dvec3 lowest = glm::min(along, dvec3(0));
    const double base = dot(along, region.corner) + lowest.x + lowest.y + lowest.z - direction.reach(corners_);
    const double size = direction.length();
    const double least = cell.lo;
    const NodePlace first{(pair.node[0] << pair.shift) & ~(kBrickSide - 1),
                          (pair.node[1] << pair.shift) & ~(kBrickSide - 1),
                          (pair.node[2] << pair.shift) & ~(kBrickSide - 1)};
    cell.shift = 0;
    cell.sifted = false;
    for (std::int32_t z = region.cells.lo[2]; z <= region.cells.hi[2]; ++z) {
        for (std::int32_t y = region.cells.lo[1]; y <= region.cells.hi[1]; ++y) {
            for (unsigned row = region.known->row(region.cells, y, z); row != 0; row &= row - 1) {
                const std::int32_t x = std::countr_zero(row);
                const double apart = base + along.x * x + along.y * y + along.z * z;
                cell.lo = size > 0 ? std::max(least, error_.below(apart / size)) : least;
                if (!closes(cell.lo)) {
                    cell.node = {first[0] + x, first[1] + y, first[2] + z};
                    offerPiece(cell, part_->cell(*volume_, cell.node));
                }
            }
        }
    }
}

void ClosestSearch::offer(Pair pair) {
    OpaqueBox region;
    if (!boxes_.whole(pair.cube(), region)) {
        return;
    }
    const PlacedBox* box = boxOf(pair);
    const auto boxCloses = [&] {
        pair.lo = box != nullptr ? std::max(pair.lo, boxes_.gap(region, box->lo, box->hi)) : pair.lo;
        return closes(pair.lo);
    };
    if (boxCloses() || (pair.shift <= kBrickShift && !boxes_.narrow(pair.cube(), region)) || boxCloses()) {
        return;
    }
    if (pair.meshLevel == kTriangles) {
        const Direction along = from(pair, part_->space.toWorld(region.middle()));
        gather(pair);
        pair.lo = std::max(pair.lo, boxes_.apart(region, along, along.reach(corners_)));
    } else {
        const dvec3 middle = part_->space.toWorld(region.middle());
        const Direction along = mesh_->along(middle - mesh_->near(*box, middle));
        pair.lo = std::max(pair.lo, boxes_.apart(region, along, along.reach(*box)));
    }
    if (!closes(pair.lo)) {
        push(pair);
    }
}

/// Keeps the triangles that may be near enough to a box.
bool ClosestSearch::sift(Pair& pair, const OpaqueBox& region) {
    pair.sifted = true;
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

/// From the triangle that was nearest before to a point.
Direction ClosestSearch::from(const Pair& pair, const dvec3& point) {
    return mesh_->along(point - mesh_->near(mesh_->cluster(pair.mesh)[pair.nearest], point));
}

void ClosestSearch::offerPiece(Pair pair, const PartCell& cell) {
    CellPiece piece = pieceAt(cell, pair.place());
    if (!piece.mayBeOpaque(part_->intervals) || !searched_->meets(pair.place())) {
        return;
    }
    const dvec3 middle = part_->space.toWorld(piece.middle());
    if (const Direction along = from(pair, middle); along.length() > 0) {
        pair.lo = std::max(pair.lo, error_.below(PieceAlong(piece, part_->space, along).from(along.reach(corners_))));
    }
    if (!closes(pair.lo)) {
        push(pair);
    }
}

void ClosestSearch::openLeaf(const Pair& pair) {
    const PartCell cell = part_->cell(*volume_, pair.node);
    CellPiece piece = pieceAt(cell, pair.place());
    if (!piece.mayBeOpaque(part_->intervals)) {
        return;
    }
    const auto along = [&](const dvec3& normal) { return PieceAlong(piece, part_->space, mesh_->along(normal)); };
    const dvec3 middle = part_->space.toWorld(piece.middle());
    // The nearest triangle's normal serves most of the others, which share a corner with it or are farther off.
    const dvec3 shared = middle - mesh_->near(mesh_->cluster(pair.mesh)[pair.nearest], middle);
    const dvec3 ascent = piece.ascent(part_->space);
    const std::array<PieceAlong, 2> always{along(shared), along(dot(ascent, shared) < 0 ? -ascent : ascent)};
    PieceAlong own;
    Pair child = pair;
    const bool mayBeNear = keep(child, [&](const PlacedTriangle& triangle) {
        double lo = 0;
        for (const PieceAlong& one : always) {
            lo = std::max(lo, error_.below(one.from(triangle)));
            if (lo >= cut()) {
                return lo;
            }
        }
        // Triangles that share the closest corner are seen along the same normal.
        const dvec3 normal = middle - mesh_->near(triangle, middle);
        if (normal != own.direction.normal()) {
            own = along(normal);
        }
        return std::max(lo, error_.below(own.from(triangle)));
    });
    if (!mayBeNear) {
        return;
    }
    // A look takes as long as all of that.
    const PlacedTriangle& nearest = mesh_->cluster(pair.mesh)[child.nearest];
    const PieceAlong seen =
        along(PieceLook(*part_, *searched_, cell, piece, *mesh_, nearest, goal_.tolerance / 8)
                  .run(pair.place(), error_, pair.mesh * kClusterTriangles + child.nearest, found_));
    if (!keep(child, [&](const PlacedTriangle& triangle) { return error_.below(seen.from(triangle)); })) {
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
        offerPiece(child, cell);
    }
}

} // namespace voxtact::cpu

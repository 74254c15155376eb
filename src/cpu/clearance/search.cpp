// SPDX-License-Identifier: MIT
#include "cpu/clearance/search.h"
#include "cpu/clearance/nearest_point.h"

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

/// Of a distance: the last roundings, which do not depend on where things are.
constexpr double kDistanceError = 0x1p-40;
/// Bounds of a brick's cells are tighter than those of larger boxes: the volume's are opened first where sizes are
/// alike.
constexpr double kPreferVolume = 2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double reachAlong(const dvec3& normal, const std::array<dvec3, 3>& sides) {
    return std::abs(dot(normal, sides[0])) + std::abs(dot(normal, sides[1])) + std::abs(dot(normal, sides[2]));
}

double farthestAlong(const dvec3& normal, const WorldTriangle& corners) {
    return std::max({dot(normal, corners[0]), dot(normal, corners[1]), dot(normal, corners[2])});
}

/// A point of a parallelepiped that is about the closest one; it is where the sides are at right angles.
dvec3 pointNear(const PlacedBox& box, const dvec3& from) {
    const dvec3 off = from - box.middle;
    dvec3 point = box.middle;
    for (const dvec3& side : box.sides) {
        const double square = dot(side, side);
        if (square > 0) {
            point += std::clamp(dot(off, side) / square, -1.0, 1.0) * side;
        }
    }
    return point;
}

} // namespace

/// Of pairs that are equally near, the smaller ones first: to find some point soon.
bool ClosestSearch::After::operator()(const Pair& a, const Pair& b) const noexcept {
    if (a.lo != b.lo) {
        return a.lo > b.lo;
    }
    const int sizeA = a.meshLevel + a.shift - a.depth;
    const int sizeB = b.meshLevel + b.shift - b.depth;
    return sizeA > sizeB;
}

Found ClosestSearch::run(MeshPlace& mesh, const VolumeImpl& volume, const OpaquePart& part,
                         const SearchedPart& searched, const SearchGoal& goal) {
    mesh_ = &mesh;
    volume_ = &volume;
    part_ = &part;
    searched_ = &searched;
    goal_ = goal;
    found_ = {};
    error_ = mesh.error();
    bool improved = false;
    heap_.clear();
    dive_.reset();
    if (!mayBeWithin(goal.maximum)) {
        found_.lo = goal.maximum;
        return found_;
    }
    begin();
    while (goesOn()) {
        ++found_.steps;
        open(next());
        if (!improved && found_.hi < kInfinity) {
            improved = true;
            improve();
        }
    }
    if (dive_) {
        push(*dive_);
    }
    if (!heap_.empty()) {
        found_.lo = std::min(found_.lo, heap_.front().lo);
    }
    found_.lo = std::min(found_.lo, found_.hi);
    return found_;
}

bool ClosestSearch::goesOn() {
    if (found_.hi <= goal_.enough || (!dive_ && (heap_.empty() || heap_.front().lo >= cut()))) {
        return false;
    }
    // Rounding has set the lower bound already: some more steps may find a nearer point, and then it is enough.
    constexpr std::uint64_t kMostInDoubt = 1000;
    if (!dive_ && heap_.front().lo >= found_.lo && ++stepsInDoubt_ > kMostInDoubt) {
        return false;
    }
    found_.exhausted = found_.steps == goal_.mostSteps;
    return !found_.exhausted;
}

/// A quick look: whether some cell may be opaque that is as near as that to a box of the mesh.
bool ClosestSearch::mayBeWithin(double distance) const {
    if (!(distance + error_ < kInfinity)) {
        return true;
    }
    const VolumeSpace& space = part_->space;
    dvec3 around; // voxels
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kRounding = 1e-6;
        const dvec3 row(space.voxel_from_local[0][axis], space.voxel_from_local[1][axis],
                        space.voxel_from_local[2][axis]);
        around[axis] = (distance + error_) * length(row) * (1 + kRounding) + kRounding;
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

void ClosestSearch::begin() {
    stepsInDoubt_ = 0;
    for (std::size_t shift = 0; shift < diameters_.size(); ++shift) {
        diameters_[shift] = std::ldexp(length(part_->space.spacing), static_cast<int>(shift));
    }
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
    std::pop_heap(heap_.begin(), heap_.end(), After());
    const Pair pair = heap_.back();
    heap_.pop_back();
    return pair;
}

/// Until some point is found, what is nearest of a pair is opened at once, be something else nearer: what is offered
/// thereafter is closed sooner.
void ClosestSearch::push(const Pair& pair) {
    Pair kept = pair;
    if (found_.hi == kInfinity && !found_.exhausted) {
        if (!dive_) {
            dive_ = pair;
            return;
        }
        if (After()(*dive_, pair)) {
            std::swap(kept, *dive_);
        }
    }
    heap_.push_back(kept);
    std::push_heap(heap_.begin(), heap_.end(), After());
}

double ClosestSearch::safe(double distance) const {
    return std::max(0.0, distance * (1 - kDistanceError) - error_);
}

double ClosestSearch::cut() const noexcept {
    return std::min(found_.hi - goal_.tolerance, goal_.maximum);
}

/// What is closed is not looked at again: the answer's lower bound is no higher.
bool ClosestSearch::closes(double lo) {
    if (lo < cut()) {
        return false;
    }
    found_.lo = std::min(found_.lo, lo);
    return true;
}

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
    Region region;
    if (!regionOfOpaque(child, region)) {
        return;
    }
    // All of them by the normal of their box, then each by its own.
    const dvec3 middle = part_->space.toWorld(0.5 * (region.lo + region.hi));
    const PlacedBox* box = boxOf(child);
    const dvec3 normal = box != nullptr ? middle - pointNear(*box, middle) : normalFrom(child, middle);
    const double size = length(normal);
    if (size > 0) {
        const double least = leastOf(region, normal);
        if (!keep(child, [&](const PlacedTriangle& triangle) {
                return safe((least - farthestAlong(normal, triangle.corners)) / size);
            })) {
            return;
        }
    }
    if (sift(child, region)) {
        push(child);
    }
}

/// From one certain point to the closest on the mesh, from there to the opaque part, and so on: to a point that is
/// locally the closest, so that most of what is offered later is closed at once.
void ClosestSearch::improve() {
    constexpr int kMostTurns = 4;
    constexpr double kWorthwhile = 8; // tolerances
    for (int turn = 0; turn < kMostTurns && found_.hi > goal_.enough; ++turn) {
        const double before = found_.hi;
        const MeshPoint onMesh = nearestOnMesh(*mesh_, found_.inVolume, before);
        if (onMesh.distance < before) {
            offerPoint(onMesh.triangle, onMesh.distance, onMesh.point, found_.inVolume);
        }
        const OpaquePoint opaque = nearestOpaque(*part_, *searched_, *volume_, found_.onMesh, found_.hi);
        if (opaque.distance < found_.hi) {
            offerPoint(found_.triangle, opaque.distance, found_.onMesh, opaque.point);
        }
        if (!(found_.hi < before - kWorthwhile * goal_.tolerance)) {
            return;
        }
    }
}

void ClosestSearch::openVolume(const Pair& pair) {
    Pair child = pair;
    Region region;
    if (pair.meshLevel == kTriangles && !pair.sifted && !(regionOfOpaque(pair, region) && sift(child, region))) {
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
    Region region;
    Pair cell = pair;
    if (!regionOfOpaque(pair, region) || !(pair.sifted || sift(cell, region))) {
        return;
    }
    gather(cell);
    const dvec3 normal = normalFrom(cell, part_->space.toWorld(0.5 * (region.lo + region.hi)));
    const dvec3 along = normal * part_->space.local_from_voxel;
    const dvec3 lowest = glm::min(along, dvec3(0));
    const double base = dot(along, region.corner) + lowest.x + lowest.y + lowest.z - corners_.reach(normal);
    const double size = length(normal);
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
                cell.lo = size > 0 ? std::max(least, safe(apart / size)) : least;
                if (!closes(cell.lo)) {
                    cell.node = {first[0] + x, first[1] + y, first[2] + z};
                    offerPiece(cell, part_->cell(*volume_, cell.node));
                }
            }
        }
    }
}

/// Of cells, both ends inclusive, as far as they are in the domain.
void ClosestSearch::setRegion(const NodePlace& first, const NodePlace& last, Region& region) const {
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        const double reach = part_->space.reach[axis];
        const double centre = part_->space.centre[axis];
        region.lo[axis] = std::max(first[at] - 1 - centre, -reach);
        region.hi[axis] = std::min(last[at] - centre, reach);
    }
}

/// The part of a pair's box that may hold opaque cells; false where there is none.
bool ClosestSearch::narrow(const Pair& pair, Region& region) const {
    NodePlace first{};
    NodePlace last{};
    NodePlace brick{};
    CellBox inside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = pair.node[axis] << pair.shift;
        brick[axis] = first[axis] >> kBrickShift;
        last[axis] = std::min(first[axis] + (1 << pair.shift) - 1, volume_->image.size[axis]);
        inside.lo[axis] = first[axis] & (kBrickSide - 1);
        inside.hi[axis] = last[axis] - (brick[axis] << kBrickShift);
    }
    const BrickCells& known = part_->cells(*volume_, brick);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        inside.lo[axis] = std::max(inside.lo[axis], known.around.lo[axis]);
        inside.hi[axis] = std::min(inside.hi[axis], known.around.hi[axis]);
        first[axis] = inside.lo[axis] + (brick[axis] << kBrickShift);
        last[axis] = inside.hi[axis] + (brick[axis] << kBrickShift);
    }
    if (inside.empty() || (pair.shift < kBrickShift && !known.any(inside))) {
        return false;
    }
    setRegion(first, last, region);
    region.known = &known;
    region.cells = inside;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        region.corner[axis] = (brick[at] << kBrickShift) - 1 - part_->space.centre[axis];
    }
    return true;
}

/// Before it is narrowed; false outside of the volume, and where nothing is opaque.
bool ClosestSearch::regionOf(const Pair& pair, Region& region) const {
    if (pair.shift >= kBrickShift && !searched_->pyramid().has(pair.shift - kBrickShift, pair.node)) {
        return false;
    }
    NodePlace first{};
    NodePlace last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = pair.node[axis] << pair.shift;
        last[axis] = first[axis] + (1 << pair.shift) - 1;
        if (first[axis] > volume_->image.size[axis]) {
            return false;
        }
    }
    setRegion(first, last, region);
    return true;
}

/// As much of it as may hold something opaque; false where there is none.
bool ClosestSearch::regionOfOpaque(const Pair& pair, Region& region) const {
    return regionOf(pair, region) && (pair.shift > kBrickShift || narrow(pair, region));
}

void ClosestSearch::offer(Pair pair) {
    Region region;
    if (!regionOf(pair, region)) {
        return;
    }
    const PlacedBox* box = boxOf(pair);
    const auto boxCloses = [&] {
        pair.lo = box != nullptr ? std::max(pair.lo, gap(region, box->lo, box->hi)) : pair.lo;
        return closes(pair.lo);
    };
    if (boxCloses() || (pair.shift <= kBrickShift && !narrow(pair, region)) || boxCloses()) {
        return;
    }
    if (pair.meshLevel == kTriangles) {
        const dvec3 normal = normalFrom(pair, part_->space.toWorld(0.5 * (region.lo + region.hi)));
        gather(pair);
        pair.lo = std::max(pair.lo, apart(region, normal, corners_.reach(normal)));
    } else {
        pair.lo = std::max(pair.lo, apart(region, *box));
    }
    if (!closes(pair.lo)) {
        push(pair);
    }
}

/// Keeps the triangles that may be near enough to a box.
bool ClosestSearch::sift(Pair& pair, const Region& region) {
    pair.sifted = true;
    return keep(pair, [&](const PlacedTriangle& triangle) {
        const double lo = gap(region, triangle.lo, triangle.hi);
        return lo < cut() ? std::max(lo, apart(region, triangle.corners)) : lo;
    });
}

/// How far the boxes around them are apart.
double ClosestSearch::gap(const Region& region, const dvec3& lo, const dvec3& hi) const {
    const dvec3 off = glm::max(glm::max(region.lo - hi, lo - region.hi), dvec3(0));
    return safe(length(off * part_->space.spacing));
}

namespace {

/// The least dot product of `along` with a point of a box.
double leastInBox(const dvec3& along, const dvec3& lo, const dvec3& hi) {
    return 0.5 * (dot(along, lo + hi) - dot(glm::abs(along), hi - lo));
}

/// The least dot product of `along` with the lowest corner of a cell that may be opaque, from the brick's first cell.
double leastCell(const BrickCells& known, const CellBox& cells, const dvec3& along) {
    double least = kInfinity;
    for (std::int32_t z = cells.lo[2]; z <= cells.hi[2]; ++z) {
        for (std::int32_t y = cells.lo[1]; y <= cells.hi[1]; ++y) {
            const unsigned row = known.row(cells, y, z);
            if (row != 0) {
                const int x = along.x >= 0 ? std::countr_zero(row) : static_cast<int>(std::bit_width(row)) - 1;
                least = std::min(least, along.x * x + along.y * y + along.z * z);
            }
        }
    }
    return least;
}

} // namespace

/// The least dot product of an opaque point with a normal.
double ClosestSearch::leastOf(const Region& region, const dvec3& normal) const {
    const dvec3 along = normal * part_->space.local_from_voxel;
    const double box = leastInBox(along, region.lo, region.hi);
    if (region.known == nullptr || region.cells.single()) {
        return box;
    }
    const dvec3 lowest = glm::min(along, dvec3(0));
    return std::max(box, dot(along, region.corner) + lowest.x + lowest.y + lowest.z +
                             leastCell(*region.known, region.cells, along));
}

/// Along a normal: `reach` is the greatest dot product of it with a point of the mesh.
double ClosestSearch::apart(const Region& region, const dvec3& normal, double reach) const {
    const double size = length(normal);
    return size > 0 ? safe((leastOf(region, normal) - reach) / size) : 0;
}

double ClosestSearch::apart(const Region& region, const PlacedBox& box) const {
    const dvec3 middle = part_->space.toWorld(0.5 * (region.lo + region.hi));
    const dvec3 normal = middle - pointNear(box, middle);
    return apart(region, normal, dot(normal, box.middle) + reachAlong(normal, box.sides));
}

double ClosestSearch::apart(const Region& region, const WorldTriangle& corners) const {
    const dvec3 middle = part_->space.toWorld(0.5 * (region.lo + region.hi));
    const dvec3 normal = middle - closestPoint(corners, middle);
    const double size = length(normal);
    const double least = leastInBox(normal * part_->space.local_from_voxel, region.lo, region.hi);
    return size > 0 ? safe((least - farthestAlong(normal, corners)) / size) : 0;
}

void ClosestSearch::gather(const Pair& pair) {
    corners_.count = 0;
    static_cast<void>(mesh_->cluster(pair.mesh));
    mesh_->addCorners(pair.mesh, pair.triangles, corners_);
}

/// From the triangle that was nearest before to a point.
dvec3 ClosestSearch::normalFrom(const Pair& pair, const dvec3& middle) {
    return middle - closestPoint(mesh_->cluster(pair.mesh)[pair.nearest].corners, middle);
}

CellPiece ClosestSearch::pieceOf(const Pair& pair, const PartCell& cell) const {
    dvec3 middle;
    const double scale = std::ldexp(1.0, -pair.depth);
    for (int axis = 0; axis < 3; ++axis) {
        const double place = (2.0 * pair.piece[static_cast<std::size_t>(axis)] + 1) * scale - 1;
        middle[axis] = cell.domain[axis] + place * cell.half[axis];
    }
    return {cell.terms, cell.error, cell.middle, middle, scale * cell.half};
}

void ClosestSearch::offerPiece(Pair pair, const PartCell& cell) {
    CellPiece piece = pieceOf(pair, cell);
    if (!piece.mayBeOpaque(part_->intervals) || !searched_->meets(pair.place())) {
        return;
    }
    const dvec3 middle = part_->space.toWorld(piece.middle());
    const dvec3 normal = normalFrom(pair, middle);
    const double size = length(normal);
    if (size > 0) {
        pair.lo = std::max(pair.lo, safe((piece.least(part_->space, normal) - corners_.reach(normal)) / size));
    }
    if (!closes(pair.lo)) {
        push(pair);
    }
}

namespace {

/// A piece along a normal.
struct Along {
    Along() = default;
    Along(const CellPiece& piece, const VolumeSpace& space, const dvec3& chosen)
        : normal(chosen), least(piece.least(space, chosen)), size(length(chosen)) {}

    /// How far a triangle is apart from it, at least.
    [[nodiscard]] double from(const WorldTriangle& corners) const {
        return size > 0 ? (least - farthestAlong(normal, corners)) / size : 0;
    }

    dvec3 normal{};
    double least = 0;
    double size = 0;
};

} // namespace

void ClosestSearch::openLeaf(const Pair& pair) {
    const PartCell cell = part_->cell(*volume_, pair.node);
    CellPiece piece = pieceOf(pair, cell);
    if (!piece.mayBeOpaque(part_->intervals)) {
        return;
    }
    const Seen seen = look(pair, cell, piece);
    const dvec3 ascent = piece.ascent(part_->space);
    std::array<Along, 4> along{Along(piece, part_->space, seen.normal), Along(piece, part_->space, ascent),
                               Along(piece, part_->space, -ascent), Along()};
    const dvec3 middle = part_->space.toWorld(piece.middle());
    Pair child = pair;
    const bool left = keep(child, [&](const PlacedTriangle& triangle) {
        double lo = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            lo = std::max(lo, safe(along[i].from(triangle.corners)));
            if (lo >= cut()) {
                return lo;
            }
        }
        // Triangles that share the closest corner are seen along the same normal.
        const dvec3 normal = middle - closestPoint(triangle.corners, middle);
        if (normal != along[3].normal) {
            along[3] = Along(piece, part_->space, normal);
        }
        return std::max(lo, safe(along[3].from(triangle.corners)));
    });
    if (!left) {
        return;
    }
    const bool inDoubt = !piece.someOpaque(part_->intervals);
    const double diameter = 2 * length(part_->space.spacing * piece.half());
    if (pair.depth == kMostDepth || (inDoubt && (piece.isFlat() || diameter < goal_.finest))) {
        found_.lo = std::min(found_.lo, child.lo);
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

void ClosestSearch::offerPoint(std::uint32_t triangle, double distance, const dvec3& onMesh, const dvec3& inVolume) {
    const double hi = distance * (1 + kDistanceError) + error_;
    if (hi < found_.hi) {
        found_.hi = hi;
        found_.triangle = triangle;
        found_.onMesh = onMesh;
        found_.inVolume = inVolume;
    }
}

/// Goes from the triangle to the opaque part and back, each time to about the closest point.
ClosestSearch::Seen ClosestSearch::look(const Pair& pair, const PartCell& cell, const CellPiece& piece) {
    constexpr int kMostTurns = 4;
    const VolumeSpace& space = part_->space;
    const PlacedTriangle& triangle = mesh_->cluster(pair.mesh)[pair.nearest];
    dvec3 onMesh = closestPoint(triangle.corners, space.toWorld(piece.middle()));
    Seen seen;
    seen.distance = kInfinity;
    const std::optional<CellRegion> region = searched_->region(cell, pair.place());
    if (!region) {
        return seen;
    }
    CellRegion from{2.0 * (piece.middle() - piece.half() - cell.middle),
                    2.0 * (piece.middle() + piece.half() - cell.middle)};
    bool certain = false;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        dvec3 at = glm::clamp(2.0 * (space.toVoxel(onMesh) - cell.middle), from.lo, from.hi);
        const bool opaque = goToOpaque(*part_, cell, *region, at);
        const dvec3 point = space.toWorld(cell.middle + 0.5 * at);
        onMesh = closestPoint(triangle.corners, point);
        const double distance = glm::distance(point, onMesh);
        if (opaque) {
            certain = true;
            offerPoint(pair.mesh * kClusterTriangles + pair.nearest, distance, onMesh, point);
        }
        if (!(distance < seen.distance - goal_.tolerance / 8)) {
            break;
        }
        seen = {point - onMesh, distance};
        from = *region;
    }
    if (!certain) {
        lookBetween(pair, cell, piece);
    }
    return seen;
}

/// An opaque point on the way from one corner of a piece to another, by the values at these alone: no point of it is
/// farther from the triangle than the farther end.
void ClosestSearch::lookBetween(const Pair& pair, const PartCell& cell, const CellPiece& piece) {
    constexpr int kMostHalvings = 24;
    if (!part_->intervals.certainlyMeet(piece.lo() + 2 * cell.error, piece.hi() - 2 * cell.error)) {
        return;
    }
    const VolumeSpace& space = part_->space;
    const PlacedTriangle& triangle = mesh_->cluster(pair.mesh)[pair.nearest];
    dvec3 ends[2];
    double values[2] = {kInfinity, -kInfinity};
    for (unsigned i = 0; i < 8; ++i) {
        const dvec3 sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
        const dvec3 at = 2.0 * (piece.middle() + sign * piece.half() - cell.middle);
        const double value = valueAt(cell.terms, at);
        if (value < values[0]) {
            values[0] = value;
            ends[0] = at;
        }
        if (value > values[1]) {
            values[1] = value;
            ends[1] = at;
        }
    }
    const auto crosses = [&](double lo, double hi) {
        return part_->intervals.certainlyMeet(lo + cell.error, hi - cell.error);
    };
    if (!crosses(values[0], values[1])) {
        return;
    }
    for (int step = 0; step < kMostHalvings; ++step) {
        const dvec3 middle = 0.5 * (ends[0] + ends[1]);
        const double value = valueAt(cell.terms, middle);
        const std::size_t replaced = crosses(values[0], value) ? 1 : 0;
        if (replaced == 0 && !crosses(value, values[1])) {
            break;
        }
        ends[replaced] = middle;
        values[replaced] = value;
    }
    double farthest = 0;
    for (const dvec3& end : ends) {
        const dvec3 point = space.toWorld(cell.middle + 0.5 * end);
        farthest = std::max(farthest, glm::distance(point, closestPoint(triangle.corners, point)));
    }
    const dvec3 point = space.toWorld(cell.middle + 0.25 * (ends[0] + ends[1]));
    offerPoint(pair.mesh * kClusterTriangles + pair.nearest, farthest, closestPoint(triangle.corners, point), point);
}

} // namespace voxtact::cpu

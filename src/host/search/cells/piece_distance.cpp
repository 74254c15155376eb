// SPDX-License-Identifier: MIT
#include "host/search/cells/piece_distance.h"
#include "core/base/infinity.h"
#include "host/search/nearest_point.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// A place in a cell, and the interpolant there.
struct PlacedValue {
    dvec3 at{};
    double value = 0;
};

/// The corners of a piece with the minimum and maximum value.
std::array<PlacedValue, 2> extremes(const PartCell& cell, const CellPiece& piece) {
    std::array<PlacedValue, 2> ends{PlacedValue{{}, kInfinity}, PlacedValue{{}, -kInfinity}};
    for (unsigned i = 0; i < 8; ++i) {
        const dvec3 sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
        const dvec3 at = 2.0 * (piece.middle() + sign * piece.half() - cell.middle);
        const double value = valueAt(cell.terms, at);
        if (value < ends[0].value) {
            ends[0] = {at, value};
        }
        if (value > ends[1].value) {
            ends[1] = {at, value};
        }
    }
    return ends;
}

/// Two places in a cell. Where it is certain(), there is an opaque point on the way between them, by the values at
/// these alone.
struct Bracket {
    const PartCell& cell;
    const OpaqueIntervals& intervals;
    std::array<PlacedValue, 2> ends;

    [[nodiscard]] bool certain() const { return crosses(ends[0], ends[1]); }
    /// Moves to half of the distance; false if no point is certain. Stays near the middle if its value is too close to
    /// an interval's end to tell on which side the opaque point is.
    bool halve() {
        const PlacedValue middle = at(0.5);
        for (const std::array<PlacedValue, 2>& half :
             {std::array{ends[0], middle}, {middle, ends[1]}, {at(0.25), at(0.75)}}) {
            if (crosses(half[0], half[1])) {
                ends = half;
                return true;
            }
        }
        return false;
    }

  private:
    [[nodiscard]] PlacedValue at(double part) const {
        const dvec3 place = glm::mix(ends[0].at, ends[1].at, part);
        return {place, valueAt(cell.terms, place)};
    }
    [[nodiscard]] bool crosses(const PlacedValue& lo, const PlacedValue& hi) const {
        return intervals.certainlyMeet(lo.value + cell.error, hi.value - cell.error);
    }
};

} // namespace

CellPiece pieceAt(const PartCell& cell, const PiecePlace& place) noexcept {
    dvec3 middle;
    const double scale = std::ldexp(1.0, -place.depth);
    for (int axis = 0; axis < 3; ++axis) {
        const double at = (2.0 * place.piece[static_cast<std::size_t>(axis)] + 1) * scale - 1;
        middle[axis] = cell.domain[axis] + at * cell.half[axis];
    }
    return {cell.terms, cell.error, cell.middle, middle, scale * cell.half};
}

/// Alternates between triangle and opaque part, each time to about the closest point.
dvec3 PieceDistance::run(const PiecePlace& place, const DistanceError& error, std::uint32_t number,
                         Found& found) const {
    constexpr int kMostTurns = 4;
    const VolumeSpace& space = part_.space;
    dvec3 onMesh = mesh_.near(triangle_, space.toWorld(piece_.middle()));
    dvec3 normal{};
    double nearest = kInfinity;
    const std::optional<CellRegion> region = searched_.region(cell_, place);
    if (!region) {
        return normal;
    }
    CellRegion from{2.0 * (piece_.middle() - piece_.half() - cell_.middle),
                    2.0 * (piece_.middle() + piece_.half() - cell_.middle)};
    bool certain = false;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        dvec3 at = glm::clamp(2.0 * (space.toVoxel(onMesh) - cell_.middle), from.lo, from.hi);
        const bool opaque = goToOpaque(part_, cell_, *region, at);
        const dvec3 point = space.toWorld(cell_.middle + 0.5 * at);
        onMesh = mesh_.near(triangle_, point);
        const double distance = glm::distance(point, onMesh);
        if (opaque) {
            certain = true;
            found.offer(error.above(distance), number, onMesh, point, true);
        }
        if (!(distance < nearest - worthwhile_)) {
            break;
        }
        normal = point - onMesh;
        nearest = distance;
        from = *region;
    }
    if (!certain) {
        between(error, number, found);
    }
    return normal;
}

/// An opaque point on the way from one corner of a piece to another: no point of that way is farther from the triangle
/// than its farther end.
void PieceDistance::between(const DistanceError& error, std::uint32_t number, Found& found) const {
    constexpr int kMostHalvings = 24;
    if (!part_.intervals.certainlyMeet(piece_.lo() + 2 * cell_.error, piece_.hi() - 2 * cell_.error)) {
        return;
    }
    Bracket bracket{cell_, part_.intervals, extremes(cell_, piece_)};
    if (!bracket.certain()) {
        return;
    }
    for (int step = 0; step < kMostHalvings && bracket.halve(); ++step) {
    }
    double farthest = -1;
    dvec3 point{};
    dvec3 onMesh{};
    bool opaque = false;
    for (const PlacedValue& end : bracket.ends) {
        const dvec3 at = part_.space.toWorld(cell_.middle + 0.5 * end.at);
        const dvec3 near = mesh_.near(triangle_, at);
        const bool isIt = part_.intervals.contain(end.value - cell_.error, end.value + cell_.error);
        // An opaque end, else the farther one: an opaque point is at most that far away.
        if (const double distance = glm::distance(at, near); isIt || (!opaque && distance > farthest)) {
            farthest = distance;
            point = at;
            onMesh = near;
            opaque = isIt;
        }
    }
    found.offer(error.above(farthest), number, onMesh, point, opaque);
}

} // namespace voxtact::cpu

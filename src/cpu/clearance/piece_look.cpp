// SPDX-License-Identifier: MIT
#include "cpu/clearance/piece_look.h"
#include "cpu/clearance/nearest_point.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A place in a cell, and the interpolant there.
struct PlacedValue {
    dvec3 at{};
    double value = 0;
};

/// The corners of a piece with the least and the greatest value.
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

/// Goes from the triangle to the opaque part and back, each time to about the closest point.
dvec3 PieceLook::run(const PiecePlace& place, const DistanceError& error, std::uint32_t number, Found& found) const {
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

/// An opaque point on the way from one corner of a piece to another, by the values at these alone: no point of it is
/// farther from the triangle than the farther end.
void PieceLook::between(const DistanceError& error, std::uint32_t number, Found& found) const {
    constexpr int kMostHalvings = 24;
    if (!part_.intervals.certainlyMeet(piece_.lo() + 2 * cell_.error, piece_.hi() - 2 * cell_.error)) {
        return;
    }
    const VolumeSpace& space = part_.space;
    std::array<PlacedValue, 2> ends = extremes(cell_, piece_);
    const auto crosses = [&](double lo, double hi) {
        return part_.intervals.certainlyMeet(lo + cell_.error, hi - cell_.error);
    };
    if (!crosses(ends[0].value, ends[1].value)) {
        return;
    }
    const auto between = [&](double part) {
        const dvec3 at = glm::mix(ends[0].at, ends[1].at, part);
        return PlacedValue{at, valueAt(cell_.terms, at)};
    };
    // Half of the way, or the half around its middle, where the value is too near to an interval's end to tell.
    const auto halves = [&] {
        const PlacedValue middle = between(0.5);
        if (crosses(ends[0].value, middle.value)) {
            ends[1] = middle;
            return true;
        }
        if (crosses(middle.value, ends[1].value)) {
            ends[0] = middle;
            return true;
        }
        const std::array<PlacedValue, 2> around{between(0.25), between(0.75)};
        if (crosses(around[0].value, around[1].value)) {
            ends = around;
            return true;
        }
        return false;
    };
    for (int step = 0; step < kMostHalvings && halves(); ++step) {
    }
    // The farther end is as far as is offered, and as near to the opaque point as the other.
    double farthest = -1;
    dvec3 point{};
    dvec3 onMesh{};
    for (const PlacedValue& end : ends) {
        const dvec3 at = space.toWorld(cell_.middle + 0.5 * end.at);
        const dvec3 near = mesh_.near(triangle_, at);
        if (const double distance = glm::distance(at, near); distance > farthest) {
            farthest = distance;
            point = at;
            onMesh = near;
        }
    }
    found.offer(error.above(farthest), number, onMesh, point, false);
}

} // namespace voxtact::cpu

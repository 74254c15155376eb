// SPDX-License-Identifier: MIT
#include "host/motion/pose_tolerance.h"
#include "core/base/infinity.h"
#include "core/geometry/glm_bridge.h"
#include "host/motion/divided_mesh.h"
#include "host/search/workers.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::cpu {

namespace {

using glm::dmat4;
using glm::dvec3;

/// mm: stop when upper - lower is at most this.
constexpr double kFinest = kDefaultTolerance / 4;
constexpr double kRounding = 0x1p-40;
/// mm: a point that is so near may be met, and that is tried.
constexpr double kEnough = 1e-6;
/// Relative to the largest coordinate, mm: the rounding of a few dozen operations.
constexpr double kRelativeError = 0x1p-44;

/// Upper bound of the mesh's coordinates and their terms.
double magnitudeOf(const PairAt& at) {
    const Box& bounds = at.mesh().facts.bounds;
    const dmat4 pose = toGlm(at.world_from_object);
    double sum = glm::length(dvec3(pose[3]));
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        sum += glm::length(dvec3(pose[axis])) * std::max(std::abs(bounds.lo[i]), std::abs(bounds.hi[i]));
    }
    return sum;
}

} // namespace

PoseToleranceSearch::PoseToleranceSearch(const PairAt& at, const MeshImpl* divided, const PoseTolerance& tolerance,
                                         std::uint64_t maxSteps, ThreadMemory& memory)
    : at_(at), divided_(divided), distance_(tolerance.distance), angle_(glm::radians(tolerance.angle)),
      maxSteps_(maxSteps), memory_(memory),
      origin_(dvec3(at.world_from_object[12], at.world_from_object[13], at.world_from_object[14]) -
              at.part.space.middle) {}

void PoseToleranceSearch::run(PairTouch& out) const {
    std::optional<TouchPoint> point;
    const CertifiedTally touch = at_.touch(point);
    if (touch.certain > 0) {
        out.touch = Verdict::Yes;
        return;
    }
    Sweep sweep;
    sweep.centre = origin_ + at_.part.space.middle;
    // Rounded up, so a rotation by exactly the angle is included.
    sweep.turn = std::min(angle_ * (1 + kRounding), glm::pi<double>());
    const double magnitude = magnitudeOf(at_);
    const double ofMesh = magnitude - glm::length(dvec3(toGlm(at_.world_from_object)[3])); // current object of division
    sweep.slack = distance_ * (1 + kRounding) + kRelativeError * magnitude + at_.deflection() +
                  (divided_ != nullptr ? kDividedError * (ofMesh + kRelativeError * magnitude) : 0);
    PairAt pieces = at_;
    pieces.shape = divided_ != nullptr ? divided_ : at_.shape;
    const Found swept = pieces.search(memory_,
                                      {.tolerance = 0,
                                       .maximum = std::numeric_limits<double>::denorm_min(),
                                       .enough = kEnough,
                                       .finest = kFinest,
                                       .maxSteps = maxSteps_,
                                       .untilMet = true},
                                      sweep);
    if (swept.lo > 0) {
        out.touch = Verdict::No;
        return;
    }
    const bool hit = isReached(swept);
    out.touch = hit ? Verdict::Yes : Verdict::Undecided;
}

/// By the search's witness points, or the closest points of the pair.
bool PoseToleranceSearch::isReached(const Found& swept) const {
    const auto triangleOf = [this](const Found& found) {
        return memory_.mesh.triangle(found.triangle / kClusterTriangles, found.triangle % kClusterTriangles);
    };
    const bool isMet = swept.hi < kInfinity;
    const dvec3 onMesh = isMet ? memory_.mesh.nearest(triangleOf(swept), swept.inVolume) : dvec3(0);
    if (isMet && touches(onMesh, swept.inVolume)) {
        return true;
    }
    const Found still = at_.search(
        memory_, {.tolerance = kDefaultTolerance, .enough = kEnough, .finest = kFinest, .maxSteps = maxSteps_});
    if (still.hi == kInfinity) {
        return false;
    }
    const dvec3 nearest = still.inVolume - still.onMesh;
    if (touches(still.onMesh, still.inVolume) || touchesAlong(still.onMesh, nearest)) {
        return true;
    }
    if (isMet && (touchesAlong(onMesh, nearest) || touchesAlong(onMesh, swept.inVolume - onMesh))) {
        return true;
    }
    const PlacedTriangle triangle = triangleOf(still);
    return std::any_of(triangle.corners.begin(), triangle.corners.end(),
                       [&](const dvec3& corner) { return touchesAlong(corner, nearest); });
}

/// Rotates and translates a point along a direction: as far as allowed, then less far.
bool PoseToleranceSearch::touchesAlong(const dvec3& onMesh, const dvec3& direction) const {
    const dvec3 arm = onMesh - origin_;
    const dvec3 axis = glm::cross(arm, direction);
    const double size = glm::length(axis);
    const double whole = size > 0 ? std::min(std::atan2(size, glm::dot(arm, direction)), angle_ * (1 - kRounding)) : 0;
    const double length = glm::length(direction);
    const double far = length > 0 ? distance_ * (1 - kRounding) / length : 0;
    for (const double part : {1.0, 0.75, 0.5, 0.25}) {
        const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(part * whole, size > 0 ? axis / size : dvec3(0, 0, 1)));
        if (touchesAt(turn, part * far * direction)) {
            return true;
        }
    }
    return false;
}

bool PoseToleranceSearch::touchesAt(const glm::dmat3& turn, const dvec3& offset) const {
    dmat4 pose = toGlm(at_.world_from_object);
    for (int column = 0; column < 3; ++column) {
        pose[column] = glm::dvec4(turn * dvec3(pose[column]), 0);
    }
    pose[3] += glm::dvec4(offset, 0);
    std::optional<TouchPoint> point;
    return PairAt{at_.item, at_.part, fromGlm(pose), at_.cancel}.touch(point).certain > 0;
}

/// Rotates the point towards the other, translates it there as far as allowed, and further into the opaque region.
bool PoseToleranceSearch::touches(const dvec3& onMesh, const dvec3& inVolume) const {
    const dvec3 arm = onMesh - origin_;
    const dvec3 wanted = inVolume - origin_;
    const dvec3 axis = glm::cross(arm, wanted);
    const double size = glm::length(axis);
    const double most = angle_ * (1 - kRounding);
    const double angle = size > 0 ? std::min(std::atan2(size, glm::dot(arm, wanted)), most) : 0;
    const double little = std::min(angle + kDefaultTolerance / std::max(glm::length(arm), kDefaultTolerance), most);
    const dvec3 about = size > 0 ? axis / size : dvec3(0, 0, 1);
    for (const double by : {angle, little, 0.5 * (angle + most), most}) {
        if (touchesTurned(glm::mat3_cast(glm::angleAxis(by, about)), arm, wanted)) {
            return true;
        }
    }
    return false;
}

bool PoseToleranceSearch::touchesTurned(const glm::dmat3& turn, const dvec3& arm, const dvec3& wanted) const {
    const dvec3 way = wanted - turn * arm;
    const double far = glm::length(way);
    const dvec3 whole = wanted - arm;
    const dvec3 towards = far > 0 ? way : whole;
    const double size = glm::length(towards);
    const dvec3 direction = size > 0 ? towards / size : dvec3(0);
    const double most = distance_ * (1 - kRounding);
    for (const double by : {std::min(far, most), std::min(far + kDefaultTolerance, most), most}) {
        if (touchesAt(turn, by * direction)) {
            return true;
        }
    }
    return false;
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#include "detect/results/unpack.h"
#include "core/geometry/closest_gradient.h"

namespace voxtact {

namespace {

/// A PairClearance or a LabelClearance.
template <class Clearance>
Clearance unpackClearance(const PairResult& pair, const ClearanceResult& found, double maximum) {
    Clearance out;
    out.pair = pair.pair;
    out.item = pair.item;
    out.pose = pair.pose;
    out.bounds = {static_cast<double>(found.lo), static_cast<double>(found.hi)};
    out.end = static_cast<ClearanceEnd>(found.end);
    if (out.end == ClearanceEnd::Beyond) {
        out.bounds.lo = maximum; // a float is not less
    }
    return out;
}

Vec3 vector(float x, float y, float z) {
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

} // namespace

PairClearance unpackPair(const PairResult& pair, const ClearanceResult& found, double maximum) {
    return unpackClearance<PairClearance>(pair, found, maximum);
}

LabelClearance unpackLabel(const PairResult& pair, const ClearanceResult& found, double maximum, std::int32_t label) {
    LabelClearance out = unpackClearance<LabelClearance>(pair, found, maximum);
    out.label = label;
    return out;
}

ClosestPoints unpack(const ClosestResult& found) {
    const Vec3 way = vector(found.wayX, found.wayY, found.wayZ);
    const Vec3 arm = vector(found.armX, found.armY, found.armZ);
    ClosestPoints out;
    out.triangle = found.triangle;
    out.mesh = vector(found.x, found.y, found.z);
    out.volume = step(out.mesh, way, 1);
    setGradient(out, way, arm);
    return out;
}

SegmentMotion unpack(const PairResult& pair, const MotionResult& found, const RigidMotion& motion) {
    SegmentMotion out;
    out.item = pair.item;
    out.pose = pair.pose;
    out.freeUntil = static_cast<double>(found.freeUntil);
    out.end = static_cast<MotionEnd>(found.end);
    if (const auto at = static_cast<double>(found.touchAt); at <= 1) {
        out.touch = MotionTouch{at, motion.at(at), vector(found.x, found.y, found.z), found.triangle};
    }
    out.possible = !out.touch && out.freeUntil < 1;
    return out;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "host/plan/path_measure.h"

#include "core/base/infinity.h"
#include "core/geometry/glm_bridge.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

} // namespace

PathMeasure::Way PathMeasure::wayOf(const EntryPoint& entry) const {
    const dvec3 direction = scene_.grid.direction(entry.number);
    Way way;
    if (scene_.task.mesh) {
        way.sweep.emplace();
        way.world_from_object = scene_.meshPose(direction, entry.length, *way.sweep);
    } else {
        way.world_from_object = scene_.axisPose(direction, entry.length);
    }
    return way;
}

/// Distances are those of the axis, or of the mesh.
Found PathMeasure::search(const Way& way, std::size_t obstacle, SearchGoal goal) {
    const Obstacle& of = scene_.obstacles[obstacle];
    const Mesh& mesh = scene_.task.mesh ? *scene_.task.mesh->mesh : scene_.axis;
    goal.measures = way.sweep.has_value();
    goal.known = way.sweep ? std::nullopt : known_[obstacle];
    const BatchItem item{&mesh, of.given->volume, nullptr, {}};
    Found found =
        PairAt{item, *of.part, way.world_from_object, &scene_.cancel}.search(memory_, of.searched(), goal, way.sweep);
    if (found.isOpaque && found.hi < kInfinity) {
        known_[obstacle] = found.inVolume;
    }
    return found;
}

/// Keeps the point if it is nearer than all earlier ones.
void PathMeasure::take(const Found& found, std::size_t obstacle, PlannedPath& out) const {
    const double hi = found.hi - scene_.radius + scene_.slack;
    if (!(hi < out.clearance.upper)) {
        return;
    }
    const Obstacle& of = scene_.obstacles[obstacle];
    out.clearance.upper = std::max(hi, 0.0);
    NearestObstacle nearest;
    nearest.obstacle = static_cast<std::uint32_t>(obstacle);
    nearest.label = of.labelAt(found.inVolume);
    nearest.position = fromGlm(found.inVolume + of.part->space.middle);
    nearest.onPath = fromGlm(found.onMesh + of.part->space.middle);
    out.nearest = nearest;
}

void PathMeasure::measure(const Way& way, PlannedPath& out) {
    const Plan& desc = scene_.task;
    out.clearance = {kInfinity, kInfinity};
    bool exhausted = false;
    for (std::size_t i = 0; i < scene_.obstacles.size() && out.clearance.upper > 0; ++i) {
        const double maximum = std::min(desc.maximum, out.clearance.upper) + scene_.radius + scene_.slack;
        const Found found = search(way, i,
                                   {.tolerance = desc.tolerance,
                                    .maximum = maximum,
                                    .enough = std::max(scene_.radius - scene_.slack, 0.0),
                                    .finest = desc.tolerance / 4,
                                    .maxSteps = desc.maxSteps});
        take(found, i, out);
        exhausted = exhausted || found.exhausted;
        const double lo = std::min(found.lo, maximum) - scene_.radius - scene_.slack;
        out.clearance.lower = std::min(out.clearance.lower, std::max(lo, 0.0));
    }
    out.clearance.lower = std::min(out.clearance.lower, out.clearance.upper);
    // Beyond the maximum there is no result, found or not.
    if (out.clearance.lower >= desc.maximum - 2 * scene_.slack) {
        out.clearance = {std::min(out.clearance.lower, desc.maximum), kInfinity};
        out.nearest.reset();
        out.end = StopReason::Beyond;
    } else {
        out.end = endOf(out.clearance, exhausted);
    }
}

StopReason PathMeasure::endOf(const Bounds& clearance, bool exhausted) const {
    if (clearance.upper == kInfinity) {
        return StopReason::Beyond;
    }
    if (clearance.upper - clearance.lower <= scene_.task.tolerance + 4 * scene_.slack) {
        return StopReason::Closed;
    }
    return exhausted ? StopReason::Budget : StopReason::Rounding;
}

/// The margin is between the bounds: searches for it only.
void PathMeasure::decide(const Way& way, PlannedPath& out) {
    const double wanted = scene_.margin + scene_.radius;
    double lo = kInfinity;
    bool exhausted = out.end == StopReason::Budget;
    std::size_t i = 0;
    for (; i < scene_.obstacles.size() && out.clearance.upper > scene_.margin; ++i) {
        const Found found = search(way, i,
                                   {.tolerance = 0,
                                    .maximum = wanted + 4 * scene_.slack,
                                    .enough = wanted - scene_.slack,
                                    .finest = std::min(scene_.task.tolerance, kDefaultTolerance) / 4,
                                    .maxSteps = scene_.task.maxSteps});
        take(found, i, out);
        lo = std::min(lo, found.lo - scene_.radius - scene_.slack);
        exhausted = exhausted || found.exhausted;
    }
    // Labels that were not requested do not affect the distance.
    if (i == scene_.obstacles.size()) {
        out.clearance.lower = std::max(out.clearance.lower, lo);
    }
    out.clearance.lower = std::min(out.clearance.lower, out.clearance.upper);
    out.end = endOf(out.clearance, exhausted);
}

void PathMeasure::run(const EntryPoint& entry, PlannedPath& out) {
    out.entry = entry.number;
    out.position = fromGlm(entry.position);
    out.length = entry.length;
    out.angle = entry.angle;
    const Way way = wayOf(entry);
    measure(way, out);
    if (out.clearance.lower <= scene_.margin && out.clearance.upper > scene_.margin) {
        decide(way, out);
    }
    out.safety = out.clearance.lower > scene_.margin    ? Safety::Safe
                 : out.clearance.upper <= scene_.margin ? Safety::Unsafe
                                                        : Safety::Undecided;
}

} // namespace voxtact::cpu

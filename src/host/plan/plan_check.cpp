// SPDX-License-Identifier: MIT
#include "host/plan/plan_check.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/facts/facts.h"
#include "host/host_engine.h"
#include "host/search/label_part.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

constexpr double kFarthest = 1e9; // mm

bool isFinite(const Vec3& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Farther away, coordinates are too coarse: they have steps above a tenth of a micrometre.
bool isPlace(const Vec3& v) {
    return isFinite(v) && std::hypot(v[0], v[1], v[2]) <= kFarthest;
}

Result<void> checkThreshold(double threshold, const std::string& which) {
    return threshold >= 0 && threshold <= 1
               ? Result<void>()
               : refuse(which + ": the threshold " + number(threshold) + " is outside of 0 to 1");
}

Result<void> checkObstacle(const PlanObstacle& obstacle, const std::string& which) {
    if (obstacle.volume == nullptr) {
        return refuse(which + ": volume is null");
    }
    if (obstacle.labels == nullptr) {
        return obstacle.transferFunction == nullptr
                   ? refuse(which + ": transferFunction and labels are both null; one says what is avoided")
                   : checkThreshold(obstacle.threshold, which);
    }
    VOXTACT_TRY(checkLabels(*obstacle.labels));
    VOXTACT_TRY(checkLabelsOnGrid(*obstacle.labels, obstacle.volume->grid(), which));
    if (obstacle.avoid.empty()) {
        return refuse(which + ": there is a label map, and none of its labels is to be avoided");
    }
    for (const std::int32_t label : obstacle.avoid) {
        if (!std::ranges::binary_search(obstacle.labels->values, label)) {
            return refuse(which + ": the label " + std::to_string(label) +
                          " is to be avoided, which the label map has not");
        }
    }
    return checkThreshold(obstacle.threshold, which);
}

Result<void> checkSurface(const EntrySurface& surface) {
    if (surface.entries == 0) {
        return refuse("the entries' surface: entries is 0, one is the least");
    }
    if (surface.entries > kMaxEntries) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(surface.entries) + " entries are asked for, there can be up to " +
                         std::to_string(kMaxEntries)};
    }
    if (surface.volume != nullptr && surface.labels != nullptr) {
        return refuse("the entries' surface: volume and labels are both given; one says where it is");
    }
    if (surface.volume != nullptr) {
        return surface.transferFunction == nullptr
                   ? refuse("the entries' surface: transferFunction is null, and a volume is given")
                   : checkThreshold(surface.threshold, "the entries' surface");
    }
    if (surface.labels != nullptr) {
        VOXTACT_TRY(checkLabels(*surface.labels));
        return std::ranges::binary_search(surface.labels->values, surface.label)
                   ? Result<void>()
                   : refuse("the entries' surface: the label map has no label " + std::to_string(surface.label));
    }
    return surface.radius > kNearestEntry && std::isfinite(surface.radius)
               ? Result<void>()
               : refuse("the entries' surface: neither volume nor labels are given, and the radius " +
                        number(surface.radius) + " mm is not above " + number(kNearestEntry));
}

Result<void> checkInstrument(const Plan& task) {
    if (!task.mesh) {
        const Needle& needle = task.needle;
        return needle.diameter > 0 && needle.length >= needle.diameter && std::isfinite(needle.length)
                   ? Result<void>()
                   : refuse("the needle: a diameter of " + number(needle.diameter) + " mm and a length of " +
                            number(needle.length) +
                            " mm: the first must be above 0, and the second no smaller than that");
    }
    if (task.mesh->mesh == nullptr) {
        return refuse("the instrument: mesh is null");
    }
    if (!isPlace(task.mesh->tip)) {
        return refuse("the instrument: the tip is not within " + number(kFarthest) + " mm of the origin");
    }
    if (!isFinite(task.mesh->axis)) {
        return refuse("the instrument: the axis is not finite");
    }
    const Vec3& axis = task.mesh->axis;
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    return length > 0 && std::isfinite(length) ? Result<void>()
                                               : refuse("the instrument: its axis has no length; say where it points");
}

} // namespace

Result<void> checkPlan(const Plan& task) {
    VOXTACT_TRY(checkFact(factOf("plan", "tolerance"), task.tolerance));
    VOXTACT_TRY(checkFact(factOf("plan", "max"), task.maximum));
    VOXTACT_TRY(checkSteps(task.maxSteps));
    if (!isPlace(task.target)) {
        return refuse("the target is not within " + number(kFarthest) + " mm of the origin");
    }
    if (task.obstacles.empty()) {
        return refuse("there are no obstacles: nothing is to be avoided");
    }
    for (std::size_t i = 0; i < task.obstacles.size(); ++i) {
        const PlanObstacle& obstacle = task.obstacles[i];
        VOXTACT_TRY(checkObstacle(obstacle, obstacle.name.empty() ? "obstacle " + std::to_string(i) : obstacle.name));
    }
    VOXTACT_TRY(checkSurface(task.surface));
    VOXTACT_TRY(checkInstrument(task));
    VOXTACT_TRY(checkFact(factOf("plan", "margin"), task.margin));
    if (task.longest) {
        VOXTACT_TRY(checkFact(factOf("plan", "max_length"), *task.longest));
    }
    return task.steepest ? checkFact(factOf("plan", "max_angle"), *task.steepest) : Result<void>();
}

} // namespace voxtact::cpu

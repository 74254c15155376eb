// SPDX-License-Identifier: MIT
#pragma once

#include "host/plan/direction_grid.h"
#include "host/search/workers.h"
#include "voxtact/plan.h"

#include <glm/vec3.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// An obstacle in the form of a search.
struct Obstacle {
    const PlanObstacle* given = nullptr;
    std::shared_ptr<const OpaquePart> part;
    std::optional<LabelSet> labels; ///< labels of the part that are obstacles; none: all

    [[nodiscard]] SearchedPart searched() const {
        return labels ? SearchedPart(*labels, *given->labels) : SearchedPart(*part);
    }
    /// Returns the label at a point of the obstacle, local; on a face between two labels, one to avoid.
    [[nodiscard]] std::int32_t labelAt(const glm::dvec3& local) const;
};

/// Entry point of a direction.
struct EntryPoint {
    std::uint32_t number = 0; ///< of the direction
    bool isThere = false;
    bool isOnBorder = false;     ///< left out for that
    glm::dvec3 position{};       ///< world
    double length = 0;           ///< mm, from the target
    std::optional<double> angle; ///< degrees, between the direction and the surface's normal
};

/// A task, ready to be searched.
struct PlanScene {
    const Plan& task;
    const Cancellation& cancel; ///< of this call
    DirectionGrid grid;
    std::vector<Obstacle> obstacles;
    std::vector<EntryPoint> entries; ///< by the number of their direction
    Mesh axis;                       ///< a line from the object's origin to (0, 0, 1)
    double radius = 0;               ///< mm, of the needle; 0 of a mesh
    double margin = 0;               ///< mm; never 0
    double slack = 0;                ///< mm: by so much a computed way may be off

    /// The piece of the needle's axis that it covers on its way: from there to there, mm from the target.
    [[nodiscard]] double axisBegin() const { return radius; }
    [[nodiscard]] double axisEnd(double entry) const { return entry + task.needle.length - radius; }
    /// world_from_object of `axis` along a direction.
    [[nodiscard]] Mat4 axisPose(const glm::dvec3& direction, double entry) const;
    /// Position of the mesh at the middle of its path, and its motion.
    [[nodiscard]] Mat4 meshPose(const glm::dvec3& direction, double entry, Sweep& sweep) const;
    [[nodiscard]] bool givenUp() const { return cancel.seen(); }
};

} // namespace voxtact::cpu

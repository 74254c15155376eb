// SPDX-License-Identifier: MIT
#pragma once

#include "host/plan/plan_scene.h"

namespace voxtact::cpu {

/// Measures distances of paths from obstacles, one after the other, on one thread: tests the obstacle nearest to the
/// last path first.
class PathMeasure {
  public:
    /// Both must outlive it.
    PathMeasure(const PlanScene& scene, ThreadMemory& memory)
        : scene_(scene), memory_(memory), known_(scene.obstacles.size()) {}

    void run(const EntryPoint& entry, PlannedPath& out);

  private:
    struct Way {
        Mat4 world_from_object{};
        std::optional<Sweep> sweep;
    };
    [[nodiscard]] Way wayOf(const EntryPoint& entry) const;
    [[nodiscard]] Found search(const Way& way, std::size_t obstacle, SearchGoal goal);
    void measure(const Way& way, PlannedPath& out);
    void decide(const Way& way, PlannedPath& out);
    /// Returns why the search stopped, for bounds below the maximum or infinite ones.
    [[nodiscard]] StopReason endOf(const Bounds& clearance, bool exhausted) const;
    void take(const Found& found, std::size_t obstacle, PlannedPath& out) const;

    const PlanScene& scene_;
    ThreadMemory& memory_;
    std::vector<std::optional<glm::dvec3>> known_; ///< of each obstacle a point, local to its volume
};

} // namespace voxtact::cpu

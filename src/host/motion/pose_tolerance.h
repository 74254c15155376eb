// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/pair_at.h"
#include "voxtact/motion.h"

namespace voxtact::cpu {

/// Decides on one thread whether a mesh touches at some pose within an uncertainty.
///
/// No: the mesh, swept over all these poses (Sweep), is apart from the opaque region. Yes: one of a few poses, which
/// move a point of the mesh to a near opaque point, touches.
class PoseToleranceSearch {
  public:
    /// All must live as long as it. `divided`: dividedMesh() of the pair's mesh; null where that is, or for a tolerance
    /// without an angle.
    PoseToleranceSearch(const PairAt& at, const MeshImpl* divided, const PoseTolerance& tolerance,
                        std::uint64_t maxSteps, ThreadMemory& memory);

    void run(PairTouch& out) const;

  private:
    [[nodiscard]] bool isReached(const Found& swept) const;
    [[nodiscard]] bool touches(const glm::dvec3& onMesh, const glm::dvec3& inVolume) const;
    [[nodiscard]] bool touchesTurned(const glm::dmat3& turn, const glm::dvec3& arm, const glm::dvec3& wanted) const;
    [[nodiscard]] bool touchesAlong(const glm::dvec3& onMesh, const glm::dvec3& direction) const;
    [[nodiscard]] bool touchesAt(const glm::dmat3& turn, const glm::dvec3& offset) const;

    const PairAt& at_;
    const MeshImpl* divided_;
    double distance_; ///< mm
    double angle_;    ///< radians
    std::uint64_t maxSteps_;
    ThreadMemory& memory_;
    glm::dvec3 origin_; ///< of the object, local
};

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/open_session.h"
#include "cli/plan/plan_run.h"
#include "voxtact/render.h"

#include <functional>
#include <vector>

namespace voxtact::app {

/// Triangles of one colour, world mm.
struct ColouredMesh {
    MeshData mesh;
    Colour colour{};
};

/// The triangles between the entries by their colours: safe ones by the minimum distance of their corners. Only those
/// whose middle is `kept`, slightly in front of their surface.
[[nodiscard]] std::vector<ColouredMesh> entryMeshes(const PlanInputs& inputs, const TargetPlan& plan, double maximum,
                                                    const std::function<bool(const Vec3&)>& kept);
/// Returns the needle with its tip at the target, or its visible part; for a mesh, the mesh.
[[nodiscard]] Result<ColouredMesh> instrumentMesh(const PlanInputs& inputs, const TargetPlan& plan,
                                                  const PlannedPath& path);
/// Returns the voxels of avoided labels at a cut through a point; the part in front of it along the normal is removed.
/// Without triangles there are none.
[[nodiscard]] ColouredMesh avoidedMesh(const PlanInputs& inputs, const Vec3& point, const Vec3& normal);

/// The best of all paths, twice beside each other: along it from outside, and the head cut open at it. Without a safe
/// path, the first target's entries. The inputs were read for a picture.
[[nodiscard]] Result<Picture> planPicture(const PlanOptions& options, const PlanInputs& inputs,
                                          std::span<const TargetPlan> plans, const device::Session& session);

} // namespace voxtact::app

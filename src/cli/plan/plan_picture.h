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

/// Returns the triangles between the entries by colour: safe triangles by the minimum distance of their corners.
/// Returns only triangles whose middle is `kept`, slightly in front of their surface.
[[nodiscard]] std::vector<ColouredMesh> entryMeshes(const PlanInputs& inputs, const TargetPlan& plan, double maximum,
                                                    const std::function<bool(const Vec3&)>& kept);
/// Returns the needle with its tip at the target, or its visible part; for a mesh, the mesh.
[[nodiscard]] Result<ColouredMesh> instrumentMesh(const PlanInputs& inputs, const TargetPlan& plan,
                                                  const PlannedPath& path);
/// Returns the voxels of avoided labels at a cut through a point; the part in front of it along the normal is removed.
/// Without triangles there are none.
[[nodiscard]] ColouredMesh avoidedMesh(const PlanInputs& inputs, const Vec3& point, const Vec3& normal);

/// Paints the best of all paths twice, side by side: from outside along the path, and with the head cut open at the
/// path. Without a safe path, paints the entries of the first target. Needs inputs that were read for a picture.
[[nodiscard]] Result<Picture> planPicture(const PlanOptions& options, const PlanInputs& inputs,
                                          std::span<const TargetPlan> plans, const device::Session& session);

} // namespace voxtact::app

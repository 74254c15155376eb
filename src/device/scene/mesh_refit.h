// SPDX-License-Identifier: MIT
#pragma once

#include "device/scene/scene_impl.h"

namespace voxtact {

/// Makes what the pass needs that fits the clusters of a mesh to its vertices: for meshes with clusters that shaders
/// can read as storage.
[[nodiscard]] Result<void> makeRefit(MeshImpl& mesh);

/// Records that pass, between barriers of the caller's. Loses the compute pipeline, the descriptor sets of the compute
/// bind point and the push constants.
void cmdFitClusters(const MeshImpl& mesh, VkCommandBuffer commandBuffer);

/// The same with barriers: earlier commands that wrote the buffers of the mesh are waited for, and later ones see all.
void cmdRefitNow(const MeshImpl& mesh, VkCommandBuffer commandBuffer);

/// Records the upload of a wrapped mesh with clusters: from its staging, and the pass.
void cmdUploadOrder(const MeshImpl& mesh, VkCommandBuffer commandBuffer);

} // namespace voxtact

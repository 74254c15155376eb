// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "core/geometry/recentre.h"
#include "device/scene/scene_impl.h"
#include "exact/shared.h"

namespace voxtact {

inline constexpr VkDeviceSize kPositionBytes = 3 * sizeof(float);

/// How shaders find a mesh in the buffers of its descriptor set.
[[nodiscard]] shader::MeshConstants meshConstants(const MeshImpl& mesh) noexcept;
/// How they find it in the buffers that it is drawn from: the same, but for a wrapped mesh with clusters.
[[nodiscard]] shader::MeshConstants sourceConstants(const MeshImpl& mesh) noexcept;

/// What a triangle can reach of the two buffers that a mesh is drawn from: bytes from their beginning.
struct MeshRanges {
    VkDeviceSize vertexEnd = 0;
    VkDeviceSize indexEnd = 0; ///< that of the vertices where there are no indices
};
[[nodiscard]] MeshRanges rangesOf(const MeshImpl& mesh) noexcept;

/// LimitExceeded where the vertices are too far apart for the device to draw them.
[[nodiscard]] Result<void> checkVertexInput(const MeshImpl& mesh, const std::string& which);

/// Makes the descriptor set for shaders that read the mesh as storage; MeshImpl::noStorage where the device's limits
/// do not allow for it.
[[nodiscard]] Result<void> describe(MeshImpl& mesh, const char* name);

/// The words that are kept of clusters: their boxes, those of their runs, and then the triangles.
[[nodiscard]] std::vector<std::uint32_t> clusterWords(const FloatMesh& mesh, const MeshClusters& clusters);
/// How many they are.
[[nodiscard]] std::uint64_t clusterWordCount(std::uint32_t triangles) noexcept;

/// Puts positions where a mesh has them, `stride` bytes from one to the next, and zeros in between.
void spreadVertices(std::span<const float> positions, VkDeviceSize stride, std::span<std::byte> to) noexcept;

/// What the host knows of a mesh with these triangles. `order`: its triangles in clusters; empty: those are the
/// triangles of the mesh in their order.
[[nodiscard]] MeshKnown knownOf(const CheckedMesh& mesh, std::span<const std::uint32_t> indices,
                                std::span<const std::uint32_t> order);

} // namespace voxtact

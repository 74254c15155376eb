// SPDX-License-Identifier: MIT
// Meshes that bend: new vertices for one of voxtact's, and clusters for the caller's.
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/recentre.h"
#include "device/scene/mesh_layout.h"
#include "device/scene/mesh_refit.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"

namespace voxtact {

namespace {

Result<void> checkEditable(const MeshImpl& mesh, VkCommandBuffer commandBuffer) {
    if (!mesh.editable) {
        return refuse(mesh.wrapped() ? "the mesh is wrapped: its vertices are the caller's"
                                     : "the mesh was made without MeshOptions::editable");
    }
    if (!mesh.uploaded) {
        return neverUploaded("the mesh");
    }
    return mesh.context.recordable(commandBuffer);
}

/// Before vertices are written: whatever uses them, and writes what they are copied from.
void cmdBeginEdit(const MeshImpl& mesh, VkCommandBuffer commandBuffer) {
    barrier(mesh.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

/// After: the clusters follow, and both are readable.
void cmdFinishEdit(const MeshImpl& mesh, VkCommandBuffer commandBuffer) {
    if (mesh.refitSet.set != VK_NULL_HANDLE) {
        cmdRefitNow(mesh, commandBuffer);
        return;
    }
    barrier(mesh.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
}

} // namespace

Result<void> Mesh::cmdUpdate(VkCommandBuffer commandBuffer, std::span<const double> positions) {
    return guard([&]() -> Result<void> {
        MeshImpl& mesh = live(impl_);
        VOXTACT_TRY(checkEditable(mesh, commandBuffer));
        if (positions.size() != std::size_t{3} * mesh.vertexCount) {
            return refuse("the update has " + std::to_string(positions.size()) + " coordinates, the mesh has " +
                          std::to_string(mesh.vertexCount) + " vertices of three");
        }
        const Result<CheckedMesh> checked = checkedMesh({positions, mesh.triangles});
        VOXTACT_TRY(checked);
        MeshKnown known = knownOf(*checked, mesh.triangles, mesh.order);
        std::vector<std::byte> spread;
        std::span<const std::byte> bytes = std::as_bytes(std::span(checked->positions));
        if (mesh.vertexStride != kPositionBytes) {
            spread.resize(rangesOf(mesh).vertexEnd);
            spreadVertices(checked->positions, mesh.vertexStride, spread);
            bytes = spread;
        }
        const Label label(mesh.context, commandBuffer, "voxtact mesh update");
        cmdBeginEdit(mesh, commandBuffer);
        cmdUpdateBuffer(mesh.context, commandBuffer, mesh.vertices, 0, bytes);
        cmdFinishEdit(mesh, commandBuffer);
        mesh.known = std::move(known);
        return {};
    });
}

Result<void> Mesh::cmdCopy(VkCommandBuffer commandBuffer, VkBuffer source, VkDeviceSize offset) {
    return guard([&]() -> Result<void> {
        MeshImpl& mesh = live(impl_);
        VOXTACT_TRY(checkEditable(mesh, commandBuffer));
        if (source == VK_NULL_HANDLE) {
            return refuse("the buffer to copy vertices from is null");
        }
        if (offset % sizeof(float) != 0) {
            return refuse("the offset " + std::to_string(offset) + " of the vertices to copy is not a multiple of 4");
        }
        const Label label(mesh.context, commandBuffer, "voxtact mesh copy");
        cmdBeginEdit(mesh, commandBuffer);
        const VkBufferCopy all{offset, 0, rangesOf(mesh).vertexEnd};
        mesh.context.vk.CmdCopyBuffer(commandBuffer, source, mesh.vertices, 1, &all);
        cmdFinishEdit(mesh, commandBuffer);
        mesh.known = {};
        return {};
    });
}

Result<void> Mesh::cmdRefit(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        const MeshImpl& mesh = live(impl_);
        if (!mesh.wrapped()) {
            return refuse("the mesh is not wrapped: its clusters follow its vertices");
        }
        if (!mesh.clusterWord) {
            return refuse("the mesh was wrapped without WrappedMesh::clusters");
        }
        VOXTACT_TRY(mesh.context.recordable(commandBuffer));
        if (!mesh.uploaded) {
            return neverUploaded("the mesh");
        }
        const Label label(mesh.context, commandBuffer, "voxtact mesh refit");
        cmdRefitNow(mesh, commandBuffer);
        return {};
    });
}

} // namespace voxtact

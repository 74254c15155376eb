// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/mesh_vertex.h"
#include "render/render_impl.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"

#include <cmath>
#include <cstring>

namespace voxtact {

namespace {

/// Twice the area long.
Vec3 triangleNormal(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Vec3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

std::vector<float> vertexNormals(const MeshView& mesh) {
    std::vector<double> sums(mesh.positions.size());
    for (std::size_t at = 0; at < mesh.indices.size(); at += 3) {
        const std::span<const std::uint32_t> corners = mesh.indices.subspan(at, 3);
        const Vec3 normal =
            triangleNormal(vertexOf(mesh, corners[0]), vertexOf(mesh, corners[1]), vertexOf(mesh, corners[2]));
        for (const std::uint32_t corner : corners) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                sums[3 * std::size_t{corner} + axis] += normal[axis];
            }
        }
    }
    std::vector<float> normals(sums.size());
    for (std::size_t at = 0; at < sums.size(); at += 3) {
        const double size = std::hypot(sums[at], sums[at + 1], sums[at + 2]);
        for (std::size_t axis = 0; axis < 3 && size > 0; ++axis) {
            normals[at + axis] = static_cast<float>(sums[at + axis] / size);
        }
    }
    return normals;
}

} // namespace

MeshNormals::MeshNormals(std::unique_ptr<MeshNormalsImpl> impl) noexcept : impl_(std::move(impl)) {}
MeshNormals::MeshNormals(MeshNormals&&) noexcept = default;
MeshNormals& MeshNormals::operator=(MeshNormals&&) noexcept = default;
MeshNormals::~MeshNormals() = default;

Result<MeshNormals> MeshNormals::create(const Renderer& renderer, const MeshView& data) {
    return guard([&]() -> Result<MeshNormals> {
        ContextImpl& context = renderer.impl().context;
        VOXTACT_TRY(context.alive());
        const Result<MeshFacts> facts = checkMesh(data);
        VOXTACT_TRY(facts);
        auto impl = std::make_unique<MeshNormalsImpl>(MeshNormalsImpl{.context = context, .vertices = facts->vertices});
        const std::vector<float> normals = vertexNormals(data);
        const std::span<const std::byte> bytes = std::as_bytes(std::span(normals));
        VOXTACT_TRY(makeStaged(context, bytes.size(), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "mesh normals", impl->buffer,
                               impl->staging));
        std::memcpy(impl->staging.mapped, bytes.data(), bytes.size());
        VOXTACT_TRY(flush(context, impl->staging));
        return MeshNormals(std::move(impl));
    });
}

Result<MeshNormals> MeshNormals::upload(const Renderer& renderer, const QueueAccess& queue, const MeshView& data) {
    return guard([&] { return uploaded(renderer.impl().context, queue, create(renderer, data)); });
}

Result<void> MeshNormals::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!live(impl_).staging.buffer) {
            return notUploadable("normals");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Label label(live(impl_).context, commandBuffer, "voxtact normals upload");
        cmdFillBuffer(live(impl_).context, commandBuffer, live(impl_).staging, live(impl_).buffer);
        live(impl_).uploaded = true;
        return {};
    });
}

Result<void> MeshNormals::cmdUpdate(VkCommandBuffer commandBuffer, const MeshView& data) {
    return guard([&]() -> Result<void> {
        const MeshNormalsImpl& impl = live(impl_);
        ContextImpl& context = impl.context;
        VOXTACT_TRY(context.recordable(commandBuffer));
        if (!impl.uploaded) {
            return Error{ErrorCode::NotReady, 0, "the normals were never uploaded: record their cmdUpload() first"};
        }
        const Result<MeshFacts> facts = checkMesh(data);
        VOXTACT_TRY(facts);
        if (facts->vertices != impl.vertices) {
            return refuse("the mesh has " + std::to_string(facts->vertices) + " vertices, the normals are of " +
                          std::to_string(impl.vertices));
        }
        const std::vector<float> normals = vertexNormals(data);
        const Label label(context, commandBuffer, "voxtact normals update");
        barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
        cmdUpdateBuffer(context, commandBuffer, impl.buffer.get(), 0, std::as_bytes(std::span(normals)));
        barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
        return {};
    });
}

void MeshNormals::releaseStaging() noexcept {
    live(impl_).staging = {};
}

} // namespace voxtact

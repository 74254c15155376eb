// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/clusters.h"
#include "core/geometry/recentre.h"
#include "device/scene/mesh_layout.h"
#include "device/scene/mesh_refit.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"

#include <cstring>
#include <limits>
#include <numeric>

namespace voxtact {

namespace {

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

/// Makes the buffer and fills its staging. `words` are those of the clusters.
Result<void> fillBuffers(MeshImpl& mesh, const FloatMesh& data, std::span<const std::uint32_t> words,
                         const char* name) {
    const VkDeviceSize positions = rangesOf(mesh).vertexEnd;
    const VkDeviceSize described = positions + data.indices.size_bytes();
    constexpr VkBufferUsageFlags kUsage =
        kStorage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    VOXTACT_TRY(makeStaged(mesh.context, described + words.size_bytes(), kUsage, name, mesh.buffer, mesh.staging));
    mesh.vertices = mesh.buffer.get();
    mesh.indices = mesh.buffer.get();
    mesh.indexOffset = positions;
    auto* to = static_cast<std::byte*>(mesh.staging.mapped);
    spreadVertices(data.positions, mesh.vertexStride, {to, positions});
    std::memcpy(to + positions, data.indices.data(), data.indices.size_bytes());
    if (!words.empty()) {
        mesh.clusterWord = static_cast<std::uint32_t>(described / sizeof(std::uint32_t));
        std::memcpy(to + described, words.data(), words.size_bytes());
    }
    return flush(mesh.context, mesh.staging);
}

/// Fills a mesh of its own.
Result<void> fill(MeshImpl& mesh, const CheckedMesh& checked, std::span<const std::uint32_t> indices,
                  const MeshOptions& options) {
    const FloatMesh data{checked.positions, indices};
    const char* name = options.name == nullptr ? "mesh" : options.name;
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> order;
    if (options.clusters) {
        MeshClusters clusters = makeClusters(data);
        words = clusterWords(data, clusters);
        order = std::move(clusters.triangles);
    }
    mesh.known = knownOf(checked, indices, order);
    VOXTACT_TRY(fillBuffers(mesh, data, words, name));
    VOXTACT_TRY(describe(mesh, "mesh"));
    if (!options.editable) {
        return {};
    }
    mesh.editable = true;
    mesh.triangles.assign(data.indices.begin(), data.indices.end());
    mesh.order = std::move(order);
    mesh.made = mesh.known;
    return options.clusters && mesh.noStorage.empty() ? makeRefit(mesh) : Result<void>();
}

/// The triangles of a wrapped mesh, cluster by cluster.
Result<std::vector<std::uint32_t>> orderOf(const WrappedMesh& wrapped) {
    if (wrapped.shape.indices.empty()) {
        std::vector<std::uint32_t> order(wrapped.triangleCount);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    const Result<CheckedMesh> shape = checkedMesh(wrapped.shape);
    VOXTACT_TRY(shape);
    if (shape->facts.triangles != wrapped.triangleCount) {
        return refuse("WrappedMesh::shape has " + std::to_string(shape->facts.triangles) +
                      " triangles, triangleCount is " + std::to_string(wrapped.triangleCount));
    }
    return makeClusters({shape->positions, wrapped.shape.indices}).triangles;
}

/// Makes what is kept of the clusters of a wrapped mesh, and stages what the host knows of them.
Result<void> makeWrappedClusters(MeshImpl& mesh, const WrappedMesh& wrapped) {
    ContextImpl& context = mesh.context;
    const std::uint64_t indices = mesh.indexed() ? std::uint64_t{3} * mesh.triangleCount : 0;
    const VkDeviceSize bytes = sizeof(std::uint32_t) * (indices + clusterWordCount(mesh.triangleCount));
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the clusters of the wrapped mesh need " + std::to_string(bytes) +
                         " bytes of a buffer, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    const Result<std::vector<std::uint32_t>> order = orderOf(wrapped);
    VOXTACT_TRY(order);
    Result<Buffer> buffer = makeBuffer(context, bytes, kStorage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Device,
                                       "clusters of a wrapped mesh");
    VOXTACT_TRY(buffer);
    const std::span<const std::byte> staged = std::as_bytes(std::span(*order));
    Result<Buffer> staging = makeBuffer(context, staged.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload,
                                        "clusters of a wrapped mesh, staging");
    VOXTACT_TRY(staging);
    mesh.buffer = std::move(*buffer);
    mesh.staging = std::move(*staging);
    mesh.clusterWord = static_cast<std::uint32_t>(indices);
    mesh.uploaded = false;
    std::memcpy(mesh.staging.mapped, staged.data(), staged.size());
    return flush(context, mesh.staging);
}

Result<void> checkStride(VkDeviceSize stride, VkDeviceSize offset, const char* text) {
    return stride < kPositionBytes || stride % 4 != 0 || offset % 4 != 0 ? Result<void>(refuse(text)) : Result<void>();
}

/// Refuses offsets and strides beyond 64 bits of bytes.
Result<void> checkEnds(const WrappedMesh& wrapped) {
    constexpr VkDeviceSize kMost = std::numeric_limits<VkDeviceSize>::max() / 2;
    if (wrapped.vertexOffset > kMost || wrapped.indexOffset > kMost ||
        VkDeviceSize{wrapped.vertexStride} > kMost / wrapped.vertexCount) {
        return refuse("WrappedMesh::vertexOffset, indexOffset or vertexStride is beyond what a buffer can have");
    }
    return {};
}

Result<void> checkWrapped(const WrappedMesh& wrapped) {
    if (wrapped.vertices == VK_NULL_HANDLE) {
        return refuse("WrappedMesh::vertices is null");
    }
    if (wrapped.triangleCount == 0) {
        return refuse("the mesh has no triangles: WrappedMesh::triangleCount is 0");
    }
    if (wrapped.vertexCount == 0) {
        return refuse("WrappedMesh::vertexCount is 0");
    }
    if (wrapped.triangleCount > UINT32_MAX / 3) {
        return refuse("WrappedMesh::triangleCount is beyond what a draw can index");
    }
    VOXTACT_TRY(checkStride(wrapped.vertexStride, wrapped.vertexOffset,
                            "WrappedMesh::vertexStride must be at least 12, and it and vertexOffset multiples of 4"));
    VOXTACT_TRY(checkEnds(wrapped));
    if (wrapped.clusters && !wrapped.storage) {
        return refuse("WrappedMesh::clusters needs buffers that can be read as storage: WrappedMesh::storage");
    }
    if (wrapped.indices == VK_NULL_HANDLE && wrapped.vertexCount < 3 * std::uint64_t{wrapped.triangleCount}) {
        return refuse("WrappedMesh has no indices and fewer than three vertices per triangle");
    }
    if (wrapped.indices == VK_NULL_HANDLE) {
        return {};
    }
    if (wrapped.indexType != VK_INDEX_TYPE_UINT16 && wrapped.indexType != VK_INDEX_TYPE_UINT32) {
        return refuse("WrappedMesh::indexType is neither UINT16 nor UINT32");
    }
    if (wrapped.indexOffset % (wrapped.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4) != 0) {
        return refuse("WrappedMesh::indexOffset is not a multiple of the index size");
    }
    return {};
}

} // namespace

Mesh::Mesh(std::unique_ptr<MeshImpl> impl) noexcept : impl_(std::move(impl)) {}
Mesh::Mesh(Mesh&&) noexcept = default;
Mesh& Mesh::operator=(Mesh&&) noexcept = default;
Mesh::~Mesh() = default;

Result<Mesh> Mesh::create(const Context& context, const MeshView& data, const MeshOptions& options) {
    return guard([&]() -> Result<Mesh> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(c.alive());
        const Result<CheckedMesh> checked = checkedMesh(data);
        VOXTACT_TRY(checked);
        const MeshFacts& facts = checked->facts;
        VOXTACT_TRY(
            checkStride(options.vertexStride, 0, "MeshOptions::vertexStride must be at least 12, and a multiple of 4"));
        auto impl = std::make_unique<MeshImpl>(MeshImpl{.context = c});
        impl->vertexStride = options.vertexStride;
        impl->vertexCount = facts.vertices;
        impl->triangleCount = facts.triangles;
        VOXTACT_TRY(fill(*impl, *checked, data.indices, options));
        if (facts.degenerate > 0) {
            c.log("the mesh has " + std::to_string(facts.degenerate) + " degenerate triangles of " +
                  std::to_string(facts.triangles) + "; only the projection certified counts them");
        }
        return Mesh(std::move(impl));
    });
}

Result<Mesh> Mesh::wrap(const Context& context, const WrappedMesh& wrapped) {
    return guard([&]() -> Result<Mesh> {
        VOXTACT_TRY(context.impl().alive());
        VOXTACT_TRY(checkWrapped(wrapped));
        auto impl = std::make_unique<MeshImpl>(MeshImpl{.context = context.impl()});
        impl->uploaded = true;
        impl->vertices = wrapped.vertices;
        impl->vertexOffset = wrapped.vertexOffset;
        impl->vertexStride = wrapped.vertexStride;
        impl->vertexCount = wrapped.vertexCount;
        impl->indices = wrapped.indices;
        impl->indexOffset = wrapped.indexOffset;
        impl->indexType = wrapped.indexType;
        impl->triangleCount = wrapped.triangleCount;
        if (!wrapped.storage) {
            impl->noStorage = "WrappedMesh::storage is false: its buffers cannot be read as storage";
            return Mesh(std::move(impl));
        }
        if (wrapped.clusters) {
            VOXTACT_TRY(makeWrappedClusters(*impl, wrapped));
        }
        VOXTACT_TRY(describe(*impl, "wrapped mesh"));
        if (wrapped.clusters && !impl->noStorage.empty()) {
            return Error{ErrorCode::LimitExceeded, 0, impl->noStorage};
        }
        if (wrapped.clusters) {
            VOXTACT_TRY(makeRefit(*impl));
        }
        return Mesh(std::move(impl));
    });
}

Result<Mesh> Mesh::upload(const Context& context, const QueueAccess& queue, const MeshView& data,
                          const MeshOptions& options) {
    return guard([&] { return uploaded(context.impl(), queue, create(context, data, options)); });
}

Result<void> Mesh::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        MeshImpl& mesh = live(impl_);
        if (!mesh.staging.buffer) {
            return notUploadable("mesh");
        }
        VOXTACT_TRY(mesh.context.recordable(commandBuffer));
        MeshKnown known = mesh.made; // what may fail comes first
        const Label label(mesh.context, commandBuffer, "voxtact mesh upload");
        if (mesh.wrapped()) {
            cmdUploadOrder(mesh, commandBuffer);
        } else {
            cmdFillBuffer(mesh.context, commandBuffer, mesh.staging, mesh.buffer);
        }
        if (mesh.editable) {
            mesh.known = std::move(known);
        }
        mesh.uploaded = true;
        return {};
    });
}

void Mesh::releaseStaging() noexcept {
    live(impl_).staging = {};
}

std::uint32_t Mesh::triangles() const noexcept {
    return live(impl_).triangleCount;
}

std::optional<MeshFacts> Mesh::facts() const noexcept {
    return live(impl_).known.facts;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "core/geometry/clusters.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/scene_impl.h"
#include "gpu/submit.h"
#include "shared.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

namespace voxtact {

namespace {

constexpr VkDeviceSize kPositionBytes = 3 * sizeof(float);

void addBox(std::vector<std::uint32_t>& words, const std::array<float, 3>& lo, const std::array<float, 3>& hi) {
    for (const std::array<float, 3>& corner : {lo, hi}) {
        for (const float coordinate : corner) {
            words.push_back(std::bit_cast<std::uint32_t>(coordinate));
        }
    }
}

/// The words that are kept of clusters: their boxes, those of their runs, and then the triangles.
std::vector<std::uint32_t> clusterWords(const MeshView& mesh, const MeshClusters& clusters) {
    static_assert(kClusterTriangles == VOXTACT_CLUSTER_TRIANGLES && kRunTriangles == VOXTACT_RUN_TRIANGLES);
    const std::vector<RunBox> runs = runBoxes(mesh, clusters);
    std::vector<std::uint32_t> words;
    words.reserve(6 * (clusters.clusters.size() + runs.size()) + clusters.triangles.size());
    for (const MeshCluster& cluster : clusters.clusters) {
        addBox(words, cluster.lo, cluster.hi);
    }
    for (const RunBox& run : runs) {
        addBox(words, run.lo, run.hi);
    }
    words.insert(words.end(), clusters.triangles.begin(), clusters.triangles.end());
    return words;
}

double longestSquare(const MeshView& mesh, std::uint32_t triangle) {
    const auto vertex = [&](std::size_t corner) {
        return mesh.positions.subspan(std::size_t{3} * mesh.indices[std::size_t{3} * triangle + corner], 3);
    };
    double longest = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double side = static_cast<double>(vertex(corner)[axis]) - vertex((corner + 1) % 3)[axis];
            square += side * side;
        }
        longest = std::max(longest, square);
    }
    return longest;
}

/// MeshImpl::squaresBefore. `order` is that of the triangles in clusters; empty: that of the mesh.
std::vector<double> squaresBefore(const MeshView& mesh, std::span<const std::uint32_t> order) {
    const auto triangles = static_cast<std::uint32_t>(mesh.indices.size() / 3);
    std::vector<double> before;
    before.reserve(triangles / VOXTACT_CLUSTER_TRIANGLES + 2);
    double sum = 0;
    for (std::uint32_t place = 0; place < triangles; ++place) {
        if (place % VOXTACT_CLUSTER_TRIANGLES == 0) {
            before.push_back(sum);
        }
        sum += longestSquare(mesh, order.empty() ? place : order[place]);
    }
    before.push_back(sum);
    return before;
}

Result<void> fillBuffers(MeshImpl& mesh, const MeshView& data, const MeshOptions& options, const char* name) {
    ContextImpl& context = mesh.context;
    std::vector<std::uint32_t> clusters;
    mesh.squaresBeforeGroup = squaresBefore(data, {});
    if (options.clusters) {
        const MeshClusters made = makeClusters(data);
        clusters = clusterWords(data, made);
        mesh.squaresBefore = squaresBefore(data, made.triangles);
    } else {
        mesh.squaresBefore = mesh.squaresBeforeGroup;
    }
    const VkDeviceSize positions = data.positions.size_bytes();
    const VkDeviceSize described = positions + data.indices.size_bytes();
    const VkDeviceSize total = described + clusters.size() * sizeof(std::uint32_t);
    if (options.clusters) {
        mesh.clusterWord = static_cast<std::uint32_t>(described / sizeof(std::uint32_t));
    }
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VOXTACT_TRY(makeStaged(context, total, kUsage, name, mesh.buffer, mesh.staging));
    mesh.vertices = mesh.buffer.get();
    mesh.indices = mesh.buffer.get();
    mesh.indexOffset = positions;
    auto* to = static_cast<std::byte*>(mesh.staging.mapped);
    std::memcpy(to, data.positions.data(), data.positions.size_bytes());
    std::memcpy(to + positions, data.indices.data(), data.indices.size_bytes());
    if (!clusters.empty()) {
        std::memcpy(to + described, clusters.data(), clusters.size() * sizeof(std::uint32_t));
    }
    return flush(context, mesh.staging);
}

std::uint32_t indexBytes(const MeshImpl& mesh) {
    if (mesh.indices == VK_NULL_HANDLE) {
        return 0;
    }
    return mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
}

/// The descriptor set for shaders that read the mesh as storage, over what a triangle can reach of the two buffers.
Result<void> describe(MeshImpl& mesh, std::uint32_t vertexCount, const char* name) {
    ContextImpl& context = mesh.context;
    constexpr VkDeviceSize kWord = 4;
    const VkDeviceSize vertexEnd =
        mesh.vertexOffset + mesh.vertexStride * (VkDeviceSize{vertexCount} - 1) + kPositionBytes;
    const VkDeviceSize indexEnd =
        mesh.indexOffset + VkDeviceSize{3} * mesh.triangleCount * indexBytes(mesh) + kWord - 1;
    // A mesh of our own ends with the clusters.
    const VkDeviceSize indexRange = mesh.buffer.buffer               ? mesh.buffer.size
                                    : mesh.indices == VK_NULL_HANDLE ? vertexEnd
                                                                     : indexEnd / kWord * kWord;
    const VkDeviceSize most = context.limits.maxStorageBufferRange;
    if (vertexEnd > most || indexRange > most) {
        mesh.noStorage = "the mesh needs " + std::to_string(std::max(vertexEnd, indexRange)) +
                         " bytes of a buffer, the device's maxStorageBufferRange is " + std::to_string(most);
        return {};
    }
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.setLayouts[VOXTACT_SET_MESH], {&size, 1}, name);
    VOXTACT_TRY(set);
    mesh.descriptors = std::move(*set);
    writeBuffer(context, mesh.descriptors.set, VOXTACT_BINDING_VERTICES, mesh.vertices, vertexEnd);
    writeBuffer(context, mesh.descriptors.set, VOXTACT_BINDING_INDICES,
                mesh.indices == VK_NULL_HANDLE ? mesh.vertices : mesh.indices, indexRange);
    return {};
}

Error refuse(const char* text) {
    return {ErrorCode::InvalidArgument, 0, text};
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
    if (wrapped.vertexStride < kPositionBytes || wrapped.vertexStride % 4 != 0 || wrapped.vertexOffset % 4 != 0) {
        return refuse("WrappedMesh::vertexStride must be at least 12, and it and vertexOffset multiples of 4");
    }
    if (wrapped.indices == VK_NULL_HANDLE && wrapped.vertexCount < 3 * std::uint64_t{wrapped.triangleCount}) {
        return refuse("WrappedMesh has no indices and fewer than three vertices a triangle");
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
        const Result<MeshFacts> facts = checkMesh(data);
        VOXTACT_TRY(facts);
        auto impl = std::make_unique<MeshImpl>(MeshImpl{.context = c});
        impl->triangleCount = facts->triangles;
        impl->facts = *facts;
        VOXTACT_TRY(fillBuffers(*impl, data, options, options.name == nullptr ? "mesh" : options.name));
        VOXTACT_TRY(describe(*impl, facts->vertices, "mesh"));
        if (facts->degenerate > 0) {
            c.log("the mesh has " + std::to_string(facts->degenerate) + " degenerate triangles of " +
                  std::to_string(facts->triangles) + "; they give no fragment");
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
        impl->indices = wrapped.indices;
        impl->indexOffset = wrapped.indexOffset;
        impl->indexType = wrapped.indexType;
        impl->triangleCount = wrapped.triangleCount;
        if (!wrapped.storage) {
            impl->noStorage = "WrappedMesh::storage is false: its buffers cannot be read as storage";
        } else if (Result<void> described = describe(*impl, wrapped.vertexCount, "wrapped mesh"); !described.ok()) {
            return described.error();
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
        if (!live(impl_).staging.buffer) {
            return notUploadable("mesh");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Label label(live(impl_).context, commandBuffer, "voxtact mesh upload");
        cmdFillBuffer(live(impl_).context, commandBuffer, live(impl_).staging, live(impl_).buffer);
        live(impl_).uploaded = true;
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
    return live(impl_).facts;
}

} // namespace voxtact

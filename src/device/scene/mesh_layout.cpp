// SPDX-License-Identifier: MIT
#include "device/scene/mesh_layout.h"
#include "core/base/try.h"
#include "core/geometry/recentre.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace voxtact {

namespace {

static_assert(kClusterTriangles == VOXTACT_CLUSTER_TRIANGLES && kRunTriangles == VOXTACT_RUN_TRIANGLES);

constexpr VkDeviceSize kLayoutWord = 4;

std::uint32_t indexBytes(const MeshImpl& mesh) noexcept {
    if (!mesh.indexed()) {
        return 0;
    }
    return mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
}

void addBox(std::vector<std::uint32_t>& words, const std::array<float, 3>& lo, const std::array<float, 3>& hi) {
    for (const std::array<float, 3>& corner : {lo, hi}) {
        for (const float coordinate : corner) {
            words.push_back(std::bit_cast<std::uint32_t>(coordinate));
        }
    }
}

double longestSquare(const FloatMesh& mesh, std::uint32_t triangle) {
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

/// MeshKnown::squaresBefore.
std::vector<double> squaresBefore(const FloatMesh& mesh, std::span<const std::uint32_t> order) {
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

} // namespace

shader::MeshConstants sourceConstants(const MeshImpl& mesh) noexcept {
    return {static_cast<std::uint32_t>(mesh.vertexOffset / sizeof(float)),
            static_cast<std::uint32_t>(mesh.vertexStride / sizeof(float)), static_cast<std::uint32_t>(mesh.indexOffset),
            indexBytes(mesh)};
}

shader::MeshConstants meshConstants(const MeshImpl& mesh) noexcept {
    shader::MeshConstants constants = sourceConstants(mesh);
    if (mesh.wrapped() && mesh.clusterWord && mesh.indexed()) {
        constants.indexOffset = 0;
        constants.indexBytes = kLayoutWord;
    }
    return constants;
}

MeshRanges rangesOf(const MeshImpl& mesh) noexcept {
    MeshRanges ranges;
    ranges.vertexEnd = mesh.vertexOffset + mesh.vertexStride * (VkDeviceSize{mesh.vertexCount} - 1) + kPositionBytes;
    const VkDeviceSize indexEnd = mesh.indexOffset + VkDeviceSize{3} * mesh.triangleCount * indexBytes(mesh);
    ranges.indexEnd = mesh.indexed() ? (indexEnd + kLayoutWord - 1) / kLayoutWord * kLayoutWord : ranges.vertexEnd;
    return ranges;
}

Result<void> checkVertexInput(const MeshImpl& mesh, const std::string& which) {
    const std::uint32_t most = mesh.context.limits.maxVertexInputBindingStride;
    if (mesh.vertexStride <= most) {
        return {};
    }
    return Error{ErrorCode::LimitExceeded, 0,
                 which + ": the vertexStride " + std::to_string(mesh.vertexStride) +
                     " is beyond the device's maxVertexInputBindingStride, " + std::to_string(most)};
}

Result<void> describe(MeshImpl& mesh, const char* name) {
    ContextImpl& context = mesh.context;
    const MeshRanges ranges = rangesOf(mesh);
    const bool own = static_cast<bool>(mesh.buffer.buffer); // it ends with the clusters
    const VkDeviceSize needed = std::max({ranges.vertexEnd, ranges.indexEnd, own ? mesh.buffer.size : 0});
    const VkDeviceSize most = context.limits.maxStorageBufferRange;
    if (needed > most) {
        mesh.noStorage = "the mesh needs " + std::to_string(needed) +
                         " bytes of a buffer, the device's maxStorageBufferRange is " + std::to_string(most);
        return {};
    }
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.setLayouts[VOXTACT_SET_MESH], {&size, 1}, name);
    VOXTACT_TRY(set);
    mesh.descriptors = std::move(*set);
    writeBuffer(context, mesh.descriptors.set, VOXTACT_BINDING_VERTICES, mesh.vertices, ranges.vertexEnd);
    const VkBuffer indices = mesh.indexed() ? mesh.indices : mesh.vertices;
    writeBuffer(context, mesh.descriptors.set, VOXTACT_BINDING_INDICES, own ? mesh.buffer.get() : indices,
                own ? mesh.buffer.size : ranges.indexEnd);
    return {};
}

std::vector<std::uint32_t> clusterWords(const FloatMesh& mesh, const MeshClusters& clusters) {
    const std::vector<RunBox> runs = runBoxes(mesh, clusters);
    std::vector<std::uint32_t> words;
    words.reserve(clusterWordCount(static_cast<std::uint32_t>(clusters.triangles.size())));
    for (const MeshCluster& cluster : clusters.clusters) {
        addBox(words, cluster.lo, cluster.hi);
    }
    for (const RunBox& run : runs) {
        addBox(words, run.lo, run.hi);
    }
    words.insert(words.end(), clusters.triangles.begin(), clusters.triangles.end());
    return words;
}

std::uint64_t clusterWordCount(std::uint32_t triangles) noexcept {
    constexpr std::uint64_t kBoxWords = 6;
    const std::uint64_t clusters = (std::uint64_t{triangles} + kClusterTriangles - 1) / kClusterTriangles;
    const std::uint64_t runs = (std::uint64_t{triangles} + kRunTriangles - 1) / kRunTriangles;
    return kBoxWords * (clusters + runs) + triangles;
}

void spreadVertices(std::span<const float> positions, VkDeviceSize stride, std::span<std::byte> to) noexcept {
    if (stride == kPositionBytes) {
        std::memcpy(to.data(), positions.data(), positions.size_bytes());
        return;
    }
    std::ranges::fill(to, std::byte{});
    for (std::size_t vertex = 0; vertex < positions.size() / 3; ++vertex) {
        std::memcpy(to.data() + vertex * stride, positions.data() + 3 * vertex, kPositionBytes);
    }
}

MeshKnown knownOf(const CheckedMesh& mesh, std::span<const std::uint32_t> indices,
                  std::span<const std::uint32_t> order) {
    const FloatMesh floats{mesh.positions, indices};
    MeshKnown known{.facts = mesh.facts,
                    .origin = mesh.origin,
                    .squaresBefore = {},
                    .squaresBeforeGroup = squaresBefore(floats, {})};
    known.squaresBefore = order.empty() ? known.squaresBeforeGroup : squaresBefore(floats, order);
    return known;
}

} // namespace voxtact

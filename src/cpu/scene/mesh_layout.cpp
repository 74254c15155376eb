// SPDX-License-Identifier: MIT
#include "cpu/scene/scene_impl.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace voxtact::cpu {

namespace {

std::uint32_t aligned(std::uint32_t count) {
    return (count + kMeshAlignment - 1) / kMeshAlignment * kMeshAlignment;
}

void addVertices(MeshImpl& mesh, const MeshView& data, std::span<const std::uint32_t> vertices) {
    const std::uint32_t padded = aligned(static_cast<std::uint32_t>(vertices.size()));
    for (std::size_t i = 0; i < padded; ++i) {
        const float* at = data.positions.data() + std::size_t{3} * vertices[std::min(i, vertices.size() - 1)];
        mesh.x.push_back(at[0]);
        mesh.y.push_back(at[1]);
        mesh.z.push_back(at[2]);
    }
}

void addTriangles(MeshImpl& mesh, std::span<const std::array<std::uint8_t, 3>> triangles,
                  std::span<const std::uint32_t> numbers) {
    const std::uint32_t padded = aligned(static_cast<std::uint32_t>(triangles.size()));
    for (std::size_t i = 0; i < padded; ++i) {
        const std::array<std::uint8_t, 3> corners = i < triangles.size() ? triangles[i] : std::array<std::uint8_t, 3>{};
        mesh.corner0.push_back(corners[0]);
        mesh.corner1.push_back(corners[1]);
        mesh.corner2.push_back(corners[2]);
        mesh.numbers.push_back(i < triangles.size() ? numbers[i] : kNoTriangle);
    }
}

void addBox(const MeshCluster& cluster, std::size_t axis, std::vector<float>& centres, std::vector<float>& halves) {
    // Halves first: the sum of two large floats may overflow.
    const float centre = cluster.lo[axis] / 2 + cluster.hi[axis] / 2;
    const float half = std::max(cluster.hi[axis] - centre, centre - cluster.lo[axis]);
    centres.push_back(centre);
    halves.push_back(std::nextafter(half, std::numeric_limits<float>::infinity()));
}

} // namespace

MeshImpl::MeshImpl(const MeshView& data, const MeshFacts& checked) : facts(checked) {
    const MeshClusters split = makeClusters(data);
    for (const MeshCluster& cluster : split.clusters) {
        ClusterPlace place;
        place.firstVertex = static_cast<std::uint32_t>(x.size());
        place.firstTriangle = static_cast<std::uint32_t>(corner0.size());
        addVertices(*this, data, std::span(split.vertices).subspan(cluster.firstVertex, cluster.vertexCount));
        addTriangles(*this, std::span(split.corners).subspan(cluster.firstTriangle, cluster.triangleCount),
                     std::span(split.triangles).subspan(cluster.firstTriangle, cluster.triangleCount));
        place.vertexCount = static_cast<std::uint32_t>(x.size()) - place.firstVertex;
        place.triangleCount = static_cast<std::uint32_t>(corner0.size()) - place.firstTriangle;
        clusters.push_back(place);
        addBox(cluster, 0, centreX, halfX);
        addBox(cluster, 1, centreY, halfY);
        addBox(cluster, 2, centreZ, halfZ);
    }
    tree = ClusterTree(data, split);
    for (std::vector<float>* padded : {&centreX, &centreY, &centreZ, &halfX, &halfY, &halfZ}) {
        padded->resize(aligned(static_cast<std::uint32_t>(padded->size())));
    }
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#include "host/scene/scene_impl.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace voxtact::cpu {

namespace {

std::uint32_t aligned(std::uint32_t count) {
    return (count + kMeshAlignment - 1) / kMeshAlignment * kMeshAlignment;
}

void addVertices(MeshImpl& mesh, const FloatMesh& data, std::span<const std::uint32_t> vertices) {
    const std::uint32_t padded = aligned(static_cast<std::uint32_t>(vertices.size()));
    for (std::size_t i = 0; i < padded; ++i) {
        const std::uint32_t number = vertices[std::min(i, vertices.size() - 1)];
        const float* at = data.positions.data() + std::size_t{3} * number;
        mesh.x.push_back(at[0]);
        mesh.y.push_back(at[1]);
        mesh.z.push_back(at[2]);
        mesh.vertices.push_back(number);
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

/// Sets the range of a cluster along an axis.
void setBox(std::size_t cluster, float lo, float hi, std::vector<float>& centres, std::vector<float>& halves) {
    // Halves first: the sum of two large floats may overflow.
    const float centre = lo / 2 + hi / 2;
    const float half = std::max(hi - centre, centre - lo);
    centres[cluster] = centre;
    halves[cluster] = std::nextafter(half, std::numeric_limits<float>::infinity());
}

void setBoxes(MeshImpl& mesh) {
    for (std::size_t i = 0; i < mesh.clusters.size(); ++i) {
        const ClusterPlace& place = mesh.clusters[i];
        const auto fit = [&](const std::vector<float>& of, std::vector<float>& centres, std::vector<float>& halves) {
            const auto [lo, hi] = std::ranges::minmax(std::span(of).subspan(place.firstVertex, place.vertexCount));
            setBox(i, lo, hi, centres, halves);
        };
        fit(mesh.x, mesh.centreX, mesh.halfX);
        fit(mesh.y, mesh.centreY, mesh.halfY);
        fit(mesh.z, mesh.centreZ, mesh.halfZ);
    }
}

/// Around the runs of a mesh, wherever its vertices come.
std::vector<RunBox> runsAt(const MeshImpl& mesh, std::span<const float> positions) {
    std::vector<RunBox> runs;
    runs.reserve(mesh.clusters.size() * ClusterTree::kRunsOfCluster);
    for (const ClusterPlace& place : mesh.clusters) {
        for (std::uint32_t i = 0; i < place.triangleCount; ++i) {
            const std::uint32_t at = place.firstTriangle + i;
            if (mesh.numbers[at] == kNoTriangle) {
                break; // of the padding
            }
            const auto vertex = [&](std::uint8_t corner) {
                const float* from = positions.data() + std::size_t{3} * mesh.vertices[place.firstVertex + corner];
                const std::array<float, 3> point{from[0], from[1], from[2]};
                return RunBox{point, point};
            };
            if (i % kRunTriangles == 0) {
                runs.push_back(vertex(mesh.corner0[at]));
            }
            for (const std::uint8_t corner : {mesh.corner0[at], mesh.corner1[at], mesh.corner2[at]}) {
                grow(runs.back(), vertex(corner));
            }
        }
    }
    return runs;
}

/// Adds the vertices of the run that begins with triangle `at`.
void addRunVertices(const MeshImpl& mesh, std::uint32_t at, RunVertices& out) {
    std::array<bool, 3 * std::size_t{kClusterTriangles}> seen{};
    out.first.push_back(static_cast<std::uint32_t>(out.corner.size()));
    for (std::uint8_t i = 0; i < kRunTriangles && mesh.numbers[at + i] != kNoTriangle; ++i) {
        for (const std::uint8_t corner : {mesh.corner0[at + i], mesh.corner1[at + i], mesh.corner2[at + i]}) {
            if (!seen[corner]) {
                seen[corner] = true;
                out.corner.push_back(corner);
                out.triangle.push_back(i);
            }
        }
    }
}

RunVertices runVerticesOf(const MeshImpl& mesh) {
    RunVertices out;
    for (const ClusterPlace& place : mesh.clusters) {
        for (std::uint32_t run = 0; run < ClusterTree::kRunsOfCluster; ++run) {
            const std::uint32_t within = run * kRunTriangles;
            if (within < place.triangleCount) {
                addRunVertices(mesh, place.firstTriangle + within, out);
            } else { // of the last cluster
                out.first.push_back(static_cast<std::uint32_t>(out.corner.size()));
            }
        }
    }
    out.first.push_back(static_cast<std::uint32_t>(out.corner.size()));
    return out;
}

} // namespace

MeshImpl::MeshImpl(const FloatMesh& data, const MeshFacts& checked, const MeshOrigin& from)
    : facts(checked), origin(from) {
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
    }
    for (std::vector<float>* padded : {&centreX, &centreY, &centreZ, &halfX, &halfY, &halfZ}) {
        padded->resize(aligned(static_cast<std::uint32_t>(clusters.size())));
    }
    setBoxes(*this);
    runVertices = runVerticesOf(*this);
    tree = ClusterTree(runsAt(*this, data.positions));
}

std::vector<std::uint32_t> MeshImpl::indices() const {
    std::vector<std::uint32_t> out(std::size_t{3} * facts.triangles);
    for (const ClusterPlace& place : clusters) {
        for (std::uint32_t at = place.firstTriangle; at < place.firstTriangle + place.triangleCount; ++at) {
            if (numbers[at] == kNoTriangle) {
                break; // of the padding
            }
            std::size_t to = std::size_t{3} * numbers[at];
            for (const std::uint8_t corner : {corner0[at], corner1[at], corner2[at]}) {
                out[to++] = vertices[place.firstVertex + corner];
            }
        }
    }
    return out;
}

void MeshImpl::bend(std::span<const float> positions, const MeshFacts& checked, const MeshOrigin& from) {
    tree = ClusterTree(runsAt(*this, positions)); // all that allocates
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const float* at = positions.data() + std::size_t{3} * vertices[i];
        x[i] = at[0];
        y[i] = at[1];
        z[i] = at[2];
    }
    setBoxes(*this);
    facts = checked;
    origin = from;
    id = nextObjectId();
}

} // namespace voxtact::cpu

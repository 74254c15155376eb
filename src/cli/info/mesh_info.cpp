// SPDX-License-Identifier: MIT
#include "cli/info/mesh_info.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace voxtact::app {

namespace {

/// Vertices of an edge, the lower index first, and whether the triangle goes from the lower to the higher.
struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    bool upwards;

    [[nodiscard]] bool between(const Edge& other) const { return low == other.low && high == other.high; }
};

std::vector<Edge> edgesOf(const MeshView& mesh) {
    std::vector<Edge> edges;
    edges.reserve(mesh.indices.size());
    for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t from = mesh.indices[first + side];
            const std::uint32_t to = mesh.indices[first + (side + 1) % 3];
            // A triangle with a repeated vertex has an edge of length 0, and two equal edges.
            if (from != to) {
                edges.push_back({std::min(from, to), std::max(from, to), from < to});
            }
        }
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    return edges;
}

std::uint32_t partsOf(const MeshView& mesh) {
    std::vector<std::uint32_t> parent(mesh.positions.size() / 3);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&parent](std::uint32_t vertex) {
        while (parent[vertex] != vertex) {
            parent[vertex] = parent[parent[vertex]];
            vertex = parent[vertex];
        }
        return vertex;
    };
    std::vector<bool> used(parent.size());
    for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            parent[root(mesh.indices[first + corner])] = root(mesh.indices[first]);
            used[mesh.indices[first + corner]] = true;
        }
    }
    std::uint32_t parts = 0;
    for (std::uint32_t vertex = 0; vertex < parent.size(); ++vertex) {
        parts += used[vertex] && parent[vertex] == vertex ? 1 : 0;
    }
    return parts;
}

} // namespace

Closedness closednessOf(const MeshView& mesh) {
    Closedness result;
    const std::vector<Edge> edges = edgesOf(mesh);
    for (auto begin = edges.begin(); begin != edges.end();) {
        const auto end = std::find_if_not(begin, edges.end(), [&](const Edge& edge) { return edge.between(*begin); });
        const auto uses = end - begin;
        result.open += uses == 1 ? 1 : 0;
        result.many += uses > 2 ? 1 : 0;
        result.turned += uses == 2 && begin->upwards == (begin + 1)->upwards ? 1 : 0;
        begin = end;
    }
    result.parts = partsOf(mesh);
    return result;
}

} // namespace voxtact::app

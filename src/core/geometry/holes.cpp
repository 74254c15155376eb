// SPDX-License-Identifier: MIT
#include "core/geometry/holes.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

namespace voxtact {

namespace {

/// An undirected edge of a triangle: `up` is 1 from `a` to `b`, -1 in the other direction.
struct Edge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::int32_t up = 0;
};

std::vector<Edge> edgesOf(std::span<const std::uint32_t> indices) {
    std::vector<Edge> edges;
    edges.reserve(indices.size());
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t from = indices[i + corner];
            const std::uint32_t to = indices[i + (corner + 1) % 3];
            if (from != to) {
                edges.push_back(from < to ? Edge{from, to, 1} : Edge{to, from, -1});
            }
        }
    }
    std::ranges::sort(edges, [](const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    return edges;
}

/// Directed edges by their first vertex. At each vertex as many edges end as begin: the edges of a triangle are a loop,
/// and so are sums of loops.
class LoopWalk {
  public:
    explicit LoopWalk(std::vector<std::array<std::uint32_t, 2>> directed) : directed_(std::move(directed)) {
        std::ranges::sort(directed_);
        taken_.assign(directed_.size(), false);
    }

    std::vector<HoleLoop> loops() {
        std::vector<HoleLoop> loops;
        for (std::size_t first = 0; first < directed_.size(); ++first) {
            if (!taken_[first]) {
                walkFrom(directed_[first][0], loops);
            }
        }
        return loops;
    }

  private:
    /// Ends a loop wherever a vertex comes again, so that no loop has a vertex twice.
    void walkFrom(std::uint32_t start, std::vector<HoleLoop>& loops) {
        HoleLoop path{start};
        std::unordered_map<std::uint32_t, std::size_t> places{{start, 0}};
        std::uint32_t at = start;
        while (const auto next = takeFrom(at)) {
            at = directed_[*next][1];
            const auto [seen, isNew] = places.emplace(at, path.size());
            if (isNew) {
                path.push_back(at);
                continue;
            }
            const auto first = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
            loops.emplace_back(first, path.end());
            std::for_each(first + 1, path.end(), [&](std::uint32_t vertex) { places.erase(vertex); });
            path.erase(first + 1, path.end());
        }
    }
    std::optional<std::size_t> takeFrom(std::uint32_t vertex) {
        auto at = static_cast<std::size_t>(
            std::ranges::lower_bound(directed_, std::array<std::uint32_t, 2>{vertex, 0}) - directed_.begin());
        for (; at < directed_.size() && directed_[at][0] == vertex; ++at) {
            if (!taken_[at]) {
                taken_[at] = true;
                return at;
            }
        }
        return {};
    }

    std::vector<std::array<std::uint32_t, 2>> directed_;
    std::vector<bool> taken_;
};

} // namespace

template <class Number> std::vector<std::uint32_t> weldedVertices(std::span<const Number> positions) {
    const std::size_t count = positions.size() / 3;
    const auto at = [&](std::uint32_t vertex) {
        const Number* from = positions.data() + std::size_t{3} * vertex;
        return std::array<Number, 3>{from[0], from[1], from[2]};
    };
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const auto placeA = at(a);
        const auto placeB = at(b);
        return placeA != placeB ? placeA < placeB : a < b;
    });
    std::vector<std::uint32_t> welded(count);
    for (std::size_t i = 0; i < count; ++i) {
        const bool same = i > 0 && at(order[i]) == at(order[i - 1]);
        welded[order[i]] = same ? welded[order[i - 1]] : order[i];
    }
    return welded;
}
template std::vector<std::uint32_t> weldedVertices(std::span<const float> positions);
template std::vector<std::uint32_t> weldedVertices(std::span<const double> positions);

SurfaceHoles findHoles(std::span<const std::uint32_t> indices) {
    SurfaceHoles found;
    const std::vector<Edge> edges = edgesOf(indices);
    std::vector<std::array<std::uint32_t, 2>> open;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i;
        std::int32_t sum = 0;
        for (; end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b; ++end) {
            sum += edges[end].up;
        }
        found.nonManifold += end - i > 2 ? 1 : 0;
        for (std::int32_t left = sum; left > 0; --left) {
            open.push_back({edges[i].a, edges[i].b});
        }
        for (std::int32_t left = sum; left < 0; ++left) {
            open.push_back({edges[i].b, edges[i].a});
        }
        i = end;
    }
    found.openEdges = static_cast<std::uint32_t>(open.size());
    found.loops = LoopWalk(std::move(open)).loops();
    return found;
}

} // namespace voxtact

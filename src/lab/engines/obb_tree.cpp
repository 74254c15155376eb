// SPDX-License-Identifier: MIT
#include "lab/engines/obb_tree.h"
#include "lab/engines/principal_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace voxtact {

namespace {

/// Covers, relative to the box, the rounding of projections and of axes that are not quite at right angles.
constexpr double kOutward = 0x1p-40;

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Visit>
void visitVertices(const MeshView& mesh, std::span<const std::uint32_t> triangles, Visit&& visit) {
    for (const std::uint32_t triangle : triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            visit(vertexOf(mesh, triangle, corner));
        }
    }
}

void fitBox(const MeshView& mesh, std::span<const std::uint32_t> triangles, ObbNode& node) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    node.axes = principalAxes(mesh, triangles);
    Vec3 lo{kInfinity, kInfinity, kInfinity};
    Vec3 hi{-kInfinity, -kInfinity, -kInfinity};
    visitVertices(mesh, triangles, [&](const Vec3& vertex) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = dot(node.axes[axis], vertex);
            lo[axis] = std::min(lo[axis], at);
            hi[axis] = std::max(hi[axis], at);
        }
    });
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            node.centre[row] += (lo[axis] + hi[axis]) / 2 * node.axes[axis][row];
        }
    }
    // Sides are measured from the centre as it is rounded.
    double farthest = 0; // squared
    visitVertices(mesh, triangles, [&](const Vec3& vertex) {
        const Vec3 from{vertex[0] - node.centre[0], vertex[1] - node.centre[1], vertex[2] - node.centre[2]};
        farthest = std::max(farthest, dot(from, from));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.half[axis] = std::max(node.half[axis], std::abs(dot(node.axes[axis], from)));
        }
    });
    for (double& half : node.half) {
        half += std::sqrt(farthest) * kOutward;
    }
}

class Builder {
  public:
    explicit Builder(const MeshView& mesh) : mesh_(mesh), centroids_(mesh.indices.size() / 3) {
        for (std::uint32_t triangle = 0; triangle < centroids_.size(); ++triangle) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Vec3 vertex = vertexOf(mesh, triangle, corner);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    centroids_[triangle][axis] += vertex[axis] / 3;
                }
            }
        }
        tree_.triangles.resize(centroids_.size());
        std::iota(tree_.triangles.begin(), tree_.triangles.end(), 0U);
        tree_.nodes.reserve(2 * centroids_.size() - 1);
    }

    /// With a stack of its own: the depth of a tree is the mesh's choice.
    ObbTree build() {
        struct Part {
            std::uint32_t first;
            std::uint32_t count;
        };
        std::vector<Part> waiting{{0, static_cast<std::uint32_t>(tree_.triangles.size())}};
        while (!waiting.empty()) {
            const Part part = waiting.back();
            waiting.pop_back();
            const std::span<std::uint32_t> triangles = std::span(tree_.triangles).subspan(part.first, part.count);
            ObbNode& node = tree_.nodes.emplace_back();
            node.firstTriangle = part.first;
            node.triangleCount = part.count;
            fitBox(mesh_, triangles, node);
            if (part.count > kObbLeafTriangles) {
                const std::uint32_t left = split(node, triangles);
                waiting.push_back({part.first + left, part.count - left});
                waiting.push_back({part.first, left});
            }
        }
        linkNodes();
        return std::move(tree_);
    }

  private:
    /// Puts the left child's triangles first. Returns their number: neither 0 nor all.
    std::uint32_t split(const ObbNode& node, std::span<std::uint32_t> triangles) const {
        std::array<std::size_t, 3> byLength{0, 1, 2};
        std::stable_sort(byLength.begin(), byLength.end(),
                         [&](std::size_t a, std::size_t b) { return node.half[a] > node.half[b]; });
        for (const std::size_t axis : byLength) {
            const Vec3& along = node.axes[axis];
            double mean = 0;
            for (const std::uint32_t triangle : triangles) {
                mean += dot(along, centroids_[triangle]) / static_cast<double>(triangles.size());
            }
            const auto middle = std::stable_partition(triangles.begin(), triangles.end(), [&](std::uint32_t triangle) {
                return dot(along, centroids_[triangle]) < mean;
            });
            if (middle != triangles.begin() && middle != triangles.end()) {
                return static_cast<std::uint32_t>(middle - triangles.begin());
            }
        }
        return static_cast<std::uint32_t>(triangles.size() / 2);
    }

    /// From the last to the first: children before their parents.
    void linkNodes() {
        for (auto at = static_cast<std::uint32_t>(tree_.nodes.size()); at-- > 0;) {
            ObbNode& node = tree_.nodes[at];
            node.next = at + 1;
            if (node.triangleCount > kObbLeafTriangles) {
                const std::uint32_t right = tree_.nodes[at + 1].next;
                node.next = tree_.nodes[right].next;
            }
        }
    }

    const MeshView& mesh_;
    std::vector<Vec3> centroids_;
    ObbTree tree_;
};

} // namespace

ObbTree makeObbTree(const MeshView& mesh) {
    return Builder(mesh).build();
}

} // namespace voxtact

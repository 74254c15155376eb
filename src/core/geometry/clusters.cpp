// SPDX-License-Identifier: MIT
#include "core/geometry/clusters.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace voxtact {

namespace {

using Point = std::array<float, 3>;

struct PointBounds {
    Point lo;
    Point hi;
};

Point vertexAt(const FloatMesh& mesh, std::uint32_t vertex) {
    const float* at = mesh.positions.data() + std::size_t{3} * vertex;
    return {at[0], at[1], at[2]};
}

template <class Range, class PointOf> PointBounds boundsOf(const Range& range, const PointOf& pointOf) {
    PointBounds bounds{pointOf(range.front()), pointOf(range.front())};
    for (const std::uint32_t element : range) {
        const Point point = pointOf(element);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds.lo[axis] = std::min(bounds.lo[axis], point[axis]);
            bounds.hi[axis] = std::max(bounds.hi[axis], point[axis]);
        }
    }
    return bounds;
}

class Splitter {
  public:
    Splitter(const FloatMesh& mesh, MeshClusters& out) : mesh_(mesh), out_(out), centroids_(mesh.indices.size() / 3) {
        for (std::size_t i = 0; i < centroids_.size(); ++i) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Point point = vertexAt(mesh, mesh.indices[3 * i + corner]);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    centroids_[i][axis] += point[axis] / 3;
                }
            }
        }
    }

    void split(std::span<std::uint32_t> triangles) {
        if (triangles.size() <= kClusterTriangles) {
            sortRuns(triangles);
            emit(triangles);
            return;
        }
        const std::size_t left = halve(triangles, kClusterTriangles);
        split(triangles.first(left));
        split(triangles.subspan(left));
    }

  private:
    /// Moves the smaller centroids along the longest axis to the left, in whole groups of `group`, so that only the
    /// last group is not full. Returns their number.
    std::size_t halve(std::span<std::uint32_t> triangles, std::size_t group) const {
        const std::size_t axis = longestAxis(triangles);
        const std::size_t groups = (triangles.size() + group - 1) / group;
        const std::size_t left = groups / 2 * group;
        const auto middle = triangles.begin() + static_cast<std::ptrdiff_t>(left);
        std::nth_element(triangles.begin(), middle, triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
            return centroids_[a][axis] != centroids_[b][axis] ? centroids_[a][axis] < centroids_[b][axis] : a < b;
        });
        return left;
    }

    /// Ascending numbers within each run.
    void sortRuns(std::span<std::uint32_t> triangles) const {
        if (triangles.size() <= kRunTriangles) {
            std::sort(triangles.begin(), triangles.end());
            return;
        }
        const std::size_t left = halve(triangles, kRunTriangles);
        sortRuns(triangles.first(left));
        sortRuns(triangles.subspan(left));
    }

    [[nodiscard]] std::size_t longestAxis(std::span<const std::uint32_t> triangles) const {
        const PointBounds bounds = boundsOf(triangles, [&](std::uint32_t triangle) { return centroids_[triangle]; });
        std::size_t longest = 0;
        for (std::size_t axis = 1; axis < 3; ++axis) {
            if (bounds.hi[axis] - bounds.lo[axis] > bounds.hi[longest] - bounds.lo[longest]) {
                longest = axis;
            }
        }
        return longest;
    }

    void emit(std::span<std::uint32_t> triangles) {
        std::vector<std::uint32_t> vertices;
        for (const std::uint32_t triangle : triangles) {
            const auto first = mesh_.indices.begin() + 3 * static_cast<std::ptrdiff_t>(triangle);
            vertices.insert(vertices.end(), first, first + 3);
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        const PointBounds bounds = boundsOf(vertices, [&](std::uint32_t vertex) { return vertexAt(mesh_, vertex); });
        out_.clusters.push_back({static_cast<std::uint32_t>(out_.corners.size()),
                                 static_cast<std::uint32_t>(triangles.size()),
                                 static_cast<std::uint32_t>(out_.vertices.size()),
                                 static_cast<std::uint32_t>(vertices.size()), bounds.lo, bounds.hi});
        for (const std::uint32_t triangle : triangles) {
            std::array<std::uint8_t, 3> corners{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const auto at = std::lower_bound(vertices.begin(), vertices.end(),
                                                 mesh_.indices[std::size_t{3} * triangle + corner]);
                corners[corner] = static_cast<std::uint8_t>(at - vertices.begin());
            }
            out_.corners.push_back(corners);
        }
        out_.vertices.insert(out_.vertices.end(), vertices.begin(), vertices.end());
    }

    const FloatMesh& mesh_;
    MeshClusters& out_;
    std::vector<Point> centroids_;
};

} // namespace

void grow(RunBox& box, const RunBox& by) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], by.lo[axis]);
        box.hi[axis] = std::max(box.hi[axis], by.hi[axis]);
    }
}

std::vector<RunBox> runBoxes(const FloatMesh& mesh, const MeshClusters& clusters) {
    std::vector<RunBox> runs;
    // All clusters but the last are full: runs are not cut by their ends.
    for (std::size_t i = 0; i < clusters.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Point point = vertexAt(mesh, mesh.indices[std::size_t{3} * clusters.triangles[i] + corner]);
            if (i % kRunTriangles == 0 && corner == 0) {
                runs.push_back({point, point});
            }
            grow(runs.back(), {point, point});
        }
    }
    return runs;
}

MeshClusters makeClusters(const FloatMesh& mesh) {
    MeshClusters out;
    out.triangles.resize(mesh.indices.size() / 3);
    std::iota(out.triangles.begin(), out.triangles.end(), 0U);
    Splitter(mesh, out).split(out.triangles);
    return out;
}

} // namespace voxtact

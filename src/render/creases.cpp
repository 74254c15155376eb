// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/mesh_vertex.h"
#include "voxtact/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace voxtact {

namespace {

constexpr double kStraightAngle = 180;

/// Unit length; zero where there is no area.
std::vector<Vec3> unitNormals(const MeshView& mesh) {
    std::vector<Vec3> normals(mesh.indices.size() / 3);
    for (std::size_t triangle = 0; triangle < normals.size(); ++triangle) {
        const Vec3 a = vertexOf(mesh, mesh.indices[3 * triangle]);
        const Vec3 b = vertexOf(mesh, mesh.indices[3 * triangle + 1]);
        const Vec3 c = vertexOf(mesh, mesh.indices[3 * triangle + 2]);
        const Vec3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const Vec3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
        const Vec3 normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        const double size = std::hypot(normal[0], normal[1], normal[2]);
        for (std::size_t axis = 0; axis < 3 && size > 0; ++axis) {
            normals[triangle][axis] = normal[axis] / size;
        }
    }
    return normals;
}

/// The corners of triangles, by their vertex: those of vertex v are order[first[v]] to before order[first[v + 1]].
struct CornersOfVertices {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> order;

    explicit CornersOfVertices(const MeshView& mesh)
        : first(mesh.positions.size() / 3 + 1), order(mesh.indices.size()) {
        for (const std::uint32_t vertex : mesh.indices) {
            ++first[vertex + 1];
        }
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<std::size_t> next = first;
        for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
            order[next[mesh.indices[corner]]++] = static_cast<std::uint32_t>(corner);
        }
    }
};

/// The corners of one vertex, in groups: corners that share an edge without a crease are in the same group.
class SmoothGroups {
  public:
    SmoothGroups(const MeshView& mesh, std::span<const Vec3> normals, double leastCosine)
        : mesh_(mesh), normals_(normals), leastCosine_(leastCosine) {}

    /// For each corner, the index of the first corner of its group.
    std::span<const std::uint32_t> of(std::span<const std::uint32_t> corners) {
        groups_.resize(corners.size());
        std::iota(groups_.begin(), groups_.end(), 0U);
        edges_.clear();
        for (std::uint32_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t triangle = corners[i] / 3;
            const std::uint32_t corner = corners[i] % 3;
            edges_.push_back({mesh_.indices[3 * std::size_t{triangle} + (corner + 1) % 3], i});
            edges_.push_back({mesh_.indices[3 * std::size_t{triangle} + (corner + 2) % 3], i});
        }
        std::ranges::sort(edges_);
        for (std::size_t i = 1; i < edges_.size(); ++i) {
            const auto [end, one] = edges_[i - 1];
            const auto [otherEnd, other] = edges_[i];
            if (end == otherEnd && isSmooth(corners[one] / 3, corners[other] / 3)) {
                join(one, other);
            }
        }
        for (std::uint32_t i = 0; i < groups_.size(); ++i) {
            groups_[i] = find(i);
        }
        return groups_;
    }

  private:
    [[nodiscard]] bool isSmooth(std::uint32_t triangle, std::uint32_t other) const {
        const Vec3& a = normals_[triangle];
        const Vec3& b = normals_[other];
        // Rounding may leave the range of cosines.
        return std::clamp(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], -1.0, 1.0) >= leastCosine_;
    }
    [[nodiscard]] std::uint32_t find(std::uint32_t corner) const {
        while (groups_[corner] != corner) {
            corner = groups_[corner];
        }
        return corner;
    }
    void join(std::uint32_t one, std::uint32_t other) {
        const std::uint32_t a = find(one);
        const std::uint32_t b = find(other);
        groups_[std::max(a, b)] = std::min(a, b);
    }

    MeshView mesh_;
    std::span<const Vec3> normals_;
    double leastCosine_;
    std::vector<std::uint32_t> groups_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_; ///< the edge's other vertex, and the corner's place
};

/// Gives the corners of a vertex that are not in its first group vertices of their own.
void splitVertex(MeshData& mesh, std::uint32_t vertex, std::span<const std::uint32_t> corners,
                 std::span<const std::uint32_t> groups) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (groups[i] == 0) {
            continue;
        }
        if (groups[i] == i) {
            mesh.indices[corners[i]] = static_cast<std::uint32_t>(mesh.positions.size() / 3);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                mesh.positions.push_back(mesh.positions[std::size_t{3} * vertex + axis]);
            }
        } else {
            mesh.indices[corners[i]] = mesh.indices[corners[groups[i]]];
        }
    }
}

} // namespace

Result<MeshData> splitAtCreases(const MeshView& mesh, double degrees) {
    return guard([&]() -> Result<MeshData> {
        if (!(degrees >= 0 && degrees <= kStraightAngle)) {
            return refuse("the angle of creases " + number(degrees) + " is outside [0, 180] degrees");
        }
        VOXTACT_TRY(checkMesh(mesh));
        const std::vector<Vec3> normals = unitNormals(mesh);
        const CornersOfVertices all(mesh);
        SmoothGroups groups(mesh, normals, std::cos(degrees * std::numbers::pi / kStraightAngle));
        MeshData out;
        out.positions.assign(mesh.positions.begin(), mesh.positions.end());
        out.indices.assign(mesh.indices.begin(), mesh.indices.end());
        for (std::uint32_t vertex = 0; vertex + 1 < all.first.size(); ++vertex) {
            const std::span<const std::uint32_t> corners =
                std::span(all.order).subspan(all.first[vertex], all.first[vertex + 1] - all.first[vertex]);
            splitVertex(out, vertex, corners, groups.of(corners));
        }
        // The result may have too many vertices for a mesh.
        VOXTACT_TRY(checkMesh(out.view()));
        return out;
    });
}

} // namespace voxtact

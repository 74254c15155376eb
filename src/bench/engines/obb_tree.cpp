// SPDX-License-Identifier: MIT
#include "bench/engines/obb_tree.h"

#include "core/base/infinity.h"
#include "core/geometry/glm_bridge.h"
#include "core/geometry/mesh_vertex.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

namespace voxtact {

namespace {

using glm::dmat3;
using glm::dvec3;
using Triangles = std::span<const std::uint32_t>;

/// Covers, relative to the box, the rounding of projections and of axes that are not quite at right angles.
constexpr double kOutward = 0x1p-40;

dvec3 cornerOf(const MeshView& mesh, std::uint32_t triangle, std::size_t corner) {
    return toGlm(vertexOf(mesh, mesh.indices[std::size_t{3} * triangle + corner]));
}

template <class Visit> void visitVertices(const MeshView& mesh, Triangles triangles, Visit&& visit) {
    for (const std::uint32_t triangle : triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            visit(cornerOf(mesh, triangle, corner));
        }
    }
}

/// By area, with the sum 1; alike where no triangle has any.
std::vector<double> weightsOf(const MeshView& mesh, Triangles triangles) {
    std::vector<double> weights;
    weights.reserve(triangles.size());
    for (const std::uint32_t triangle : triangles) {
        const dvec3 at = cornerOf(mesh, triangle, 0);
        const dvec3 across = glm::cross(cornerOf(mesh, triangle, 1) - at, cornerOf(mesh, triangle, 2) - at);
        weights.push_back(glm::length(across) / 2); // no float's fourth power is too large or small for a double
    }
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) {
        weight = total > 0 ? weight / total : 1 / static_cast<double>(triangles.size());
    }
    return weights;
}

dmat3 covarianceOf(const MeshView& mesh, Triangles triangles) {
    const std::vector<double> weights = weightsOf(mesh, triangles);
    dvec3 mean(0);
    std::size_t corners = 0;
    visitVertices(mesh, triangles, [&](const dvec3& vertex) { mean += weights[corners++ / 3] / 3 * vertex; });
    dmat3 covariance(0);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const double weight = weights[i] / 12;
        dvec3 sum(0);
        visitVertices(mesh, triangles.subspan(i, 1), [&](const dvec3& vertex) {
            sum += vertex - mean;
            covariance += glm::outerProduct(weight * (vertex - mean), vertex - mean);
        });
        // The integral over a triangle with the corners p, q, r and the centroid m is
        // area / 12 * (9 m m' + p p' + q q' + r r').
        covariance += glm::outerProduct(weight * sum, sum);
    }
    return covariance;
}

/// Turns the plane of axes p and q so that the symmetric matrix has a zero at (p, q) (Golub, Van Loan, "Matrix
/// Computations", section 8.5). The columns of `turned` follow.
void rotate(dmat3& matrix, dmat3& turned, glm::length_t p, glm::length_t q) {
    const double ratio = (matrix[q][q] - matrix[p][p]) / (2 * matrix[p][q]);
    const double tangent = std::copysign(1 / (std::abs(ratio) + std::hypot(ratio, 1.0)), ratio);
    const double cosine = 1 / std::hypot(tangent, 1.0);
    const double sine = tangent * cosine;
    const auto turn = [&](auto& a, auto& b) {
        const auto old = a;
        a = cosine * a - sine * b;
        b = sine * old + cosine * b;
    };
    for (glm::length_t i = 0; i < 3; ++i) {
        turn(matrix[i][p], matrix[i][q]);
    }
    turn(matrix[p], matrix[q]);
    turn(turned[p], turned[q]);
}

/// Columns: the directions in which some triangles spread, each triangle with the weight of its area (section 4 of the
/// paper, but of the surface itself and not of its convex hull). The eigenvectors of the covariance, by Jacobi's
/// method: it converges quadratically, so that a few sweeps do, and whatever is left when it stops makes a box larger,
/// not wrong.
dmat3 principalAxes(const MeshView& mesh, Triangles triangles) {
    constexpr int kSweeps = 12;
    constexpr double kNothing = 0x1p-50;
    dmat3 matrix = covarianceOf(mesh, triangles);
    dmat3 turned(1);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
            if (std::abs(matrix[p][q]) > kNothing * (std::abs(matrix[p][p]) + std::abs(matrix[q][q]))) {
                rotate(matrix, turned, p, q);
            }
        }
    }
    return turned;
}

void fitBox(const MeshView& mesh, Triangles triangles, ObbNode& node) {
    const dmat3 axes = principalAxes(mesh, triangles);
    dvec3 lo(kInfinity);
    dvec3 hi(-lo);
    visitVertices(mesh, triangles, [&](const dvec3& vertex) {
        lo = glm::min(lo, vertex * axes);
        hi = glm::max(hi, vertex * axes);
    });
    const dvec3 centre = axes * ((lo + hi) / 2.0);
    // Sides are measured from the centre as it is rounded.
    double farthest = 0; // squared
    dvec3 half(0);
    visitVertices(mesh, triangles, [&](const dvec3& vertex) {
        farthest = std::max(farthest, glm::dot(vertex - centre, vertex - centre));
        half = glm::max(half, glm::abs((vertex - centre) * axes));
    });
    half += std::sqrt(farthest) * kOutward;
    node.axes = {fromGlm(axes[0]), fromGlm(axes[1]), fromGlm(axes[2])};
    node.centre = fromGlm(centre);
    node.half = fromGlm(half);
}

std::vector<dvec3> centroidsOf(const MeshView& mesh, Triangles all) {
    std::vector<dvec3> centroids(all.size(), dvec3(0));
    std::size_t corners = 0;
    visitVertices(mesh, all, [&](const dvec3& vertex) { centroids[corners++ / 3] += vertex / 3.0; });
    return centroids;
}

/// Puts the left child's triangles first. Returns their number: neither 0 nor all.
std::uint32_t split(const ObbNode& node, std::span<const dvec3> centroids, std::span<std::uint32_t> triangles) {
    std::array<std::size_t, 3> byLength{0, 1, 2};
    std::ranges::stable_sort(byLength, std::greater{}, [&](std::size_t axis) { return node.half[axis]; });
    for (const std::size_t axis : byLength) {
        const auto at = [&, along = toGlm(node.axes[axis])](std::uint32_t triangle) {
            return glm::dot(along, centroids[triangle]);
        };
        double mean = 0;
        for (const std::uint32_t triangle : triangles) {
            mean += at(triangle) / static_cast<double>(triangles.size());
        }
        const auto middle = std::stable_partition(triangles.begin(), triangles.end(),
                                                  [&](std::uint32_t triangle) { return at(triangle) < mean; });
        if (middle != triangles.begin() && middle != triangles.end()) {
            return static_cast<std::uint32_t>(middle - triangles.begin());
        }
    }
    return static_cast<std::uint32_t>(triangles.size() / 2);
}

/// From the last to the first: children before their parents.
void linkNodes(std::vector<ObbNode>& nodes) {
    for (auto at = static_cast<std::uint32_t>(nodes.size()); at-- > 0;) {
        const bool leaf = nodes[at].triangleCount <= kObbLeafTriangles;
        nodes[at].next = leaf ? at + 1 : nodes[nodes[at + 1].next].next;
    }
}

/// Error of the sums below, relative to the sum of the magnitudes of their terms: some thirty roundings of 2^-53.
constexpr double kError = 0x1p-46;
/// Except for underflow.
constexpr double kTiny = 1e-290;

/// A parallelepiped and a box along the axes, relative to the box's centre.
struct Meeting {
    dvec3 offset;    ///< from the box's centre to the parallelepiped's
    dmat3 edges;     ///< half of them
    dvec3 half;      ///< of the box
    dvec3 magnitude; ///< along each axis, of everything that went into these

    Meeting(const ObbNode& node, const Mat4& matrix, const Box& box) : half(toGlm(box.hi) / 2.0 - toGlm(box.lo) / 2.0) {
        const glm::dmat4 affine = toGlm(matrix);
        const dvec3 translated(affine[3]);
        const dmat3 linear(affine);
        const dmat3 magnitudes(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2]));
        const dvec3 centre = toGlm(node.centre);
        offset = translated + linear * centre - (toGlm(box.lo) / 2.0 + toGlm(box.hi) / 2.0);
        magnitude =
            glm::abs(translated) + glm::abs(toGlm(box.lo)) + glm::abs(toGlm(box.hi)) + magnitudes * glm::abs(centre);
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec3 edge = node.half[i] * toGlm(node.axes[i]);
            edges[static_cast<glm::length_t>(i)] = linear * edge;
            magnitude += magnitudes * glm::abs(edge);
        }
    }

    /// Returns true if a plane across `axis`, whose own rounding does not matter, certainly separates them.
    [[nodiscard]] bool separatedAlong(const dvec3& axis) const {
        const dvec3 across = glm::abs(axis * edges);
        const double reach =
            kTiny + glm::dot(glm::abs(axis), half + kError * magnitude) + across[0] + across[1] + across[2];
        return std::abs(glm::dot(axis, offset)) > reach;
    }
};

} // namespace

Mat4 frameOf(const ObbNode& node) noexcept {
    Mat4 object_from_box = translation(node.centre);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            object_from_box[4 * axis + row] = node.half[axis] * node.axes[axis][row];
        }
    }
    return object_from_box;
}

ObbTree makeObbTree(const MeshView& mesh) {
    ObbTree tree;
    tree.triangles.resize(mesh.indices.size() / 3);
    std::iota(tree.triangles.begin(), tree.triangles.end(), 0U);
    tree.nodes.reserve(2 * tree.triangles.size() - 1);
    const std::vector<dvec3> centroids = centroidsOf(mesh, tree.triangles);
    // A stack of its own: the depth of a tree is the mesh's choice. The first of its triangles, and how many.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting{
        {0, static_cast<std::uint32_t>(tree.triangles.size())}};
    while (!waiting.empty()) {
        const auto [first, count] = waiting.back();
        waiting.pop_back();
        const std::span<std::uint32_t> triangles = std::span(tree.triangles).subspan(first, count);
        ObbNode& node = tree.nodes.emplace_back();
        node.firstTriangle = first;
        node.triangleCount = count;
        fitBox(mesh, triangles, node);
        if (count > kObbLeafTriangles) {
            const std::uint32_t left = split(node, centroids, triangles);
            waiting.emplace_back(first + left, count - left);
            waiting.emplace_back(first, left);
        }
    }
    linkNodes(tree.nodes);
    return tree;
}

bool obbMeetsBox(const ObbNode& node, const Mat4& texture_from_object, const Box& box) noexcept {
    const Meeting meeting(node, texture_from_object, box);
    const dmat3 units(1);
    for (glm::length_t i = 0; i < 3; ++i) {
        if (meeting.separatedAlong(units[i]) ||
            meeting.separatedAlong(glm::cross(meeting.edges[(i + 1) % 3], meeting.edges[(i + 2) % 3]))) {
            return false;
        }
        for (glm::length_t edge = 0; edge < 3; ++edge) {
            if (meeting.separatedAlong(glm::cross(units[i], meeting.edges[edge]))) {
                return false;
            }
        }
    }
    return true;
}

} // namespace voxtact

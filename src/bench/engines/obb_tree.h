// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact {

inline constexpr std::uint32_t kObbLeafTriangles = 1;

/// A box at any angle around some triangles, in object space: centre + sum of s[i] * half[i] * axes[i], s in [-1,1].
/// Every corner of its triangles is within.
struct ObbNode {
    Vec3 centre{};
    std::array<Vec3, 3> axes{};      ///< unit vectors, at right angles but for rounding
    Vec3 half{};                     ///< rounded outward
    std::uint32_t firstTriangle = 0; ///< in ObbTree::triangles
    std::uint32_t triangleCount = 0; ///< a leaf has at most kObbLeafTriangles
    std::uint32_t next = 0;          ///< the first node that is not below this one; that of a leaf is the one after it
};

/// object_from_box, of a box from -1 to 1 along each axis.
[[nodiscard]] Mat4 frameOf(const ObbNode& node) noexcept;

/// Parents come before their children and left before right: the left child follows its parent, and the right child
/// is the left one's `next`.
struct ObbTree {
    std::vector<ObbNode> nodes;
    std::vector<std::uint32_t> triangles; ///< numbers in the mesh, each once
};

/// Top down: the axes of each box where its triangles spread, by area; split at the mean of the centroids along its
/// longest side, or a shorter one, and in halves where all centroids are alike (Gottschalk, Lin, Manocha, "OBBTree",
/// SIGGRAPH 1996, section 4). The same mesh gives the same tree. Expects a mesh that checkMesh() accepts.
[[nodiscard]] ObbTree makeObbTree(const MeshView& mesh);

/// Tests whether a node's box under an affine matrix, which may stretch and shear, meets a closed box (lo <= hi),
/// usually in texture space. Separating axes (section 5 of the same paper), with margins for rounding: false only if
/// they are certainly disjoint.
[[nodiscard]] bool obbMeetsBox(const ObbNode& node, const Mat4& texture_from_object, const Box& box) noexcept;

/// The triangles of the leaves that `meets(node)` accepts together with every node above them, in the tree's order.
template <class Meets> std::vector<std::uint32_t> touchingTriangles(const ObbTree& tree, Meets&& meets) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t at = 0; at < tree.nodes.size();) {
        const ObbNode& node = tree.nodes[at];
        if (!meets(node)) {
            at = node.next;
            continue;
        }
        if (node.triangleCount <= kObbLeafTriangles) {
            const auto first = tree.triangles.begin() + static_cast<std::ptrdiff_t>(node.firstTriangle);
            found.insert(found.end(), first, first + static_cast<std::ptrdiff_t>(node.triangleCount));
        }
        ++at;
    }
    return found;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "cpu/scene/cluster_tree.h"

#include <algorithm>

namespace voxtact::cpu {

namespace {

void grow(RunBox& box, const RunBox& by) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], by.lo[axis]);
        box.hi[axis] = std::max(box.hi[axis], by.hi[axis]);
    }
}

RunBox boxOf(const MeshView& mesh, std::uint32_t triangle) {
    const auto vertex = [&](std::size_t corner) {
        const float* at = mesh.positions.data() + std::size_t{3} * mesh.indices[std::size_t{3} * triangle + corner];
        const std::array<float, 3> point{at[0], at[1], at[2]};
        return RunBox{point, point};
    };
    RunBox box = vertex(0);
    grow(box, vertex(1));
    grow(box, vertex(2));
    return box;
}

} // namespace

ClusterTree::ClusterTree(const MeshView& mesh, const MeshClusters& clusters) {
    std::vector<RunBox> level;
    // All clusters but the last are full: runs are not cut by their ends.
    for (std::size_t i = 0; i < clusters.triangles.size(); ++i) {
        const RunBox box = boxOf(mesh, clusters.triangles[i]);
        if (i % kRunTriangles == 0) {
            level.push_back(box);
        }
        grow(level.back(), box);
    }
    levels_.push_back(level);
    while (level.size() > kFanOut) {
        std::vector<RunBox> above;
        for (std::size_t i = 0; i < level.size(); ++i) {
            if (i % kFanOut == 0) {
                above.push_back(level[i]);
            }
            grow(above.back(), level[i]);
        }
        level = above;
        levels_.push_back(std::move(above));
    }
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#include "host/scene/cluster_tree.h"

#include <algorithm>
#include <utility>

namespace voxtact::cpu {

ClusterTree::ClusterTree(std::vector<RunBox> runs) {
    std::vector<RunBox> level = std::move(runs);
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

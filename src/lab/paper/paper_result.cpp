// SPDX-License-Identifier: MIT
#include "lab/paper/paper_result.h"

namespace voxtact::lab {

namespace {

/// Of each two samples of one round.
template <class Percent>
std::vector<double> paired(const std::vector<double>& rendering, const std::vector<double>& other, Percent percent) {
    std::vector<double> out;
    if (rendering.size() != other.size()) {
        return out;
    }
    for (std::size_t i = 0; i < other.size(); ++i) {
        // A clock may be so coarse that a small picture takes no time.
        if (rendering[i] > 0) {
            out.push_back(percent(rendering[i], other[i]));
        }
    }
    return out;
}

} // namespace

std::vector<double> collisionPercent(const PaperColumns& columns) {
    return paired(columns.rendering, columns.collision,
                  [](double rendering, double collision) { return 100 * collision / rendering; });
}

std::vector<double> overheadPercent(const PaperColumns& columns) {
    return paired(columns.rendering, columns.total,
                  [](double rendering, double total) { return 100 * (total - rendering) / rendering; });
}

} // namespace voxtact::lab

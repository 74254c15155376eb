// SPDX-License-Identifier: MIT
#include "host/search/opaque_next_to.h"

#include "core/geometry/glm_bridge.h"
#include "host/search/nearest_point.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

using glm::dvec3;

Vec3 opaqueNextTo(const PairAt& at, const Vec3& witness) {
    constexpr double kRounding = 0x1p-21; // of the image's sides
    const VolumeSpace& space = at.part.space;
    const dvec3 voxel = space.toVoxel(toGlm(witness) - space.middle);
    dvec3 reach{};
    NodePlace padded{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        const double cell = std::floor(voxel[axis] + space.centre[axis]) + 1;
        const double size = at.volume().image.size[i];
        padded[i] = static_cast<std::int32_t>(std::clamp(cell, 0.0, size));
        reach[axis] = 2 * kRounding * size;
    }
    const PartCell cell = at.part.cell(at.volume(), padded);
    const dvec3 lo = cell.domain - cell.half;
    const dvec3 hi = cell.domain + cell.half;
    dvec3 place = glm::clamp(2.0 * (voxel - cell.middle), lo, hi);
    const CellRegion region{glm::max(lo, place - reach), glm::min(hi, place + reach)};
    const bool opaque = goToOpaque(at.part, cell, region, place);
    return opaque ? fromGlm(space.toWorld(cell.middle + 0.5 * place) + space.middle) : witness;
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#include "core/geometry/pair_transform.h"
#include "core/geometry/wide_matrix.h"

#include <cmath>

namespace voxtact {

shader::PairTransform pairTransform(const Mat4& clip_from_world, const Mat4& world_from_object,
                                    const Mat4& texture_from_world) noexcept {
    return shader::pairTransformOf(toWide(clip_from_world), toWide(texture_from_world), toWide(world_from_object));
}

shader::ItemConstants itemConstants(double valueSlope, double valueIntercept, const ValueRange& domain,
                                    double threshold) noexcept {
    const double width = domain.hi - domain.lo;
    return {static_cast<float>(valueSlope / width), static_cast<float>((valueIntercept - domain.lo) / width),
            static_cast<float>(threshold), 0};
}

bool areSingle(const shader::ItemConstants& constants) noexcept {
    return std::isfinite(constants.scalarScale) && constants.scalarScale != 0 && std::isfinite(constants.scalarBias);
}

} // namespace voxtact

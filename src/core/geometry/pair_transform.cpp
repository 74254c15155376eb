// SPDX-License-Identifier: MIT
#include "core/geometry/pair_transform.h"

namespace voxtact {

namespace {

shader::vec4 row(const Mat4& matrix, std::size_t index) {
    return {static_cast<float>(matrix[index]), static_cast<float>(matrix[4 + index]),
            static_cast<float>(matrix[8 + index]), static_cast<float>(matrix[12 + index])};
}

} // namespace

shader::PairTransform pairTransform(const Mat4& clip_from_world, const Mat4& world_from_object,
                                    const Mat4& texture_from_world) noexcept {
    const Mat4 clip_from_object = multiply(clip_from_world, world_from_object);
    const Mat4 texture_from_object = multiply(texture_from_world, world_from_object);
    shader::PairTransform out{};
    for (std::size_t i = 0; i < 4; ++i) {
        out.clip_from_object[i] = row(clip_from_object, i);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        out.texture_from_object[i] = row(texture_from_object, i);
    }
    return out;
}

shader::ItemConstants itemConstants(double valueSlope, double valueIntercept, const ValueRange& domain,
                                    double threshold) noexcept {
    const double width = domain.hi - domain.lo;
    return {static_cast<float>(valueSlope / width), static_cast<float>((valueIntercept - domain.lo) / width),
            static_cast<float>(threshold), 0};
}

} // namespace voxtact

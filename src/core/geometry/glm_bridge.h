// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace voxtact {

/// glm and Mat4 are both column-major.
inline glm::dmat4 toGlm(const Mat4& matrix) {
    glm::dmat4 out;
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            out[c][r] = matrix[static_cast<std::size_t>(4 * c + r)];
        }
    }
    return out;
}

inline Mat4 fromGlm(const glm::dmat4& matrix) {
    Mat4 out{};
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            out[static_cast<std::size_t>(4 * c + r)] = matrix[c][r];
        }
    }
    return out;
}

inline glm::dvec3 toGlm(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

inline Vec3 fromGlm(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

} // namespace voxtact

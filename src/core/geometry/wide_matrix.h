// SPDX-License-Identifier: MIT
#pragma once

#include "exact/pair_setup.h"
#include "voxtact/data.h"

#include <algorithm>
#include <iterator>

namespace voxtact {

/// Returns a matrix in the form that shaders share.
[[nodiscard]] inline shader::WideMatrix toWide(const Mat4& matrix) noexcept {
    shader::WideMatrix out;
    std::copy(matrix.begin(), matrix.end(), out.element);
    return out;
}

[[nodiscard]] inline Mat4 toMat4(const shader::WideMatrix& matrix) noexcept {
    Mat4 out;
    std::copy(std::begin(matrix.element), std::end(matrix.element), out.begin());
    return out;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"
#include "voxtact/data.h"

/// Matrices as the shaders have them: by rows.
namespace voxtact {

[[nodiscard]] inline shader::vec4 rowOf(const Mat4& matrix, std::size_t row) {
    return {static_cast<float>(matrix[row]), static_cast<float>(matrix[4 + row]), static_cast<float>(matrix[8 + row]),
            static_cast<float>(matrix[12 + row])};
}

template <std::size_t Rows> void setRows(shader::vec4 (&rows)[Rows], const Mat4& matrix) {
    for (std::size_t row = 0; row < Rows; ++row) {
        rows[row] = rowOf(matrix, row);
    }
}

/// The part of an affine matrix that directions see.
[[nodiscard]] inline Mat4 linearPart(Mat4 matrix) {
    matrix[12] = matrix[13] = matrix[14] = 0;
    return matrix;
}

} // namespace voxtact

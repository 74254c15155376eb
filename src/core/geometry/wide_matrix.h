// SPDX-License-Identifier: MIT
#pragma once

#include "pair_setup.h"
#include "voxtact/data.h"

#include <algorithm>

namespace voxtact {

/// A matrix as the text that is shared with shaders has it.
[[nodiscard]] inline shader::WideMatrix toWide(const Mat4& matrix) noexcept {
    shader::WideMatrix out;
    std::copy(matrix.begin(), matrix.end(), out.element);
    return out;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "view/model/document.h"

#include <string>

namespace voxtact::view {

/// The line for a shell that gives the same answer: `voxtact detect` with everything that an answer depends on, and
/// the pose on its standard input. Files by their absolute paths. Holes are in no file: a
/// comment before the line says that they are missing. `device`: as --device takes it; empty: the default.
[[nodiscard]] std::string copyAsCommand(const Document& document, const MethodChoice& method,
                                        const std::string& device);

/// A text as one word of a shell.
[[nodiscard]] std::string shellWord(const std::string& text);

/// Sixteen numbers, row by row, as pose files have them; they read back as the same.
[[nodiscard]] std::string poseText(const Mat4& world_from_object);

} // namespace voxtact::view

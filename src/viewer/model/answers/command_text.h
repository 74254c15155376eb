// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <string>

namespace voxtact::view {

/// The line for a shell that gives the same answer for one of the document's instruments: `voxtact count` with
/// everything that an answer depends on, and the pose on its standard input. Files by their absolute paths. Holes are
/// in no file: a comment before the line says that they are missing. `device`: as --device takes it; empty: the
/// default.
[[nodiscard]] std::string commandFor(const Document& document, const Instrument& instrument, const MethodChoice& method,
                                     const std::string& device);

/// Returns the commands of all meshes, in order, one line each with its own poses, spaces and scales; comments once.
[[nodiscard]] std::string copyAsCommand(const Document& document, const MethodChoice& method,
                                        const std::string& device);

/// Quotes a text as one word of a shell.
[[nodiscard]] std::string shellWord(const std::string& text);

/// Returns sixteen numbers, row by row, like pose files; they read back unchanged.
[[nodiscard]] std::string poseText(const Mat4& world_from_object);

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <string>

/// Notes on implausible sizes of meshes, usually caused by a wrong unit.
namespace voxtact::app {

/// Returns the note on the size of a mesh at a pose, compared with a volume; empty if plausible.
[[nodiscard]] std::string sizeNote(const Box& object, const Mat4& world_from_object, const Grid& volume);
/// Returns the note on the size of a mesh alone, in mm.
[[nodiscard]] std::string unitHint(const Box& bounds);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <string>

/// What strikes in the size of a mesh: most often its unit is another one than was said.
namespace voxtact::app {

/// What a mesh in a box of object space is against a volume, under a pose; empty where nothing strikes.
[[nodiscard]] std::string sizeNote(const Box& object, const Mat4& world_from_object, const Grid& volume);
/// What a mesh of this size is by itself, in mm.
[[nodiscard]] std::string unitHint(const Box& bounds);

} // namespace voxtact::app

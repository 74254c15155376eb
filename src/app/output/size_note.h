// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <string>

/// What strikes in the size of a mesh: most often its unit is another one than was said.
namespace voxtact::app {

/// The length of a box's diagonal.
[[nodiscard]] double diagonal(const Box& box);
/// What a mesh so long is against a volume so long; empty where nothing strikes. Both in mm.
[[nodiscard]] std::string sizeNote(double mesh, double volume);
/// What a mesh of this size is by itself, in mm.
[[nodiscard]] std::string unitHint(const Box& bounds);

} // namespace voxtact::app

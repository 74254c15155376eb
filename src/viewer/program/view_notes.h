// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <string>
#include <vector>

namespace voxtact::app {

/// What strikes in what the window shows, as the commands would note it: the size of meshes that are there, a preset's
/// curve over values that are no Hounsfield units, a curve under which nothing is opaque.
[[nodiscard]] std::vector<std::string> windowNotes(const view::State& state);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <string>
#include <vector>

namespace voxtact::app {

/// Returns notes on the contents, like the commands: the size of meshes, a preset's curve on values that are not
/// Hounsfield units, a curve without opaque values.
[[nodiscard]] std::vector<std::string> windowNotes(const view::State& state);

/// Returns the readings of meshes, in another space or unit, that would bring them to the volume. Reads their files.
[[nodiscard]] std::vector<view::Offer> windowOffers(const view::State& state);

} // namespace voxtact::app

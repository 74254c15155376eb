// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace voxtact::view {

struct State;

/// The fonts of Dear ImGui's context, for a display where a point is so many pixels. `font` is the program's own and
/// outlives them.
void makeFonts(float scale, std::span<const unsigned char> font);

/// Between frames: whether the fonts were made anew, since texts of the state have letters that were not in them yet.
/// Letters that the program's own font lacks are of the system's; those that no font has stay unknown.
[[nodiscard]] bool fitFonts(const State& state);

} // namespace voxtact::view

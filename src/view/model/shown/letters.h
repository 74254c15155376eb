// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string_view>

/// Which letters the window's texts have: its font is made of those that it needs.
namespace voxtact::view {

struct State;

/// As Unicode numbers them.
using Letters = std::set<char32_t>;

/// Adds those of a text in UTF-8 that are beyond Latin-1, which each font of the window has. What is no UTF-8 is left
/// out.
void addLetters(std::string_view text, Letters& letters);

/// Of what files, labels and messages of a state say.
[[nodiscard]] Letters lettersOf(const State& state);

} // namespace voxtact::view

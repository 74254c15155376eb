// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

/// Dear ImGui drops commas from numbers, so that 1,5 would be 15. What is typed or pasted into a number therefore has a
/// point for each comma; a path keeps its commas.
namespace voxtact::view {

[[nodiscard]] inline unsigned typedCharacter(unsigned character, bool isPath) noexcept {
    return character == ',' && !isPath ? '.' : character;
}

[[nodiscard]] inline std::string pastedText(std::string text, bool isPath) {
    std::ranges::transform(text, text.begin(), [isPath](char one) { return one == ',' && !isPath ? '.' : one; });
    return text;
}

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

/// Replaces commas by points in typed or pasted numbers, because Dear ImGui drops commas: 1,5 would be 15. Paths keep
/// their commas.
namespace voxtact::view {

[[nodiscard]] inline unsigned typedCharacter(unsigned character, bool isPath) noexcept {
    return character == ',' && !isPath ? '.' : character;
}

[[nodiscard]] inline std::string pastedText(std::string text, bool isPath) {
    std::ranges::transform(text, text.begin(), [isPath](char one) { return one == ',' && !isPath ? '.' : one; });
    return text;
}

} // namespace voxtact::view

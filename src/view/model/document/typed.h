// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

/// What is typed or pasted into a field. Dear ImGui leaves commas out of numbers, and 1,5 would be 15: a decimal comma
/// is a point. In the field for a path it stays.
namespace voxtact::view {

[[nodiscard]] inline unsigned typedCharacter(unsigned character, bool isPath) noexcept {
    return character == ',' && !isPath ? '.' : character;
}

[[nodiscard]] inline std::string pastedText(std::string text, bool isPath) {
    std::ranges::transform(text, text.begin(), [isPath](char one) { return one == ',' && !isPath ? '.' : one; });
    return text;
}

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Makes user input printable in messages.
namespace voxtact::app {

/// escaped(), and no longer than a line bears: the middle of a long one is left out.
[[nodiscard]] std::string shortened(std::string_view text);
/// Returns the text in quotes: 'text'.
[[nodiscard]] std::string forMessage(std::string_view text);

/// The last part of a path, of a folder too; a builtin as it is.
[[nodiscard]] std::string fileNameOf(const std::string& source);

/// A whole message: escaped, with words of more than a few hundred bytes shortened, and not much longer than a screen.
[[nodiscard]] std::string messageLine(std::string_view text);

/// Returns the name in `names` that is nearest to `word`, by omitted, added, changed or swapped letters; empty if none
/// is near.
[[nodiscard]] std::string nearestName(std::string_view word, const std::vector<std::string>& names);

} // namespace voxtact::app

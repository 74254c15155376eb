// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Makes user input printable in messages.
namespace voxtact::app {

/// Like escaped(), but omits the middle of a long text, to fit one line.
[[nodiscard]] std::string shortened(std::string_view text);
/// Returns the text in quotes: 'text'.
[[nodiscard]] std::string forMessage(std::string_view text);

/// Returns the last part of a path, also of a folder; a builtin unchanged.
[[nodiscard]] std::string fileNameOf(const std::string& source);

/// Escapes a whole message, shortens words of more than a few hundred bytes, and limits it to about a screen.
[[nodiscard]] std::string messageLine(std::string_view text);

/// Returns the name in `names` nearest to `word`, by omitted, added, changed or swapped letters; empty if none is near.
[[nodiscard]] std::string nearestName(std::string_view word, const std::vector<std::string>& names);

} // namespace voxtact::app

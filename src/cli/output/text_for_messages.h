// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// What a user typed, as a message may show it.
namespace voxtact::app {

/// escaped(), and no longer than a line bears: the middle of a long one is left out.
[[nodiscard]] std::string shortened(std::string_view text);
/// That in quotes: 'text'.
[[nodiscard]] std::string forMessage(std::string_view text);

/// The last part of a path, of a folder too; a builtin as it is.
[[nodiscard]] std::string fileNameOf(const std::string& source);

/// A whole message: escaped, with words of more than a few hundred bytes shortened, and not much longer than a screen.
[[nodiscard]] std::string messageLine(std::string_view text);

/// Which of `names` was most likely meant by `word`: the nearest by letters left out, added, changed or swapped, if it
/// is near enough; empty: none is.
[[nodiscard]] std::string nearestName(std::string_view word, const std::vector<std::string>& names);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace voxtact {

/// `text` in one line of valid UTF-8: other bytes and control characters are written as \xNN.
[[nodiscard]] std::string escaped(std::string_view text);

/// `text` between tags of HTML, or in an attribute: valid UTF-8, with U+FFFD for other bytes and for control characters
/// but line ends and tabs.
[[nodiscard]] std::string inHtml(std::string_view text);

} // namespace voxtact

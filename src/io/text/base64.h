// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace voxtact::io {

/// Decodes the whole text; its padding may be missing. None if a character is no digit of base64.
[[nodiscard]] std::optional<std::string> decodedBase64(std::string_view text);

/// Decodes `bytes` bytes from the front of `text`, and removes their groups of four digits. Passes over white space.
/// None if the text ends before, or is damaged.
[[nodiscard]] std::optional<std::string> takeBase64(std::string_view& text, std::size_t bytes);

} // namespace voxtact::io

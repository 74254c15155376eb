// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <filesystem>
#include <string_view>

/// Sessions as JSON files.
namespace voxtact::view {

/// Parses a Document. Errors begin with `name` and name the invalid member and the reason.
[[nodiscard]] Result<Document> parseSession(std::string_view text, const std::string& name);
[[nodiscard]] std::string sessionText(const Document& document);

/// Returns true if a file is JSON with the mark of a session. Error: unreadable.
[[nodiscard]] Result<bool> isSession(const std::filesystem::path& path);
/// Resolves relative paths from the session's folder.
[[nodiscard]] Result<Document> readSession(const std::filesystem::path& path);
/// Writes to a temporary name, then renames. Paths in the document are relative to the current folder, those in the
/// file as in seenFrom().
[[nodiscard]] Result<void> writeSession(const std::filesystem::path& path, const Document& document);

/// Writes the curve and the colours for --transfer-function.
[[nodiscard]] Result<void> writeTransferFunction(const std::filesystem::path& path, const Document& document);

} // namespace voxtact::view

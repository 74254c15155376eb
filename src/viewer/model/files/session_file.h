// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"

#include <filesystem>
#include <string_view>

/// Sessions as JSON files.
namespace voxtact::view {

/// All of a Document. `name` begins the texts of errors, which say which member is wrong and why.
[[nodiscard]] Result<Document> parseSession(std::string_view text, const std::string& name);
[[nodiscard]] std::string sessionText(const Document& document);

/// Whether a file is JSON with the mark of a session, whatever else is in it. Errors: it cannot be read.
[[nodiscard]] Result<bool> isSession(const std::filesystem::path& path);
/// Relative paths in it are from its folder on.
[[nodiscard]] Result<Document> readSession(const std::filesystem::path& path);
/// To a temporary name, and renamed. Paths of the document are relative to the current folder, those in the file as
/// seenFrom() has them.
[[nodiscard]] Result<void> writeSession(const std::filesystem::path& path, const Document& document);

/// The curve and the colours as --transfer-function takes them.
[[nodiscard]] Result<void> writeTransferFunction(const std::filesystem::path& path, const Document& document);

} // namespace voxtact::view

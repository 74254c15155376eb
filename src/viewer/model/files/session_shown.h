// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"
#include "viewer/model/files/session_reader.h"

/// Reads and writes the holes and the visible parts of a session.
namespace voxtact::view {

void readHoles(SessionReader& reader, Document& document);
void readShown(SessionReader& reader, Document& document);
/// Writes holes and visible parts.
void writeShown(SessionReader::Json& json, const Document& document);

} // namespace voxtact::view

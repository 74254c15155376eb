// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"
#include "viewer/model/files/session_reader.h"

/// The parts of a session that say what is drilled and what is on.
namespace voxtact::view {

void readHoles(SessionReader& reader, Document& document);
void readShown(SessionReader& reader, Document& document);
/// Both.
void writeShown(SessionReader::Json& json, const Document& document);

} // namespace voxtact::view

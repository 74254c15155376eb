// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <string>
#include <string_view>

namespace voxtact::app {

/// Call first in main(). Opens closed standard streams on /dev/null, so that no file takes their number. Makes a closed
/// pipe or a file size limit a failed write instead of a signal.
void claimStandardStreams() noexcept;

[[nodiscard]] bool outputIsTerminal() noexcept;
[[nodiscard]] bool errorIsTerminal() noexcept;

/// Writes all of `text`, or fails with the reason.
[[nodiscard]] Result<void> writeStandardOutput(std::string_view text);
/// Returns true if output failed because the pipe was closed, as by `| head`.
[[nodiscard]] bool standardOutputIsClosed() noexcept;

/// Prints "voxtact: note: text" on standard error, as one line, unless notes are silenced.
void printNote(std::string_view text);
/// Prints "voxtact: summary: text", as one line, even where notes are silenced.
void printSummary(std::string_view text);
/// Makes printNote() and printNoteOnce() do nothing.
void silenceNotes() noexcept;
/// Like printNote(), but prints each text once: files read again repeat their notes. Thread-safe.
void printNoteOnce(const std::string& text);
/// Prints "voxtact touch: text" on standard error; `command` may be empty.
void printError(std::string_view command, std::string_view text);
/// Reports that memory ran out, without allocating.
void printOutOfMemory() noexcept;

/// Replaces runs of white space and control characters by one space, for a one-line message.
[[nodiscard]] std::string oneLine(std::string_view text);

} // namespace voxtact::app

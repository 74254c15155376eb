// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <string>
#include <string_view>

namespace voxtact::app {

/// Call it first in main(). Standard streams that the caller closed are put on /dev/null, so that no file of ours
/// takes their number, and a closed pipe or a limit on files' sizes becomes a failed write instead of a signal.
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
/// Like printNote(), but prints a text only once: reading a file again repeats its notes. Any thread.
void printNoteOnce(const std::string& text);
/// "voxtact touch: text"; `command` may be empty.
void printError(std::string_view command, std::string_view text);
/// Reports that memory ran out, without allocating.
void printOutOfMemory() noexcept;

/// `text` with runs of white space and control characters as one space: what fits in a one-line message.
[[nodiscard]] std::string oneLine(std::string_view text);

} // namespace voxtact::app

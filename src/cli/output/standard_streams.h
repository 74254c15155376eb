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
/// Whether that has failed because nobody reads the pipe any more, as behind `| head`.
[[nodiscard]] bool standardOutputIsClosed() noexcept;

/// Prints "voxtact: note: text" on standard error, as one line, unless notes are silenced.
void printNote(std::string_view text);
/// Prints "voxtact: summary: text", as one line, even where notes are silenced.
void printSummary(std::string_view text);
/// Makes printNote() and printNoteOnce() do nothing.
void silenceNotes() noexcept;
/// The same of a text that was not printed by this before: what is true of a file stays true when it is read again. Any
/// thread.
void printNoteOnce(const std::string& text);
/// "voxtact touch: text"; `command` may be empty.
void printError(std::string_view command, std::string_view text);
/// The same of a lack of memory, without any.
void printOutOfMemory() noexcept;

/// `text` with runs of white space and control characters as one space: what fits in a one-line message.
[[nodiscard]] std::string oneLine(std::string_view text);

} // namespace voxtact::app

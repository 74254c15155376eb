// SPDX-License-Identifier: MIT
#include "cli/output/standard_streams.h"

#include "cli/output/text_for_messages.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <mutex>
#include <set>
#include <system_error>
#include <unistd.h>

namespace voxtact::app {

namespace {

/// Returns errno, 0 when all was written.
int writeAll(int file, std::string_view text) noexcept {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0) {
            if (errno == EINTR) {
                continue;
            }
            return errno;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

std::atomic<bool> isClosed = false;
std::atomic<bool> isSilent = false;

void printLine(std::string_view text) {
    // A failure of standard error cannot be reported.
    static_cast<void>(writeAll(STDERR_FILENO, messageLine(oneLine(text)) + "\n"));
}

} // namespace

void claimStandardStreams() noexcept {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(file, F_GETFD) == -1 && errno == EBADF) {
            // Opens standard output for reading only: writes to it must fail.
            static_cast<void>(::open("/dev/null", file == STDERR_FILENO ? O_WRONLY : O_RDONLY));
        }
    }
}

bool outputIsTerminal() noexcept {
    return ::isatty(STDOUT_FILENO) == 1;
}

bool errorIsTerminal() noexcept {
    return ::isatty(STDERR_FILENO) == 1;
}

Result<void> writeStandardOutput(std::string_view text) {
    if (const int error = writeAll(STDOUT_FILENO, text); error != 0) {
        isClosed = isClosed || error == EPIPE;
        return Error{ErrorCode::File, 0, "cannot write to standard output: " + std::generic_category().message(error)};
    }
    return {};
}

bool standardOutputIsClosed() noexcept {
    return isClosed;
}

void silenceNotes() noexcept {
    isSilent = true;
}

void printNote(std::string_view text) {
    if (isSilent) {
        return;
    }
    printLine("voxtact: note: " + std::string(text));
}

void printSummary(std::string_view text) {
    printLine("voxtact: summary: " + std::string(text));
}

void printNoteOnce(const std::string& text) {
    static std::mutex mutex;
    static std::set<std::string> printed;
    const std::lock_guard lock(mutex);
    if (printed.insert(text).second) {
        printNote(text);
    }
}

void printError(std::string_view command, std::string_view text) {
    printLine("voxtact" + std::string(command.empty() ? "" : " ") + std::string(command) + ": " + std::string(text));
}

void printOutOfMemory() noexcept {
    static_cast<void>(writeAll(STDERR_FILENO, "voxtact: out of memory\n"));
}

std::string oneLine(std::string_view text) {
    std::string line;
    for (const char c : text) {
        const bool blank = static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
        if (!blank) {
            line += c;
        } else if (!line.empty() && line.back() != ' ') {
            line += ' ';
        }
    }
    if (!line.empty() && line.back() == ' ') {
        line.pop_back();
    }
    return line;
}

} // namespace voxtact::app

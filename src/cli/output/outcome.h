// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/refuse.h"

#include <string>

namespace voxtact::app {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;    ///< run-time failure: no device, an unreadable file
inline constexpr int kExitArguments = 2; ///< unusable arguments
inline constexpr int kExitVerify = 3;    ///< a requested verification failed

/// Result of a command: its exit status and, unless that is 0, the error line.
struct Outcome {
    Outcome() = default;
    Outcome(int exitStatus, std::string reason) : status(exitStatus), text(std::move(reason)) {}
    Outcome(const Error& error)
        : status(error.code == ErrorCode::InvalidArgument ? kExitArguments : kExitFailed), text(error.text) {}

    int status = kExitDone;
    std::string text;
};

/// Creates an error about an argument: exit status 2.
[[nodiscard]] inline Error badArgument(std::string text) {
    return refuse(std::move(text));
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"

#include <string>
#include <vector>

namespace voxtact::app {

/// A program: its subcommands, and the texts of its `--help`.
struct ProgramDesc {
    const char* description;
    const char* footer;
    std::vector<Command> (*addCommands)(CLI::App& program);
};

/// Runs the subcommand that the arguments behind the program's name ask for. Returns the exit status; does not throw.
[[nodiscard]] int runProgram(const ProgramDesc& desc, std::vector<std::string> arguments);

} // namespace voxtact::app

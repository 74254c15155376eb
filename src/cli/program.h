// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"

#include <string>
#include <vector>

namespace voxtact::app {

/// Subcommands and `--help` texts of a program.
struct ProgramDesc {
    const char* description;
    const char* footer;
    std::vector<Command> (*addCommands)(CLI::App& program);
};

/// Runs the subcommand of the arguments, which begin with the program name. Returns the exit status; does not throw.
[[nodiscard]] int runProgram(const ProgramDesc& desc, std::vector<std::string> arguments);

} // namespace voxtact::app

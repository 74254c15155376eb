// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "voxtact/named_questions.h"

/// Functions that add a subcommand with its options to the program.
namespace voxtact::app {

/// Adds the subcommands of all questions.
[[nodiscard]] std::vector<Command> addQuestions(CLI::App& program);
[[nodiscard]] Command addMotion(CLI::App& program, const NamedQuestion& question);
[[nodiscard]] Command addDevices(CLI::App& program);
[[nodiscard]] Command addInfo(CLI::App& program);
[[nodiscard]] Command addPlan(CLI::App& program);
[[nodiscard]] Command addRender(CLI::App& program);
/// Adds `make` with its own subcommands: mesh, volume, poses.
[[nodiscard]] std::vector<Command> addMake(CLI::App& program);

/// Adds the subcommands that run other programs from the folder of this one.
[[nodiscard]] std::vector<Command> addOtherPrograms(CLI::App& program);

} // namespace voxtact::app

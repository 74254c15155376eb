// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"

/// One function a subcommand: adds it, with its options, to the program.
namespace voxtact::app {

[[nodiscard]] Command addTouch(CLI::App& program);
[[nodiscard]] Command addCount(CLI::App& program);
[[nodiscard]] Command addDistance(CLI::App& program);
[[nodiscard]] Command addArea(CLI::App& program);
[[nodiscard]] Command addOverlap(CLI::App& program);
[[nodiscard]] Command addDevices(CLI::App& program);
[[nodiscard]] Command addInfo(CLI::App& program);
[[nodiscard]] Command addMotion(CLI::App& program);
[[nodiscard]] Command addPlan(CLI::App& program);
[[nodiscard]] Command addRender(CLI::App& program);
/// `make` has commands of its own: mesh, volume, poses.
[[nodiscard]] std::vector<Command> addMake(CLI::App& program);

/// Subcommands that are programs of their own, started from the folder of this one.
[[nodiscard]] std::vector<Command> addOtherPrograms(CLI::App& program);

} // namespace voxtact::app

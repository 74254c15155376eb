// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/shared_options.h"

/// One function a subcommand: adds it, with its options, to the program.
namespace voxtact::app {

[[nodiscard]] Command addBench(CLI::App& program);
[[nodiscard]] Command addCompare(CLI::App& program);
[[nodiscard]] Command addDetect(CLI::App& program);
[[nodiscard]] Command addDevices(CLI::App& program);
[[nodiscard]] Command addInfo(CLI::App& program);
[[nodiscard]] Command addMerge(CLI::App& program);
[[nodiscard]] Command addMotion(CLI::App& program);
[[nodiscard]] Command addPlan(CLI::App& program);
[[nodiscard]] Command addRender(CLI::App& program);
[[nodiscard]] Command addView(CLI::App& program);
/// `make` has commands of its own: mesh, volume, poses.
[[nodiscard]] std::vector<Command> addMake(CLI::App& program);

} // namespace voxtact::app

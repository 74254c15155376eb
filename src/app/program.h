// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace voxtact::app {

/// The program, with the arguments behind its name. Returns its exit status; does not throw.
[[nodiscard]] int runProgram(std::vector<std::string> arguments);

} // namespace voxtact::app

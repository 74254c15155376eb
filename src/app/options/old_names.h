// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace voxtact::app {

/// The arguments after the program's name, with options that have another name now by that. The old names are in no
/// help, and go with the next release.
[[nodiscard]] std::vector<std::string> withNewNames(std::vector<std::string> arguments);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/certified_scenes.h"

/// Scenes for what asks how near something is.
namespace voxtact::test {

/// Like those of the certified tests, at some distance, and some with axes that are not at right angles.
[[nodiscard]] CertifiedCase makeClearanceCase(std::uint64_t seed, std::uint64_t number);

} // namespace voxtact::test

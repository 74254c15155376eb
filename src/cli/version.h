// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace voxtact::app {

[[nodiscard]] const char* programVersion() noexcept;
[[nodiscard]] const char* gitRevision() noexcept;
/// Returns version, git revision, Vulkan headers and glslang, one per line.
[[nodiscard]] std::string versionText();

} // namespace voxtact::app

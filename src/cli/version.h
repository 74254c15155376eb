// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace voxtact::app {

[[nodiscard]] const char* programVersion() noexcept;
[[nodiscard]] const char* gitRevision() noexcept;
/// Version, git revision, Vulkan headers, glslang: a line each.
[[nodiscard]] std::string versionText();

} // namespace voxtact::app

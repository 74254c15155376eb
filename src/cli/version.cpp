// SPDX-License-Identifier: MIT
#include "cli/version.h"

#include "vulkan/own/vulkan_device.h"

#include "voxtact_version.h"

namespace voxtact::app {

const char* programVersion() noexcept {
    return kVersion;
}

const char* gitRevision() noexcept {
    return kGitRevision;
}

std::string versionText() {
    return std::string("voxtact ") + kVersion + "\ngit revision " + kGitRevision + "\nVulkan headers " +
           device::apiVersionText(VK_HEADER_VERSION_COMPLETE) + "\nglslang " + kGlslangVersion + "\n";
}

} // namespace voxtact::app

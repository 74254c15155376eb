// SPDX-License-Identifier: MIT
#include "cli/options/open_session.h"

#include "cli/output/standard_streams.h"
#include "core/base/try.h"

namespace voxtact::app {

Result<device::Session> openSession(const DeviceChoice& choice, const SessionExtensions& extensions) {
    Result<device::VulkanInstance> instance =
        device::VulkanInstance::create({.validate = choice.validate, .extensions = extensions.instance});
    VOXTACT_TRY(instance);
    const Result<std::vector<device::PhysicalDevice>> devices = instance->devices();
    VOXTACT_TRY(devices);
    const Result<device::PhysicalDevice> chosen = device::chooseDevice(*devices, choice.wanted);
    VOXTACT_TRY(chosen);
    return device::openSessionOn(*instance, *chosen, pipelineStore(choice, *chosen),
                                 [](void*, const char* text) { printNoteOnce(text); },
                                 {.extensions = extensions.device});
}

device::PipelineStore pipelineStore(const DeviceChoice& choice, const device::PhysicalDevice& device) {
    const CacheFolder folder(choice.cache);
    if (!folder.on()) {
        return {};
    }
    const std::string name = "pipelines-" + cacheKey(device);
    return {[folder, name] { return folder.read(name); },
            [folder, name](std::string_view blob) { folder.write(name, blob); }};
}

Outcome validationOutcome(const device::ValidationMessages& messages) {
    const std::vector<std::string> all = messages.all();
    if (all.empty()) {
        return {};
    }
    const std::string more = all.size() > 1 ? " (and " + std::to_string(all.size() - 1) + " more)" : "";
    return {kExitVerify, "--validate: " + all.front() + more};
}

} // namespace voxtact::app

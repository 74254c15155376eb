// SPDX-License-Identifier: MIT
#include "app/options/open_session.h"

#include "app/output/standard_streams.h"
#include "core/try.h"

namespace voxtact::app {

Result<Session> openSession(const DeviceChoice& choice) {
    Result<VulkanInstance> instance = VulkanInstance::create({.validate = choice.validate});
    VOXTACT_TRY(instance);
    const Result<std::vector<PhysicalDevice>> devices = instance->devices();
    VOXTACT_TRY(devices);
    const Result<PhysicalDevice> chosen = chooseDevice(*devices, choice.wanted);
    VOXTACT_TRY(chosen);
    return openSessionOn(*instance, *chosen, pipelineStore(choice, *chosen),
                         [](void*, const char* text) { printNote(text); });
}

PipelineStore pipelineStore(const DeviceChoice& choice, const PhysicalDevice& device) {
    const CacheFolder folder(choice.cache);
    if (!folder.on()) {
        return {};
    }
    const std::string name = "pipelines-" + cacheKey(device);
    return {[folder, name] { return folder.read(name); },
            [folder, name](std::string_view blob) { folder.write(name, blob); }};
}

Outcome validationOutcome(const ValidationMessages& messages) {
    const std::vector<std::string> all = messages.all();
    if (all.empty()) {
        return {};
    }
    const std::string more = all.size() > 1 ? " (and " + std::to_string(all.size() - 1) + " more)" : "";
    return {kExitVerify, "--validate: " + all.front() + more};
}

} // namespace voxtact::app

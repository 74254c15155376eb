// SPDX-License-Identifier: MIT
#include "app/session.h"

#include "app/standard_streams.h"

namespace voxtact::app {

Result<Session> openSession(const DeviceChoice& choice) {
    Result<VulkanInstance> instance = VulkanInstance::create({.validate = choice.validate});
    if (!instance.ok()) {
        return instance.error();
    }
    const Result<std::vector<PhysicalDevice>> devices = instance->devices();
    if (!devices.ok()) {
        return devices.error();
    }
    const Result<PhysicalDevice> chosen = chooseDevice(*devices, choice.wanted);
    if (!chosen.ok()) {
        return chosen.error();
    }
    return openSessionOn(*instance, *chosen, choice, [](void*, const char* text) { printNote(text); });
}

Result<Session> openSessionOn(const VulkanInstance& instance, const PhysicalDevice& physical,
                              const DeviceChoice& choice, LogCallback log) {
    Result<VulkanDevice> device = VulkanDevice::create(instance, physical);
    if (!device.ok()) {
        return device.error();
    }
    const CacheFolder cache(choice.cache);
    PipelineCache pipelines(*device, cache);
    ContextDesc desc = device->contextDesc();
    desc.pipelineCache = pipelines.handle();
    desc.log = log;
    Result<Context> context = Context::create(desc);
    if (!context.ok()) {
        return context.error();
    }
    return Session{instance, std::move(*device), cache, std::move(pipelines), std::move(*context)};
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

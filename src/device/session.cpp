// SPDX-License-Identifier: MIT
#include "device/session.h"

namespace voxtact::app {

Result<Session> openSessionOn(const VulkanInstance& instance, const PhysicalDevice& physical, PipelineStore store,
                              LogCallback log) {
    Result<VulkanDevice> device = VulkanDevice::create(instance, physical);
    if (!device.ok()) {
        return device.error();
    }
    PipelineCache pipelines(*device, std::move(store));
    ContextDesc desc = device->contextDesc();
    desc.pipelineCache = pipelines.handle();
    desc.log = log;
    Result<Context> context = Context::create(desc);
    if (!context.ok()) {
        return context.error();
    }
    return Session{instance, std::move(*device), std::move(pipelines), std::move(*context)};
}

} // namespace voxtact::app

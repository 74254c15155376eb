// SPDX-License-Identifier: MIT
#include "vulkan/own/session.h"

#include "core/base/try.h"

namespace voxtact::device {

Result<Session> openSessionOn(const VulkanInstance& instance, const PhysicalDevice& physical, PipelineStore store,
                              LogCallback log, const DeviceOptions& options) {
    Result<VulkanDevice> device = VulkanDevice::create(instance, physical, options);
    VOXTACT_TRY(device);
    PipelineCache pipelines(*device, std::move(store));
    ContextDesc desc = device->contextDesc();
    desc.pipelineCache = pipelines.handle();
    desc.log = log;
    Result<Context> context = Context::create(desc);
    VOXTACT_TRY(context);
    return Session{instance, std::move(*device), std::move(pipelines), std::move(*context)};
}

} // namespace voxtact::device

// SPDX-License-Identifier: MIT
// The caller's device: what voxtact needs of it, the context, and its errors.
#include "c/convert_vulkan.h"

using namespace voxtact;
using namespace voxtact::c;

namespace voxtact::c {

ContextDesc toContextDesc(const vxt_context_desc* given) {
    const vxt_context_desc desc = readStruct(given, zero<vxt_context_desc>(), "description of the context");
    return {.getInstanceProcAddr = desc.get_instance_proc_addr,
            .instance = desc.instance,
            .physicalDevice = desc.physical_device,
            .device = desc.device,
            .apiVersion = desc.api_version,
            .enabledFeatures = desc.enabled_features,
            .enabledInstanceExtensions = toSpan(desc.enabled_instance_extensions, desc.enabled_instance_extension_count,
                                                "enabled_instance_extensions"),
            .enabledDeviceExtensions = toSpan(desc.enabled_device_extensions, desc.enabled_device_extension_count,
                                              "enabled_device_extensions"),
            .queueFamilies = toSpan(desc.queue_families, desc.queue_family_count, "queue_families"),
            .fragmentsAtOnce = desc.fragments_at_once,
            .pipelineCache = desc.pipeline_cache,
            .allocator = desc.allocator,
            .memory = desc.memory,
            .log = desc.log,
            .logUser = desc.log_user};
}

QueueAccess toQueue(const vxt_queue* given) {
    const vxt_queue queue = readStruct(given, zero<vxt_queue>(), "queue");
    return {queue.queue, queue.family, queue.lock, queue.unlock, queue.user};
}

} // namespace voxtact::c

const char* vxt_last_error(const vxt_context* context) {
    return lastError(context == nullptr ? nullptr : context->errors.get()).what();
}

int32_t vxt_last_vk_result(const vxt_context* context) {
    return lastError(context == nullptr ? nullptr : context->errors.get()).vkResult;
}

size_t vxt_requirement_count(void) {
    return requirements().size();
}

vxt_result vxt_requirement_get(size_t index, vxt_requirement* requirement) {
    return call([&] {
        const std::span<const Requirement> all = requirements();
        if (index >= all.size()) {
            refuse(ErrorCode::InvalidArgument,
                   "requirement " + std::to_string(index) + ": there are " + std::to_string(all.size()));
        }
        const Requirement& found = all[index];
        need(requirement, "requirement") = {found.feature, found.structure, found.without, found.required ? 1U : 0U};
    });
}

const char* const* vxt_optional_device_extensions(size_t* count) {
    return handOut(optionalDeviceExtensions(), count);
}

vxt_result vxt_features_create(const VkPhysicalDeviceFeatures2* supported, vxt_features** features) {
    return call([&] {
        vxt_features*& place = need(features, "the place for the new object");
        place = nullptr;
        place = new vxt_features{FeatureRequest(supported)}; // made in place: its structs point to each other
    });
}

VkPhysicalDeviceFeatures2* vxt_features_chain(vxt_features* features) {
    return features == nullptr ? nullptr : &features->object.features2;
}

void vxt_features_destroy(vxt_features* features) {
    delete features;
}

vxt_result vxt_context_create(const vxt_context_desc* desc, vxt_context** context) {
    return create(context, [&] {
        return vxt_context{take(Context::create(toContextDesc(desc))), std::make_shared<ContextErrors>()};
    });
}

uint32_t vxt_context_supports(const vxt_context* context, vxt_method method, vxt_projection projection) {
    return context != nullptr &&
                   context->object.supports(number<CountingMethod>(method), number<Projection>(projection))
               ? 1
               : 0;
}

vxt_method vxt_context_default_method(const vxt_context* context) {
    return context == nullptr ? VXT_METHOD_CPU : number<vxt_method>(context->object.defaultMethod());
}

VkExtent2D vxt_context_max_viewport(const vxt_context* context) {
    return context == nullptr ? VkExtent2D{0, 0} : context->object.maxViewport();
}

uint32_t vxt_context_device_lost(const vxt_context* context) {
    return context != nullptr && context->object.deviceLost() ? 1 : 0;
}

void vxt_context_destroy(vxt_context* context) {
    delete context;
}

// SPDX-License-Identifier: MIT
#include "vulkan/requirements.h"
#include "core/base/guard.h"
#include "core/method/method_table.h"
#include "vulkan/queue_families.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace voxtact {

namespace {

constexpr const char* kCore = "VkPhysicalDeviceFeatures";
constexpr const char* kVulkan13 = "VkPhysicalDeviceVulkan13Features";
constexpr const char* kNoDevicePoses = "no poses on the device (devicePoses)";

constexpr std::array kRequirements{
    Requirement{"dynamicRendering", kVulkan13, true, "nothing works: every pass is a dynamic rendering"},
    Requirement{"synchronization2", kVulkan13, true, "nothing works: every barrier is a VkDependencyInfo"},
    Requirement{"occlusionQueryPrecise", kCore, false, "no counting method query"},
    Requirement{"fragmentStoresAndAtomics", kCore, false,
                "no counting methods atomic and subgroup, and no outputs in addition to the counts by the rasteriser"},
    Requirement{"geometryShader", kCore, false,
                "no outputs in addition to the counts by the rasteriser, and no list of surviving fragments "
                "(gl_PrimitiveID needs it)"},
    Requirement{"shaderFloat64", kCore, false, kNoDevicePoses},
};

constexpr std::array kOptionalExtensions{VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME};

/// Walks a pNext chain of feature structs.
template <class Visitor> void forEachStruct(const VkPhysicalDeviceFeatures2* features, Visitor&& visitor) {
    for (const auto* next = static_cast<const VkBaseInStructure*>(features->pNext); next != nullptr;
         next = next->pNext) {
        visitor(next);
    }
}

bool contains(std::span<const char* const> extensions, const char* name) {
    return std::ranges::any_of(extensions, [name](const char* extension) {
        return extension != nullptr && std::strcmp(extension, name) == 0;
    });
}

bool on(VkBool32 flag) {
    return flag == VK_TRUE;
}

void checkHandles(const ContextDesc& desc, CheckReport& report) {
    const auto need = [&](bool there, const char* what) {
        if (!there) {
            report.missing.emplace_back(std::string(what) + " is null");
        }
    };
    need(desc.getInstanceProcAddr != nullptr, "ContextDesc::getInstanceProcAddr");
    need(desc.instance != VK_NULL_HANDLE, "ContextDesc::instance");
    need(desc.physicalDevice != VK_NULL_HANDLE, "ContextDesc::physicalDevice");
    need(desc.device != VK_NULL_HANDLE, "ContextDesc::device");
    if (desc.enabledFeatures == nullptr) {
        report.missing.emplace_back("ContextDesc::enabledFeatures is null: no feature counts as enabled");
    }
    if (desc.apiVersion < VK_API_VERSION_1_3) {
        report.missing.emplace_back("ContextDesc::apiVersion is " +
                                    std::to_string(VK_API_VERSION_MAJOR(desc.apiVersion)) + "." +
                                    std::to_string(VK_API_VERSION_MINOR(desc.apiVersion)) + ", Vulkan 1.3 is needed");
    }
}

/// What only the loader and the device can say; needs all handles.
DeviceSupport checkDevice(const ContextDesc& desc, CheckReport& report) {
    DeviceFunctions functions;
    const char* absent = functions.load(desc.getInstanceProcAddr, desc.instance, desc.device, debugUtilsEnabled(desc));
    if (absent != nullptr) {
        report.missing.emplace_back(std::string("the loader does not give ") + absent);
    }
    if (functions.GetPhysicalDeviceProperties2 == nullptr) {
        return {};
    }
    VkPhysicalDeviceSubgroupProperties subgroup{};
    subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    VkPhysicalDeviceFloatControlsProperties floats{};
    floats.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES;
    subgroup.pNext = &floats;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &subgroup;
    functions.GetPhysicalDeviceProperties2(desc.physicalDevice, &properties);
    if (properties.properties.apiVersion < VK_API_VERSION_1_3) {
        report.missing.emplace_back(std::string("the device ") + properties.properties.deviceName + " has Vulkan " +
                                    std::to_string(VK_API_VERSION_MAJOR(properties.properties.apiVersion)) + "." +
                                    std::to_string(VK_API_VERSION_MINOR(properties.properties.apiVersion)) +
                                    ", 1.3 is needed");
    }
    constexpr VkSubgroupFeatureFlags kOperations =
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    return {(subgroup.supportedStages & VK_SHADER_STAGE_FRAGMENT_BIT) != 0 &&
                (subgroup.supportedOperations & kOperations) == kOperations,
            properties.properties.limits.maxPerStageDescriptorStorageBuffers >= kComputeStorageBuffers,
            readFloatControls(floats)};
}

static_assert(kComputeStorageBuffers == 5, "methodSupport() says so");

std::vector<MethodSupport> methodSupport(const EnabledFeatures& enabled, const DeviceSupport& device) {
    struct Known {
        MethodNeed need;
        bool there;
        const char* otherwise;
    };
    const Known known[] = {
        {kNeedsPreciseQuery, enabled.occlusionQueryPrecise, "occlusionQueryPrecise is not enabled"},
        {kNeedsFragmentStores, enabled.fragmentStoresAndAtomics, "fragmentStoresAndAtomics is not enabled"},
        {kNeedsFragmentBallot, device.fragmentBallotAndShuffle,
         "the fragment stage has no subgroup ballot and shuffle"},
        {kNeedsComputeBuffers, device.computeBuffers, "maxPerStageDescriptorStorageBuffers is below 5"},
    };
    std::vector<MethodSupport> all;
    for (const MethodRow& row : kMethodTable) {
        if (row.host) {
            continue;
        }
        MethodSupport& support = all.emplace_back(MethodSupport{row.method, true, {}});
        for (const Known& one : known) {
            if ((row.needs & one.need) != 0 && !one.there) {
                support.available = false;
                support.reason += (support.reason.empty() ? "" : ", ") + std::string(one.otherwise);
            }
        }
    }
    return all;
}

} // namespace

std::span<const Requirement> requirements() noexcept {
    return kRequirements;
}

std::span<const char* const> optionalDeviceExtensions() noexcept {
    return kOptionalExtensions;
}

FloatControls readFloatControls(const VkPhysicalDeviceFloatControlsProperties& properties) noexcept {
    FloatControls out{.keepsSpecials = on(properties.shaderSignedZeroInfNanPreserveFloat32),
                      .roundsToNearest = on(properties.shaderRoundingModeRTEFloat32),
                      .keepsDenormals = on(properties.shaderDenormPreserveFloat32)};
    // Of both: a device need not be able to round one width in one way and the other in another.
    out.missingForDoubles = missingFloatControl(out);
    if (out.doubles() && !on(properties.shaderSignedZeroInfNanPreserveFloat64)) {
        out.missingForDoubles = "shaderSignedZeroInfNanPreserveFloat64";
    } else if (out.doubles() && !on(properties.shaderRoundingModeRTEFloat64)) {
        out.missingForDoubles = "shaderRoundingModeRTEFloat64";
    }
    return out;
}

const char* missingFloatControl(const FloatControls& floats) noexcept {
    if (!floats.keepsSpecials) {
        return "shaderSignedZeroInfNanPreserveFloat32";
    }
    return floats.roundsToNearest ? nullptr : "shaderRoundingModeRTEFloat32";
}

EnabledFeatures readFeatures(const VkPhysicalDeviceFeatures2* features) noexcept {
    EnabledFeatures out;
    if (features == nullptr) {
        return out;
    }
    out.occlusionQueryPrecise = on(features->features.occlusionQueryPrecise);
    out.fragmentStoresAndAtomics = on(features->features.fragmentStoresAndAtomics);
    out.geometryShader = on(features->features.geometryShader);
    out.shaderFloat64 = on(features->features.shaderFloat64);
    forEachStruct(features, [&](const VkBaseInStructure* next) {
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            const auto* all = reinterpret_cast<const VkPhysicalDeviceVulkan13Features*>(next);
            out.dynamicRendering = out.dynamicRendering || on(all->dynamicRendering);
            out.synchronization2 = out.synchronization2 || on(all->synchronization2);
        } else if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES) {
            const auto* one = reinterpret_cast<const VkPhysicalDeviceDynamicRenderingFeatures*>(next);
            out.dynamicRendering = out.dynamicRendering || on(one->dynamicRendering);
        } else if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES) {
            const auto* one = reinterpret_cast<const VkPhysicalDeviceSynchronization2Features*>(next);
            out.synchronization2 = out.synchronization2 || on(one->synchronization2);
        }
    });
    return out;
}

bool debugUtilsEnabled(const ContextDesc& desc) noexcept {
    return contains(desc.enabledInstanceExtensions, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
}

bool conservativeRasterizationEnabled(const ContextDesc& desc) noexcept {
    return contains(desc.enabledDeviceExtensions, VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
}

FeatureRequest::FeatureRequest(const VkPhysicalDeviceFeatures2* supported) noexcept {
    const EnabledFeatures has = readFeatures(supported);
    features2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features2.pNext = &vulkan12;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.pNext = &vulkan13;
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    // Required ones are asked for even where they are not supported: vkCreateDevice then says so.
    vulkan13.dynamicRendering = VK_TRUE;
    vulkan13.synchronization2 = VK_TRUE;
    features2.features.occlusionQueryPrecise = has.occlusionQueryPrecise ? VK_TRUE : VK_FALSE;
    features2.features.fragmentStoresAndAtomics = has.fragmentStoresAndAtomics ? VK_TRUE : VK_FALSE;
    features2.features.geometryShader = has.geometryShader ? VK_TRUE : VK_FALSE;
    features2.features.shaderFloat64 = has.shaderFloat64 ? VK_TRUE : VK_FALSE;
}

CheckReport check(const ContextDesc& desc) {
    CheckReport report;
    checkHandles(desc, report);
    if (const Result<void> families = checkFamilies(desc); !families.ok()) {
        report.missing.push_back(families.error().text);
    }
    const EnabledFeatures enabled = readFeatures(desc.enabledFeatures);
    const bool has[] = {enabled.dynamicRendering,         enabled.synchronization2, enabled.occlusionQueryPrecise,
                        enabled.fragmentStoresAndAtomics, enabled.geometryShader,   enabled.shaderFloat64};
    static_assert(std::size(has) == kRequirements.size());
    DeviceSupport device;
    if (desc.getInstanceProcAddr != nullptr && desc.instance != VK_NULL_HANDLE && desc.device != VK_NULL_HANDLE &&
        desc.physicalDevice != VK_NULL_HANDLE) {
        device = checkDevice(desc, report);
    }
    for (std::size_t i = 0; i < kRequirements.size(); ++i) {
        const Requirement& requirement = kRequirements[i];
        if (requirement.required && !has[i]) {
            report.missing.emplace_back(std::string(requirement.structure) + "::" + requirement.feature +
                                        " is not enabled");
        }
    }
    report.usable = report.missing.empty();
    for (std::size_t i = 0; i < kRequirements.size(); ++i) {
        const Requirement& requirement = kRequirements[i];
        if (!requirement.required && !has[i]) {
            report.missing.emplace_back(std::string(requirement.structure) + "::" + requirement.feature +
                                        " is not enabled: " + requirement.without);
        }
    }
    const auto unreported = [&](const char* control, const std::string& without) {
        report.missing.emplace_back(std::string("VkPhysicalDeviceFloatControlsProperties::") + control +
                                    " is not reported: " + without);
    };
    if (const char* control = device.floats ? missingFloatControl(*device.floats) : nullptr; control != nullptr) {
        unreported(control, std::string("no projection certified by the method compute, ") + kNoDevicePoses);
    } else if (device.floats && enabled.shaderFloat64 && !device.floats->doubles()) {
        unreported(device.floats->missingForDoubles, kNoDevicePoses);
    }
    report.methods = methodSupport(enabled, device);
    return report;
}

} // namespace voxtact

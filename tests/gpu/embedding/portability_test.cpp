// SPDX-License-Identifier: MIT
// Drivers that are not all of Vulkan, such as MoltenVK: the loader lists them to who asks, and their devices are made
// with the extension that says what they lack.
#include "gpu_fixture.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace voxtact::test {
namespace {

constexpr const char* kSubset = "VK_KHR_portability_subset";

/// What the stand-in adds, and what it was asked for.
struct StandIn {
    bool listsPortability = false;
    bool hasSubset = false;
    PFN_vkGetInstanceProcAddr real = nullptr;
    PFN_vkEnumerateInstanceExtensionProperties instanceExtensions = nullptr;
    PFN_vkEnumerateDeviceExtensionProperties deviceExtensions = nullptr;
    PFN_vkCreateDevice createDevice = nullptr;
    VkInstanceCreateFlags flags = 0;
    std::vector<std::string> ofInstance;
    std::vector<std::string> ofDevice;
};
StandIn standIn;

/// Those of `all`, and one that is called `name`, as Vulkan lists them.
VkResult list(std::vector<VkExtensionProperties> all, const char* name, bool with, std::uint32_t* count,
              VkExtensionProperties* out) {
    std::erase_if(all, [name](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
    if (with) {
        VkExtensionProperties& added = all.emplace_back();
        std::strncpy(added.extensionName, name, sizeof added.extensionName - 1);
    }
    if (out != nullptr) {
        std::copy_n(all.begin(), std::min<std::size_t>(*count, all.size()), out);
    }
    *count = static_cast<std::uint32_t>(all.size());
    return VK_SUCCESS;
}

template <class Enumerate> std::vector<VkExtensionProperties> everything(Enumerate enumerate) {
    std::uint32_t count = 0;
    EXPECT_EQ(enumerate(&count, nullptr), VK_SUCCESS);
    std::vector<VkExtensionProperties> all(count);
    EXPECT_EQ(enumerate(&count, all.data()), VK_SUCCESS);
    return all;
}

VKAPI_ATTR VkResult VKAPI_CALL listInstance(const char* layer, std::uint32_t* count, VkExtensionProperties* out) {
    return list(everything([layer](auto... rest) { return standIn.instanceExtensions(layer, rest...); }),
                VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME, standIn.listsPortability, count, out);
}

VKAPI_ATTR VkResult VKAPI_CALL listDevice(VkPhysicalDevice device, const char* layer, std::uint32_t* count,
                                          VkExtensionProperties* out) {
    return list(everything([=](auto... rest) { return standIn.deviceExtensions(device, layer, rest...); }), kSubset,
                standIn.hasSubset, count, out);
}

std::vector<std::string> names(const char* const* all, std::uint32_t count) {
    return {all, all + count};
}

VKAPI_ATTR VkResult VKAPI_CALL makeInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                            VkInstance* instance) {
    standIn.flags = info->flags;
    standIn.ofInstance = names(info->ppEnabledExtensionNames, info->enabledExtensionCount);
    VkInstanceCreateInfo without = *info;
    std::vector<const char*> kept(info->ppEnabledExtensionNames,
                                  info->ppEnabledExtensionNames + info->enabledExtensionCount);
    std::erase_if(
        kept, [](const char* name) { return std::string_view(name) == VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME; });
    without.flags = 0;
    without.ppEnabledExtensionNames = kept.data();
    without.enabledExtensionCount = static_cast<std::uint32_t>(kept.size());
    return reinterpret_cast<PFN_vkCreateInstance>(standIn.real(VK_NULL_HANDLE, "vkCreateInstance"))(&without, allocator,
                                                                                                    instance);
}

VKAPI_ATTR VkResult VKAPI_CALL makeDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                          const VkAllocationCallbacks* allocator, VkDevice* device) {
    standIn.ofDevice = names(info->ppEnabledExtensionNames, info->enabledExtensionCount);
    VkDeviceCreateInfo without = *info;
    std::vector<const char*> kept(info->ppEnabledExtensionNames,
                                  info->ppEnabledExtensionNames + info->enabledExtensionCount);
    std::erase_if(kept, [](const char* name) { return std::string_view(name) == kSubset; });
    without.ppEnabledExtensionNames = kept.data();
    without.enabledExtensionCount = static_cast<std::uint32_t>(kept.size());
    return standIn.createDevice(physical, &without, allocator, device);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL lookUp(VkInstance instance, const char* name) {
    const auto instead = [&](const char* wanted, auto function) {
        return std::strcmp(name, wanted) == 0 ? reinterpret_cast<PFN_vkVoidFunction>(function) : nullptr;
    };
    const PFN_vkVoidFunction real = standIn.real(instance, name);
    const auto keep = [&]<class F>(F& place, const char* wanted) {
        if (std::strcmp(name, wanted) == 0) {
            place = reinterpret_cast<F>(real);
        }
    };
    keep(standIn.instanceExtensions, "vkEnumerateInstanceExtensionProperties");
    keep(standIn.deviceExtensions, "vkEnumerateDeviceExtensionProperties");
    keep(standIn.createDevice, "vkCreateDevice");
    for (const PFN_vkVoidFunction function :
         {instead("vkEnumerateInstanceExtensionProperties", listInstance), instead("vkCreateInstance", makeInstance),
          instead("vkEnumerateDeviceExtensionProperties", listDevice), instead("vkCreateDevice", makeDevice)}) {
        if (function != nullptr) {
            return function;
        }
    }
    return real;
}

class PortabilityTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return; // there may be no loader, whose functions the stand-in calls
        }
        standIn = {};
        volkInitialize();
        standIn.real = vkGetInstanceProcAddr;
        ofDevices_ = std::exchange(vkGetDeviceProcAddr, nullptr);
        volkInitializeCustom(lookUp);
    }
    void TearDown() override {
        volkInitialize();
        vkGetDeviceProcAddr = ofDevices_; // other tests' instances go on
        GpuTest::TearDown();
    }
    static device::VulkanDevice make() {
        const device::VulkanInstance instance = take(device::VulkanInstance::create());
        const auto devices = take(instance.devices());
        return take(device::VulkanDevice::create(instance, take(device::chooseDevice(devices, {}))));
    }
    static bool has(const std::vector<std::string>& all, const char* name) {
        return std::ranges::find(all, name) != all.end();
    }

  private:
    PFN_vkGetDeviceProcAddr ofDevices_ = nullptr;
};

TEST_F(PortabilityTest, AskedForWhereTheyAre) {
    standIn.listsPortability = true;
    standIn.hasSubset = true;
    const device::VulkanDevice made = make();
    EXPECT_EQ(standIn.flags, VkInstanceCreateFlags{VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR});
    EXPECT_TRUE(has(standIn.ofInstance, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME));
    EXPECT_TRUE(has(standIn.ofDevice, kSubset)) << "Vulkan demands it of who makes the device";
}

TEST_F(PortabilityTest, NotAskedForWhereTheyAreNot) {
    const device::VulkanDevice made = make();
    EXPECT_EQ(standIn.flags, 0U);
    EXPECT_FALSE(has(standIn.ofInstance, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME));
    EXPECT_FALSE(has(standIn.ofDevice, kSubset));
}

} // namespace
} // namespace voxtact::test

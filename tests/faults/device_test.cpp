// SPDX-License-Identifier: MIT
// The program's own instance and device: every call that makes them fails once.
#include "gpu/gpu_fixture.h"
#include "sweep.h"
#include "vulkan/own/vulkan_device.h"

namespace voxtact::test {
namespace {

/// volk's loader, with the fault table in its place while this is there.
class VolkUnderFaults {
  public:
    VolkUnderFaults() : table_(realLoader(), {}) {
        volkInitializeCustom(FaultTable::getInstanceProcAddr());
        vkGetDeviceProcAddr = nullptr;
    }
    VolkUnderFaults(const VolkUnderFaults&) = delete;
    VolkUnderFaults& operator=(const VolkUnderFaults&) = delete;
    ~VolkUnderFaults() {
        volkInitialize();
        vkGetDeviceProcAddr = nullptr; // the next instance looks it up
    }

    [[nodiscard]] FaultTable& table() { return table_; }

  private:
    static PFN_vkGetInstanceProcAddr realLoader() {
        volkInitialize();
        return vkGetInstanceProcAddr;
    }
    FaultTable table_;
};

std::string makeDevice(Play& play, bool validate) {
    const device::VulkanInstance instance =
        play.askFirst("VulkanInstance::create", [&] { return device::VulkanInstance::create({.validate = validate}); });
    const std::vector<device::PhysicalDevice> devices =
        play.askFirst("VulkanInstance::devices", [&] { return instance.devices(); });
    const device::PhysicalDevice chosen = play.quietly([&] { return device::chooseDevice(devices, {}); });
    const device::VulkanDevice device =
        play.askFirst("VulkanDevice::create", [&] { return device::VulkanDevice::create(instance, chosen); });
    const ContextDesc& desc = device.contextDesc();
    return device.physical().name + " " + std::to_string(devices.size()) + " " +
           std::to_string(desc.enabledInstanceExtensions.size()) + " " +
           std::to_string(desc.enabledDeviceExtensions.size());
}

class DeviceSweep : public GpuTest, public testing::WithParamInterface<bool> {};

TEST_P(DeviceSweep, EveryCallFailsOnce) {
    VolkUnderFaults volk;
    const DeviceFunctions none;
    const Stage stage{volk.table(), {}, {}, none};
    const Scenario scenario{"device", [](Play& play) { return makeDevice(play, GetParam()); }};
    expectNoFailures(sweep(
        scenario.name, [&](const std::optional<Fault>& fault) { return play(scenario, fault, stage); }, 1));
}

INSTANTIATE_TEST_SUITE_P(All, DeviceSweep, testing::Bool(), [](const testing::TestParamInfo<bool>& validates) {
    return validates.param ? "Validated" : "Plain";
});

} // namespace
} // namespace voxtact::test

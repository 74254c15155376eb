// SPDX-License-Identifier: MIT
// Which device --device means, on machines that this one is not.
#include "vulkan/own/vulkan_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voxtact::test {
namespace {

using device::PhysicalDevice;
using testing::AllOf;
using testing::HasSubstr;

device::PhysicalDevice device(std::uint32_t index, const char* name, VkPhysicalDeviceType type,
                              std::uint32_t version = VK_API_VERSION_1_3) {
    device::PhysicalDevice device;
    device.index = index;
    device.name = name;
    device.type = type;
    device.apiVersion = version;
    return device;
}

std::uint32_t chosen(const std::vector<device::PhysicalDevice>& devices, const char* wanted) {
    const auto result = device::chooseDevice(devices, wanted);
    EXPECT_TRUE(result.ok());
    return result.ok() ? result->index : ~0U;
}

std::string refusal(const std::vector<device::PhysicalDevice>& devices, const char* wanted) {
    const auto result = device::chooseDevice(devices, wanted);
    EXPECT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::InvalidArgument);
    return result.error().text;
}

const std::vector<device::PhysicalDevice> kMachine{
    device(0, "llvmpipe (LLVM 15.0.6, 256 bits)", VK_PHYSICAL_DEVICE_TYPE_CPU),
    device(1, "Intel(R) UHD Graphics", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU),
    device(2, "NVIDIA GeForce A", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU),
    device(3, "NVIDIA GeForce B", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU),
};

TEST(ChooseDevice, FirstDiscreteElseWhatThereIs) {
    EXPECT_EQ(chosen(kMachine, ""), 2U);
    EXPECT_EQ(chosen({kMachine[0], kMachine[1]}, ""), 1U);
    EXPECT_EQ(chosen({kMachine[0]}, ""), 0U);
    EXPECT_EQ(chosen({device(0, "old", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_API_VERSION_1_1),
                      device(1, "new", VK_PHYSICAL_DEVICE_TYPE_CPU)},
                     ""),
              1U);
}

TEST(ChooseDevice, ByNumber) {
    EXPECT_EQ(chosen(kMachine, "0"), 0U);
    EXPECT_EQ(chosen(kMachine, "3"), 3U);
    EXPECT_THAT(refusal(kMachine, "4"),
                AllOf(HasSubstr("'4'"), HasSubstr("0 llvmpipe"), HasSubstr("3 NVIDIA GeForce B")));
}

TEST(ChooseDevice, ByPartOfTheName) {
    EXPECT_EQ(chosen(kMachine, "LLVMPIPE"), 0U);
    EXPECT_EQ(chosen(kMachine, "geforce b"), 3U);
    EXPECT_THAT(refusal(kMachine, "nvidia"), AllOf(HasSubstr("several"), HasSubstr("2 NVIDIA GeForce A")));
    EXPECT_THAT(refusal(kMachine, "radeon"), AllOf(HasSubstr("'radeon'"), HasSubstr("1 Intel")));
}

} // namespace
} // namespace voxtact::test

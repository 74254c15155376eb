// SPDX-License-Identifier: MIT
// check() and requirements(), with a loader that needs no driver.
#include "voxtact/context.h"

#include <gmock/gmock.h>

#include <cstring>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::uint32_t fakeDeviceVersion = VK_API_VERSION_1_3;
const char* fakeAbsent = nullptr;
constexpr VkShaderStageFlags kBothStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
VkShaderStageFlags fakeSubgroupStages = kBothStages;
constexpr std::uint32_t kManyBuffers = 16;
std::uint32_t fakeStorageBuffers = kManyBuffers;

VkPhysicalDeviceFloatControlsProperties fakeFloats{};

void VKAPI_PTR doNothing() {}

void VKAPI_PTR fakeProperties(VkPhysicalDevice, VkPhysicalDeviceProperties2* properties) {
    properties->properties.apiVersion = fakeDeviceVersion;
    std::strcpy(properties->properties.deviceName, "fake");
    properties->properties.limits.maxPerStageDescriptorStorageBuffers = fakeStorageBuffers;
    for (auto* next = static_cast<VkBaseOutStructure*>(properties->pNext); next != nullptr; next = next->pNext) {
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES) {
            auto* subgroup = reinterpret_cast<VkPhysicalDeviceSubgroupProperties*>(next);
            subgroup->supportedStages = fakeSubgroupStages;
            subgroup->supportedOperations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
                                            VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
        } else if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES) {
            auto* floats = reinterpret_cast<VkPhysicalDeviceFloatControlsProperties*>(next);
            floats->shaderSignedZeroInfNanPreserveFloat32 = fakeFloats.shaderSignedZeroInfNanPreserveFloat32;
            floats->shaderRoundingModeRTEFloat32 = fakeFloats.shaderRoundingModeRTEFloat32;
            floats->shaderSignedZeroInfNanPreserveFloat64 = fakeFloats.shaderSignedZeroInfNanPreserveFloat64;
            floats->shaderRoundingModeRTEFloat64 = fakeFloats.shaderRoundingModeRTEFloat64;
        }
    }
}

PFN_vkVoidFunction VKAPI_PTR fakeDeviceLoader(VkDevice, const char* name) {
    if (fakeAbsent != nullptr && std::strcmp(name, fakeAbsent) == 0) {
        return nullptr;
    }
    return &doNothing;
}

PFN_vkVoidFunction VKAPI_PTR fakeLoader(VkInstance, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&fakeDeviceLoader);
    }
    if (std::strcmp(name, "vkGetPhysicalDeviceProperties2") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&fakeProperties);
    }
    return &doNothing;
}

class RequirementsTest : public testing::Test {
  protected:
    void SetUp() override {
        fakeDeviceVersion = VK_API_VERSION_1_3;
        fakeAbsent = nullptr;
        fakeSubgroupStages = kBothStages;
        fakeStorageBuffers = kManyBuffers;
        fakeFloats.shaderSignedZeroInfNanPreserveFloat32 = VK_TRUE;
        fakeFloats.shaderRoundingModeRTEFloat32 = VK_TRUE;
        fakeFloats.shaderSignedZeroInfNanPreserveFloat64 = VK_TRUE;
        fakeFloats.shaderRoundingModeRTEFloat64 = VK_TRUE;
        desc_.getInstanceProcAddr = &fakeLoader;
        // Never dereferenced: the fake loader's functions take no notice of them.
        desc_.instance = reinterpret_cast<VkInstance>(std::uintptr_t{1});
        desc_.physicalDevice = reinterpret_cast<VkPhysicalDevice>(std::uintptr_t{2});
        desc_.device = reinterpret_cast<VkDevice>(std::uintptr_t{3});
        desc_.apiVersion = VK_API_VERSION_1_3;
        VkPhysicalDeviceFeatures2 all{};
        all.features.occlusionQueryPrecise = VK_TRUE;
        all.features.fragmentStoresAndAtomics = VK_TRUE;
        all.features.geometryShader = VK_TRUE;
        all.features.shaderFloat64 = VK_TRUE;
        request_.emplace(&all);
        desc_.enabledFeatures = &request_->features2;
    }

    ContextDesc desc_;
    std::optional<FeatureRequest> request_;
};

TEST_F(RequirementsTest, EverythingThere) {
    const CheckReport report = check(desc_);
    EXPECT_TRUE(report.usable);
    EXPECT_THAT(report.missing, IsEmpty());
    for (const MethodSupport& method : report.methods) {
        EXPECT_TRUE(method.available) << toString(method.method);
    }
}

TEST_F(RequirementsTest, AZeroDescriptionNamesEverything) {
    const CheckReport report = check({});
    EXPECT_FALSE(report.usable);
    for (const char* what : {"getInstanceProcAddr", "instance", "physicalDevice", "device", "enabledFeatures",
                             "apiVersion", "dynamicRendering", "synchronization2", "occlusionQueryPrecise",
                             "fragmentStoresAndAtomics", "shaderFloat64"}) {
        EXPECT_THAT(report.missing, Contains(HasSubstr(what)));
    }
    const Result<Context> context = Context::create({});
    ASSERT_FALSE(context.ok());
    EXPECT_EQ(context.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(context.error().text, HasSubstr("ContextDesc::device is null"));
}

TEST_F(RequirementsTest, RecommendedFeaturesCostMethods) {
    request_->features2.features.occlusionQueryPrecise = VK_FALSE;
    const CheckReport report = check(desc_);
    EXPECT_TRUE(report.usable);
    EXPECT_THAT(report.missing, Contains(HasSubstr("no counting method query")));
    for (const MethodSupport& method : report.methods) {
        EXPECT_EQ(method.available, method.method != CountingMethod::Query);
    }
}

TEST_F(RequirementsTest, SubgroupOperationsCostMethods) {
    fakeSubgroupStages = VK_SHADER_STAGE_COMPUTE_BIT;
    for (const MethodSupport& method : check(desc_).methods) {
        EXPECT_EQ(method.available, method.method != CountingMethod::Subgroup) << method.reason;
    }
}

TEST_F(RequirementsTest, FewStorageBuffersCostCompute) {
    fakeStorageBuffers = 4; // Vulkan promises no more
    for (const MethodSupport& method : check(desc_).methods) {
        EXPECT_EQ(method.available, method.method != CountingMethod::Compute) << method.reason;
    }
    EXPECT_THAT(check(desc_).methods.back().reason, HasSubstr("maxPerStageDescriptorStorageBuffers"));
}

TEST_F(RequirementsTest, DoublesThatAreNotIeeeCostPosesOnTheDevice) {
    const auto named = [&](const char* what) {
        return ElementsAre(AllOf(HasSubstr(what), HasSubstr("no poses on the device")));
    };
    fakeFloats.shaderRoundingModeRTEFloat64 = VK_FALSE;
    EXPECT_TRUE(check(desc_).usable);
    EXPECT_THAT(check(desc_).missing, named("shaderRoundingModeRTEFloat64 is not reported"));
    fakeFloats.shaderSignedZeroInfNanPreserveFloat64 = VK_FALSE;
    EXPECT_THAT(check(desc_).missing, named("shaderSignedZeroInfNanPreserveFloat64 is not reported"));
    request_->features2.features.shaderFloat64 = VK_FALSE;
    EXPECT_THAT(check(desc_).missing, named("shaderFloat64 is not enabled"));
}

TEST_F(RequirementsTest, FloatsThatAreNotIeeeCostTheCertifiedAnswerAndPosesOnTheDevice) {
    fakeFloats.shaderRoundingModeRTEFloat32 = VK_FALSE;
    const CheckReport rounding = check(desc_);
    EXPECT_TRUE(rounding.usable);
    EXPECT_THAT(rounding.missing, ElementsAre(AllOf(HasSubstr("shaderRoundingModeRTEFloat32 is not reported"),
                                                    HasSubstr("no projection certified"))));
    fakeFloats.shaderSignedZeroInfNanPreserveFloat32 = VK_FALSE;
    const CheckReport both = check(desc_);
    EXPECT_THAT(both.missing, ElementsAre(HasSubstr("shaderSignedZeroInfNanPreserveFloat32 is not reported")));
    for (const MethodSupport& method : both.methods) {
        EXPECT_TRUE(method.available) << method.reason;
    }
}

TEST_F(RequirementsTest, SingleFeatureStructsAreRead) {
    VkPhysicalDeviceSynchronization2Features synchronization{};
    synchronization.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES;
    synchronization.synchronization2 = VK_TRUE;
    VkPhysicalDeviceDynamicRenderingFeatures rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES;
    rendering.pNext = &synchronization;
    rendering.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &rendering;
    desc_.enabledFeatures = &features;
    EXPECT_TRUE(check(desc_).usable);
    rendering.pNext = nullptr;
    EXPECT_THAT(check(desc_).missing, Contains(HasSubstr("synchronization2")));
}

TEST_F(RequirementsTest, OldVersionsAndAbsentFunctionsAreNamed) {
    desc_.apiVersion = VK_API_VERSION_1_1;
    EXPECT_THAT(check(desc_).missing, Contains(HasSubstr("1.1")));
    desc_.apiVersion = VK_API_VERSION_1_3;
    fakeDeviceVersion = VK_API_VERSION_1_2;
    EXPECT_THAT(check(desc_).missing, Contains(HasSubstr("the device fake has Vulkan 1.2")));
    fakeDeviceVersion = VK_API_VERSION_1_3;
    fakeAbsent = "vkCmdBeginQuery";
    EXPECT_THAT(check(desc_).missing, Contains(HasSubstr("vkCmdBeginQuery")));
    EXPECT_FALSE(check(desc_).usable);
}

TEST_F(RequirementsTest, TheRequestAsksForWhatIsSupported) {
    const FeatureRequest none(nullptr);
    EXPECT_EQ(none.features2.features.occlusionQueryPrecise, VK_FALSE);
    EXPECT_EQ(none.vulkan13.dynamicRendering, VK_TRUE);
    EXPECT_EQ(request_->features2.features.occlusionQueryPrecise, VK_TRUE);
    for (const Requirement& requirement : requirements()) {
        EXPECT_NE(std::strlen(requirement.without), 0U);
    }
}

TEST_F(RequirementsTest, OptionalExtensionsAreNotMissed) {
    ASSERT_EQ(optionalDeviceExtensions().size(), 1U);
    EXPECT_STREQ(optionalDeviceExtensions()[0], "VK_EXT_conservative_rasterization");
    EXPECT_THAT(check(desc_).missing, IsEmpty());
    desc_.enabledDeviceExtensions = optionalDeviceExtensions();
    EXPECT_THAT(check(desc_).missing, IsEmpty());
}

} // namespace
} // namespace voxtact::test

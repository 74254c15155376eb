// SPDX-License-Identifier: MIT
// Which methods a device can do, and the self-test.
#include "gpu_fixture.h"
#include "interception.h"
#include "vulkan/context_impl.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

class MethodsTest : public GpuTest {
  protected:
    /// A second device, with features taken away.
    device::VulkanDevice deviceWithout(const std::function<void(FeatureRequest&)>& adjust) {
        const auto devices = take(gpu().instance.devices());
        const auto chosen = take(device::chooseDevice(devices, {}));
        return take(device::VulkanDevice::create(gpu().instance, chosen, {.adjustFeatures = adjust}));
    }
};

TEST_F(MethodsTest, SelfTestTrustsEveryMethod) {
    const auto verdicts = take(selfTest(context(), queue()));
    ASSERT_EQ(verdicts.size(), context().methods().size());
    for (const SelfTestVerdict& verdict : verdicts) {
        EXPECT_TRUE(verdict.available) << toString(verdict.method);
        EXPECT_TRUE(verdict.trusted) << toString(verdict.method) << ": " << verdict.text;
    }
    EXPECT_THAT(verdicts[0].text, HasSubstr("half-opaque 512 of 512"));
}

TEST_F(MethodsTest, QueryNeedsPreciseQueries) {
    const device::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.features2.features.occlusionQueryPrecise = VK_FALSE; });
    const Context context = take(Context::create(device.contextDesc()));
    EXPECT_FALSE(context.supports(CountingMethod::Query));
    EXPECT_TRUE(context.supports(CountingMethod::QueryAny));
    EXPECT_EQ(context.defaultMethod(), CountingMethod::Atomic);
    const Result<Detector> detector = Detector::raster(context, {.method = CountingMethod::Query});
    ASSERT_FALSE(detector.ok());
    EXPECT_EQ(detector.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(detector.error().text, HasSubstr("occlusionQueryPrecise"));
    for (const SelfTestVerdict& verdict : take(selfTest(context, device.queueAccess()))) {
        EXPECT_EQ(verdict.trusted, verdict.method != CountingMethod::Query) << verdict.text;
    }
}

TEST_F(MethodsTest, AtomicNeedsFragmentStores) {
    const device::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.features2.features.fragmentStoresAndAtomics = VK_FALSE; });
    const Context context = take(Context::create(device.contextDesc()));
    EXPECT_FALSE(context.supports(CountingMethod::Atomic));
    EXPECT_EQ(context.defaultMethod(), CountingMethod::Query);
    const Result<Detector> detector = Detector::raster(context, {.method = CountingMethod::Atomic});
    ASSERT_FALSE(detector.ok());
    EXPECT_THAT(detector.error().text, HasSubstr("fragmentStoresAndAtomics"));
    // The queries still count: their pipelines hold no storage writes.
    for (const SelfTestVerdict& verdict : take(selfTest(context, device.queueAccess()))) {
        const bool stores = verdict.method == CountingMethod::Atomic || verdict.method == CountingMethod::Subgroup;
        EXPECT_EQ(verdict.trusted, !stores) << verdict.text;
    }
}

TEST_F(MethodsTest, ComputeNeedsNoFeature) {
    const device::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.features2.features = VkPhysicalDeviceFeatures{}; });
    const Context context = take(Context::create(device.contextDesc()));
    EXPECT_EQ(context.defaultMethod(), CountingMethod::QueryAny);
    for (const SelfTestVerdict& verdict : take(selfTest(context, device.queueAccess()))) {
        const bool trusted = verdict.method == CountingMethod::QueryAny || verdict.method == CountingMethod::Compute;
        EXPECT_EQ(verdict.trusted, trusted) << verdict.text;
    }
    for (const Projection projection :
         {Projection::View, Projection::TwoView, Projection::DominantAxis, Projection::Certified}) {
        // Floats that are not as they should be are the device's, no feature.
        if (projection != Projection::Certified || missingFloatControl(context.impl().floatControls) == nullptr) {
            take(Detector::create(context, AnyDesc{.method = CountingMethod::Compute, .projection = projection}));
        }
    }
    EXPECT_THAT(Detector::raster(context, {.method = CountingMethod::Cpu}).error().text, HasSubstr("voxtact/cpu.h"));
}

PFN_vkGetPhysicalDeviceProperties2 realProperties = nullptr;
PFN_vkCreateShaderModule realShaderModule = nullptr;
bool bareFloats = false; ///< the device is taken for one that promises nothing
std::vector<std::vector<std::uint32_t>> madeModules;

void VKAPI_PTR propertiesOfFloats(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
    realProperties(device, properties);
    for (auto* next = static_cast<VkBaseOutStructure*>(properties->pNext); next != nullptr && bareFloats;
         next = next->pNext) {
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES) {
            auto* floats = reinterpret_cast<VkPhysicalDeviceFloatControlsProperties*>(next);
            floats->shaderSignedZeroInfNanPreserveFloat32 = VK_FALSE;
            floats->shaderRoundingModeRTEFloat32 = VK_FALSE;
            floats->shaderDenormPreserveFloat32 = VK_FALSE;
        }
    }
}

VkResult VKAPI_PTR keptModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                              const VkAllocationCallbacks* allocator, VkShaderModule* module) {
    madeModules.emplace_back(info->pCode, info->pCode + info->codeSize / sizeof(std::uint32_t));
    return realShaderModule(device, info, allocator, module);
}

bool hasCapability(const std::vector<std::uint32_t>& spirv, std::uint32_t capability) {
    for (std::size_t at = 5; at < spirv.size() && (spirv[at] & 0xffffU) == 17; at += 2) {
        if (spirv[at + 1] == capability) {
            return true;
        }
    }
    return false;
}

TEST_F(MethodsTest, CertifiedNeedsIeeeFloats) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    ContextDesc desc = gpu().device.contextDesc();
    realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
        desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceProperties2"));
    realShaderModule = reinterpret_cast<PFN_vkCreateShaderModule>(reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        desc.getInstanceProcAddr(desc.instance, "vkGetDeviceProcAddr"))(desc.device, "vkCreateShaderModule"));
    loader.replace("vkGetPhysicalDeviceProperties2", &propertiesOfFloats);
    loader.replace("vkCreateShaderModule", &keptModule);
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    constexpr AnyDesc kCertified{.method = CountingMethod::Compute, .projection = Projection::Certified};
    for (const bool bare : {false, true}) {
        bareFloats = bare;
        madeModules.clear();
        const Context context = take(Context::create(desc));
        EXPECT_TRUE(context.supports(CountingMethod::Compute, Projection::View));
        EXPECT_FALSE(context.supports(CountingMethod::Query, Projection::Certified));
        EXPECT_TRUE(Detector::raster(context, {.method = CountingMethod::Compute}).ok());
        EXPECT_TRUE(Detector::raster(context, {.method = CountingMethod::Query}).ok());
        const Result<Detector> certified = Detector::create(context, kCertified);
        ASSERT_EQ(certified.ok(), context.supports(CountingMethod::Compute, Projection::Certified));
        EXPECT_FALSE(certified.ok() && bare);
        if (bare) {
            EXPECT_EQ(certified.error().code, ErrorCode::Unsupported);
            EXPECT_THAT(certified.error().text, HasSubstr("shaderSignedZeroInfNanPreserveFloat32"));
            EXPECT_THAT(check(desc).missing, Contains(HasSubstr("shaderSignedZeroInfNanPreserveFloat32")));
        }
        EXPECT_GE(madeModules.size(), 3U);
        for (const std::vector<std::uint32_t>& module : madeModules) {
            EXPECT_EQ(hasCapability(module, 4466), certified.ok()); // SignedZeroInfNanPreserve
            EXPECT_EQ(hasCapability(module, 4467), certified.ok()); // RoundingModeRTE
        }
    }
}

TEST_F(MethodsTest, RequiredFeaturesAreNamedWhenMissing) {
    const device::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.vulkan13.dynamicRendering = VK_FALSE; });
    const Result<Context> context = Context::create(device.contextDesc());
    ASSERT_FALSE(context.ok());
    EXPECT_EQ(context.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(context.error().text, HasSubstr("dynamicRendering"));
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
// Which methods a device can do, and the self-test.
#include "gpu_fixture.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class MethodsTest : public GpuTest {
  protected:
    /// A second device, with features taken away.
    app::VulkanDevice deviceWithout(const std::function<void(FeatureRequest&)>& adjust) {
        const auto devices = take(gpu().instance.devices());
        const auto chosen = take(app::chooseDevice(devices, {}));
        return take(app::VulkanDevice::create(gpu().instance, chosen, {.adjustFeatures = adjust}));
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
    const app::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.features2.features.occlusionQueryPrecise = VK_FALSE; });
    const Context context = take(Context::create(device.contextDesc()));
    EXPECT_FALSE(context.supports(CountingMethod::Query));
    EXPECT_TRUE(context.supports(CountingMethod::QueryAny));
    EXPECT_EQ(context.defaultMethod(), CountingMethod::Atomic);
    const Result<Detector> detector = Detector::create(context, {.method = CountingMethod::Query});
    ASSERT_FALSE(detector.ok());
    EXPECT_EQ(detector.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(detector.error().text, HasSubstr("occlusionQueryPrecise"));
    for (const SelfTestVerdict& verdict : take(selfTest(context, device.queueAccess()))) {
        EXPECT_EQ(verdict.trusted, verdict.method != CountingMethod::Query) << verdict.text;
    }
}

TEST_F(MethodsTest, AtomicNeedsFragmentStores) {
    const app::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.features2.features.fragmentStoresAndAtomics = VK_FALSE; });
    const Context context = take(Context::create(device.contextDesc()));
    EXPECT_FALSE(context.supports(CountingMethod::Atomic));
    EXPECT_EQ(context.defaultMethod(), CountingMethod::Query);
    const Result<Detector> detector = Detector::create(context, {.method = CountingMethod::Atomic});
    ASSERT_FALSE(detector.ok());
    EXPECT_THAT(detector.error().text, HasSubstr("fragmentStoresAndAtomics"));
    // The queries still count: their pipelines hold no storage writes.
    for (const SelfTestVerdict& verdict : take(selfTest(context, device.queueAccess()))) {
        const bool stores = verdict.method == CountingMethod::Atomic || verdict.method == CountingMethod::Subgroup;
        EXPECT_EQ(verdict.trusted, !stores) << verdict.text;
    }
}

TEST_F(MethodsTest, ComputeNeedsInt64) {
    const app::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.features2.features.shaderInt64 = VK_FALSE; });
    const Context context = take(Context::create(device.contextDesc()));
    const Result<Detector> detector = Detector::create(context, {.method = CountingMethod::Compute});
    ASSERT_FALSE(detector.ok());
    EXPECT_THAT(detector.error().text, HasSubstr("shaderInt64"));
    EXPECT_THAT(Detector::create(context, {.method = CountingMethod::Cpu}).error().text, HasSubstr("voxtact/cpu.h"));
}

TEST_F(MethodsTest, RequiredFeaturesAreNamedWhenMissing) {
    const app::VulkanDevice device =
        deviceWithout([](FeatureRequest& request) { request.vulkan13.dynamicRendering = VK_FALSE; });
    const Result<Context> context = Context::create(device.contextDesc());
    ASSERT_FALSE(context.ok());
    EXPECT_EQ(context.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(context.error().text, HasSubstr("dynamicRendering"));
}

} // namespace
} // namespace voxtact::test

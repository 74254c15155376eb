// SPDX-License-Identifier: MIT
#include "gpu_fixture.h"
#include "core/method/method_table.h"

#include <cstring>
#include <optional>

namespace voxtact::test {

namespace {

// Set once by main().
bool requireDevice = false;
bool validate = true;

Result<TestDevice> makeDevice() {
    Result<device::VulkanInstance> instance = device::VulkanInstance::create({.validate = validate});
    if (!instance.ok()) {
        return instance.error();
    }
    const Result<std::vector<device::PhysicalDevice>> devices = instance->devices();
    if (!devices.ok()) {
        return devices.error();
    }
    const Result<device::PhysicalDevice> chosen = device::chooseDevice(*devices, {});
    if (!chosen.ok()) {
        return chosen.error();
    }
    Result<device::VulkanDevice> device = device::VulkanDevice::create(*instance, *chosen);
    if (!device.ok()) {
        return device.error();
    }
    Result<Context> context = Context::create(device->contextDesc());
    if (!context.ok()) {
        return context.error();
    }
    const QueueAccess queue = device->queueAccess();
    return TestDevice{std::move(*instance), std::move(*device), std::move(*context), queue};
}

} // namespace

Result<TestDevice*> sharedDevice() {
    static Result<TestDevice> device = makeDevice();
    if (!device.ok()) {
        return device.error();
    }
    return &*device;
}

void GpuTest::SetUp() {
    const Result<TestDevice*> device = sharedDevice();
    if (!device.ok()) {
        if (requireDevice) {
            FAIL() << "a device is required: " << device.error().text;
        }
        GTEST_SKIP() << device.error().text;
    }
    device_ = *device;
    messagesBefore_ = device_->instance.messages()->all().size();
}

void GpuTest::TearDown() {
    if (device_ == nullptr) {
        return;
    }
    const std::vector<std::string> messages = device_->instance.messages()->all();
    for (std::size_t i = messagesBefore_; i < messages.size(); ++i) {
        ADD_FAILURE() << "validation: " << messages[i];
    }
}

PairAnswer GpuTest::detectOne(const AnyDesc& desc, const BatchItem& item, const View& view, double threshold) const {
    BlockingDetector one = detector(desc);
    const BatchAnswer answer = take(one.detect({std::span(&item, 1), view, threshold}));
    EXPECT_EQ(answer.pairs.size(), 1U);
    return answer.pairs.front();
}

std::uint64_t GpuTest::survivors(const Mesh& mesh, const Volume& volume, const TransferFunction& function,
                                 const View& view, double threshold, const Mat4& world_from_object) const {
    const BatchItem item{&mesh, &volume, &function, std::span(&world_from_object, 1)};
    const PairAnswer query = detectOne({.method = CountingMethod::Query}, item, view, threshold);
    const PairAnswer any = detectOne({.method = CountingMethod::QueryAny}, item, view, threshold);
    const PairAnswer compute =
        detectOne({.method = CountingMethod::Compute, .filter = Filter::Exact}, item, view, threshold);
    for (const CountingMethod method : methodsThatCount(Coverage::Rasteriser)) {
        const PairAnswer answer = detectOne({.method = method}, item, view, threshold);
        EXPECT_EQ(answer.count, query.count) << toString(method);
        EXPECT_EQ(answer.method, method);
    }
    EXPECT_EQ(query.count, compute.count) << "compute";
    EXPECT_EQ(any.hit, query.hit);
    EXPECT_EQ(query.exactness, Exactness::Exact);
    EXPECT_EQ(any.exactness, Exactness::LowerBound);
    return query.count;
}

} // namespace voxtact::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--require-device") == 0) {
            voxtact::test::requireDevice = true;
        } else if (std::strcmp(argv[i], "--no-validation") == 0) {
            voxtact::test::validate = false; // for drivers that the layer cannot be asked about
        }
    }
    const int failed = RUN_ALL_TESTS();
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    constexpr int kSkipped = 77; // as suites.cmake tells ctest
    return failed == 0 && tests.successful_test_count() == 0 && tests.skipped_test_count() > 0 ? kSkipped : failed;
}

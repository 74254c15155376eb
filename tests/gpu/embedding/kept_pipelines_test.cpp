// SPDX-License-Identifier: MIT
// Which compute pipelines a device is asked for: one of each kind, however many Detectors there are.
#include "gpu_fixture.h"
#include "interception.h"

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

namespace voxtact::test {
namespace {

std::atomic<unsigned> pipelinesMade{0};
PFN_vkCreateComputePipelines makeReally = nullptr;

VkResult VKAPI_PTR makeAndCount(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* allocator,
                                VkPipeline* out) {
    pipelinesMade += count;
    return makeReally(device, cache, count, infos, allocator, out);
}

class KeptPipelinesTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        ContextDesc desc = gpu().device.contextDesc();
        loader_.emplace(gpu().instance.getInstanceProcAddr());
        desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
        loader_->replace("vkCreateComputePipelines", &makeAndCount);
        const auto getDevice = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
            gpu().instance.getInstanceProcAddr()(desc.instance, "vkGetDeviceProcAddr"));
        makeReally = reinterpret_cast<PFN_vkCreateComputePipelines>(getDevice(desc.device, "vkCreateComputePipelines"));
        context_.emplace(take(Context::create(desc)));
        pipelinesMade = 0;
    }
    void TearDown() override {
        context_.reset();
        GpuTest::TearDown();
    }

    /// How many pipelines it takes to make one.
    unsigned madeFor(const AnyDesc& desc) {
        const unsigned before = pipelinesMade;
        kept_.push_back(take(Detector::create(*context_, desc)));
        return pipelinesMade - before;
    }
    [[nodiscard]] const Context& counted() const { return *context_; }
    void endAll() { kept_.clear(); }

  private:
    std::optional<Interception> loader_;
    std::optional<Context> context_;
    std::vector<Detector> kept_;
};

AnyDesc certified() {
    return {.method = CountingMethod::Compute, .projection = Projection::Certified, .stopAtFirst = true};
}

TEST_F(KeptPipelinesTest, DetectorsOfAKindShareThem) {
    const AnyDesc view{.method = CountingMethod::Compute, .filter = Filter::Exact};
    EXPECT_EQ(madeFor(view), 1U);
    EXPECT_EQ(madeFor(view), 0U);
    endAll();
    EXPECT_EQ(madeFor(view), 0U) << "they outlive the detectors";
    AnyDesc other = view;
    other.projection = Projection::TwoView;
    EXPECT_EQ(madeFor(other), 1U);
    other.outputs.triangles = true;
    EXPECT_EQ(madeFor(other), 1U);
}

TEST_F(KeptPipelinesTest, NumbersAreNoKinds) {
    AnyDesc desc = certified();
    EXPECT_EQ(madeFor(desc), 6U);
    desc.resolution = kDefaultResolution / 2;
    EXPECT_EQ(madeFor(desc), 0U);
    desc.counters = true;
    EXPECT_GT(madeFor(desc), 6U) << "what counts is another program";
}

TEST_F(KeptPipelinesTest, ThreadsWaitForEachOther) {
    std::vector<std::thread> threads;
    std::atomic<unsigned> made{0};
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            const Result<Detector> one =
                Detector::raster(counted(), {.method = CountingMethod::Compute, .filter = Filter::Exact});
            made += one.ok() ? 1 : 0;
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(made, 4U);
    EXPECT_EQ(pipelinesMade, 1U);
}

} // namespace
} // namespace voxtact::test

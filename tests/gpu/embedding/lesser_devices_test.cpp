// SPDX-License-Identifier: MIT
// Devices that offer less than the one at hand, by an interposed loader: a queue that only computes, floats that cannot
// be filtered linearly, several families of queues. What they can do is the same, bit for bit, and the rest is refused
// by name.
#include "core/method/method_table.h"
#include "gpu_fixture.h"
#include "interception.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <set>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Stages that a queue without graphics does not have.
constexpr VkPipelineStageFlags2 kOfGraphics =
    VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
    VK_PIPELINE_STAGE_2_TESSELLATION_CONTROL_SHADER_BIT | VK_PIPELINE_STAGE_2_TESSELLATION_EVALUATION_SHADER_BIT |
    VK_PIPELINE_STAGE_2_GEOMETRY_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT |
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT |
    VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT;

/// What the interposed functions do, and saw. One test at a time.
struct Lesser {
    bool onlyComputes = false;
    bool floatsUnfiltered = false;
    std::uint32_t families = 1; ///< all like the first
    VkPipelineStageFlags2 stages = 0;
    std::set<VkSharingMode> sharing;
    std::set<std::uint32_t> sharedBy;

    PFN_vkGetPhysicalDeviceQueueFamilyProperties realFamilies = nullptr;
    PFN_vkGetPhysicalDeviceFormatProperties realFormats = nullptr;
    PFN_vkCmdPipelineBarrier2 realBarrier = nullptr;
    PFN_vkCreateBuffer realBuffer = nullptr;
    PFN_vkCreateImage realImage = nullptr;
};
Lesser lesser;

void VKAPI_PTR familyProperties(VkPhysicalDevice device, std::uint32_t* count, VkQueueFamilyProperties* out) {
    if (out == nullptr) {
        *count = lesser.families;
        return;
    }
    std::uint32_t one = 1;
    VkQueueFamilyProperties first{};
    lesser.realFamilies(device, &one, &first);
    if (lesser.onlyComputes) {
        first.queueFlags &= ~static_cast<VkQueueFlags>(VK_QUEUE_GRAPHICS_BIT);
    }
    std::fill_n(out, *count, first);
}

void VKAPI_PTR formatProperties(VkPhysicalDevice device, VkFormat format, VkFormatProperties* out) {
    lesser.realFormats(device, format, out);
    if (lesser.floatsUnfiltered && format == VK_FORMAT_R32_SFLOAT) {
        out->optimalTilingFeatures &=
            ~static_cast<VkFormatFeatureFlags>(VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
    }
}

void VKAPI_PTR barrierSeen(VkCommandBuffer commandBuffer, const VkDependencyInfo* info) {
    for (std::uint32_t i = 0; i < info->memoryBarrierCount; ++i) {
        lesser.stages |= info->pMemoryBarriers[i].srcStageMask | info->pMemoryBarriers[i].dstStageMask;
    }
    for (std::uint32_t i = 0; i < info->imageMemoryBarrierCount; ++i) {
        lesser.stages |= info->pImageMemoryBarriers[i].srcStageMask | info->pImageMemoryBarriers[i].dstStageMask;
    }
    for (std::uint32_t i = 0; i < info->bufferMemoryBarrierCount; ++i) {
        lesser.stages |= info->pBufferMemoryBarriers[i].srcStageMask | info->pBufferMemoryBarriers[i].dstStageMask;
    }
    lesser.realBarrier(commandBuffer, info);
}

/// Notes who shares; the real device has one family, to which all of it is exclusive.
template <class CreateInfo> CreateInfo unshared(const CreateInfo& info) {
    CreateInfo out = info;
    lesser.sharing.insert(info.sharingMode);
    lesser.sharedBy.insert(info.pQueueFamilyIndices, info.pQueueFamilyIndices + info.queueFamilyIndexCount);
    out.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    out.queueFamilyIndexCount = 0;
    out.pQueueFamilyIndices = nullptr;
    return out;
}

VkResult VKAPI_PTR createBuffer(VkDevice device, const VkBufferCreateInfo* info, const VkAllocationCallbacks* allocator,
                                VkBuffer* buffer) {
    const VkBufferCreateInfo plain = unshared(*info);
    return lesser.realBuffer(device, &plain, allocator, buffer);
}

VkResult VKAPI_PTR createImage(VkDevice device, const VkImageCreateInfo* info, const VkAllocationCallbacks* allocator,
                               VkImage* image) {
    const VkImageCreateInfo plain = unshared(*info);
    return lesser.realImage(device, &plain, allocator, image);
}

class LesserDeviceTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        lesser = {};
        const PFN_vkGetInstanceProcAddr real = gpu().instance.getInstanceProcAddr();
        const ContextDesc desc = gpu().device.contextDesc();
        const auto instanceFunction = [&](const char* name) { return real(desc.instance, name); };
        const auto getDevice = reinterpret_cast<PFN_vkGetDeviceProcAddr>(instanceFunction("vkGetDeviceProcAddr"));
        lesser.realFamilies = reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
            instanceFunction("vkGetPhysicalDeviceQueueFamilyProperties"));
        lesser.realFormats = reinterpret_cast<PFN_vkGetPhysicalDeviceFormatProperties>(
            instanceFunction("vkGetPhysicalDeviceFormatProperties"));
        lesser.realBarrier =
            reinterpret_cast<PFN_vkCmdPipelineBarrier2>(getDevice(desc.device, "vkCmdPipelineBarrier2"));
        lesser.realBuffer = reinterpret_cast<PFN_vkCreateBuffer>(getDevice(desc.device, "vkCreateBuffer"));
        lesser.realImage = reinterpret_cast<PFN_vkCreateImage>(getDevice(desc.device, "vkCreateImage"));
        loader_.emplace(real);
        loader_->replace("vkGetPhysicalDeviceQueueFamilyProperties", &familyProperties);
        loader_->replace("vkGetPhysicalDeviceFormatProperties", &formatProperties);
        loader_->replace("vkCmdPipelineBarrier2", &barrierSeen);
        loader_->replace("vkCreateBuffer", &createBuffer);
        loader_->replace("vkCreateImage", &createImage);
    }

    [[nodiscard]] ContextDesc desc() const {
        ContextDesc out = gpu().device.contextDesc();
        out.getInstanceProcAddr = Interception::getInstanceProcAddr();
        return out;
    }

    /// Half of a cube of values from 0 to 255 along x, and a square across it.
    struct Objects {
        Volume volume;
        Mesh mesh;
        TransferFunction function;
        LabelMap labels;
        Mat4 pose = identity();
        [[nodiscard]] BatchItem item() const { return {&mesh, &volume, &function, std::span(&pose, 1), &labels}; }
    };
    [[nodiscard]] Objects make(const Context& context, ScalarType type) const {
        constexpr ControlPoint kRamp[] = {{0, 0}, {255, 1}};
        const VolumeData volume =
            type == ScalarType::Float32
                ? makeVolume<float>(unitGrid(8), type,
                                    [](std::uint32_t x, std::uint32_t, std::uint32_t) { return x * 36.0; })
                : makeVolume<std::uint8_t>(unitGrid(8), ScalarType::UInt8,
                                           [](std::uint32_t x, std::uint32_t, std::uint32_t) { return x * 36.0; });
        const LabelData labels{unitGrid(2), {0, 1, 0, 1, 0, 1, 0, 1}, {0, 3}};
        return {take(Volume::upload(context, queue(), volume.view(), {.bricks = true, .editable = true})),
                take(Mesh::upload(context, queue(), makeFlat(0, 1, 0, 1, 0.5).view())),
                take(TransferFunction::upload(context, queue(), {kRamp, {0, 255}, kDefaultTableSize})),
                take(LabelMap::upload(context, queue(), labels))};
    }

    [[nodiscard]] static View view() { return flatView(0, 1, 64, 64); }

  private:
    std::optional<Interception> loader_;
};

TEST_F(LesserDeviceTest, AQueueThatOnlyComputesCountsByCompute) {
    if (!context().supports(CountingMethod::Compute)) {
        GTEST_SKIP() << "the device cannot count by compute";
    }
    const Objects usual = make(context(), ScalarType::UInt8);
    lesser.onlyComputes = true;
    const Context less = take(Context::create(desc()));
    const Objects objects = make(less, ScalarType::UInt8);
    for (const ProjectionRow& row : kProjectionTable) {
        // Every projection without outputs, and one of each kind of pass with all.
        for (const bool all : {false, true}) {
            if (all && row.projection != Projection::View && !row.certified) {
                continue;
            }
            const Outputs outputs{.triangles = all, .contacts = all, .bounds = all, .labels = all};
            const AnyDesc wanted{.method = CountingMethod::Compute,
                                 .projection = row.projection,
                                 .filter = Filter::Exact,
                                 .outputs = outputs};
            BlockingDetector here = take(BlockingDetector::create(less, wanted, queue()));
            const BatchItem item = objects.item();
            const BatchItem usualItem = usual.item();
            // Twice: the second time the Results are waited for.
            take(here.detect({{&item, 1}, view(), 0.5}));
            const BatchAnswer answer = take(here.detect({{&item, 1}, view(), 0.5}));
            const BatchAnswer expected = take(detector(wanted).detect({{&usualItem, 1}, view(), 0.5}));
            EXPECT_GT(answer.pairs[0].count, 0U) << row.name;
            EXPECT_EQ(answer.pairs[0].count, expected.pairs[0].count) << row.name;
            EXPECT_EQ(answer.triangles.size(), expected.triangles.size()) << row.name;
            EXPECT_EQ(answer.contactsFound, expected.contactsFound) << row.name;
        }
    }
    EXPECT_NE(lesser.stages, 0U);
    EXPECT_EQ(lesser.stages & kOfGraphics, 0U) << "a barrier names a stage that the queue does not have";
}

TEST_F(LesserDeviceTest, AQueueThatOnlyComputesCannotDraw) {
    lesser.onlyComputes = true;
    const Context less = take(Context::create(desc()));
    const Result<BlockingDetector> drawn =
        BlockingDetector::create(less, RasterDesc{.method = CountingMethod::QueryAny}, queue());
    ASSERT_FALSE(drawn.ok());
    EXPECT_EQ(drawn.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(drawn.error().text, HasSubstr("cannot draw"));
    for (const SelfTestVerdict& verdict : take(selfTest(less, queue()))) {
        EXPECT_EQ(verdict.trusted, verdict.method == CountingMethod::Compute && verdict.available) << verdict.text;
    }
    EXPECT_EQ(lesser.stages & kOfGraphics, 0U);
}

TEST_F(LesserDeviceTest, FloatsThatCannotBeFilteredAreReadExactly) {
    const Objects usual = make(context(), ScalarType::Float32);
    lesser.floatsUnfiltered = true;
    const Context less = take(Context::create(desc()));
    const Objects objects = make(less, ScalarType::Float32);
    const BatchItem item = objects.item();
    const BatchItem usualItem = usual.item();
    for (const MethodSupport& support : less.methods()) {
        if (!support.available || support.method == CountingMethod::Cpu) {
            continue;
        }
        const AnyDesc exact{.method = support.method, .filter = Filter::Exact};
        BlockingDetector here = take(BlockingDetector::create(less, exact, queue()));
        EXPECT_EQ(take(here.detect({{&item, 1}, view(), 0.5})).pairs[0].count,
                  take(detector(exact).detect({{&usualItem, 1}, view(), 0.5})).pairs[0].count)
            << toString(support.method);
        BlockingDetector filtered = take(
            BlockingDetector::create(less, RasterDesc{.method = support.method, .filter = Filter::Hardware}, queue()));
        const Result<BatchAnswer> refused = filtered.detect({{&item, 1}, view(), 0.5});
        ASSERT_FALSE(refused.ok()) << toString(support.method);
        EXPECT_EQ(refused.error().code, ErrorCode::Unsupported);
        EXPECT_THAT(refused.error().text, HasSubstr("cannot filter the volume's format linearly"));
        EXPECT_THAT(refused.error().text, HasSubstr("exact"));
    }
}

TEST_F(LesserDeviceTest, ATableThatCannotBeFilteredIsSaidToBe) {
    lesser.floatsUnfiltered = true;
    const Context less = take(Context::create(desc()));
    const Objects objects = make(less, ScalarType::UInt8);
    const BatchItem item = objects.item();
    BlockingDetector filtered = take(BlockingDetector::create(
        less, RasterDesc{.method = CountingMethod::QueryAny, .filter = Filter::Hardware}, queue()));
    const Result<BatchAnswer> refused = filtered.detect({{&item, 1}, view(), 0.5});
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.error().text, HasSubstr("cannot filter the transfer function's table linearly"));
}

TEST_F(LesserDeviceTest, FamiliesShareWhatIsMadeForThem) {
    lesser.families = 3;
    ContextDesc wanted = desc();
    {
        const Context alone = take(Context::create(wanted));
        const Objects objects = make(alone, ScalarType::UInt8);
        EXPECT_THAT(lesser.sharing, testing::ElementsAre(VK_SHARING_MODE_EXCLUSIVE));
    }
    lesser.sharing.clear();
    constexpr std::uint32_t kTwo[] = {0, 2};
    wanted.queueFamilies = kTwo;
    const Context shared = take(Context::create(wanted));
    const Objects objects = make(shared, ScalarType::UInt8);
    const BatchItem item = objects.item();
    BlockingDetector here =
        take(BlockingDetector::create(shared, RasterDesc{.method = CountingMethod::QueryAny}, queue()));
    EXPECT_TRUE(take(here.detect({{&item, 1}, view(), 0.5})).pairs[0].hit);
    EXPECT_THAT(lesser.sharing, testing::ElementsAre(VK_SHARING_MODE_CONCURRENT));
    EXPECT_THAT(lesser.sharedBy, testing::ElementsAre(0U, 2U));
}

TEST_F(LesserDeviceTest, FamiliesAreThereAndOnceEach) {
    lesser.families = 2;
    ContextDesc wanted = desc();
    constexpr std::uint32_t kMissing[] = {0, 2};
    wanted.queueFamilies = kMissing;
    EXPECT_THAT(Context::create(wanted).error().text,
                HasSubstr("ContextDesc::queueFamilies[1] is 2, the device has 2 queue families"));
    constexpr std::uint32_t kTwice[] = {1, 1};
    wanted.queueFamilies = kTwice;
    EXPECT_THAT(Context::create(wanted).error().text,
                HasSubstr("ContextDesc::queueFamilies[1] is 1, which is there before"));
    EXPECT_EQ(Context::create(wanted).error().code, ErrorCode::InvalidArgument);
    const CheckReport report = check(wanted);
    EXPECT_FALSE(report.usable);
    EXPECT_THAT(report.missing,
                testing::Contains(HasSubstr("ContextDesc::queueFamilies[1] is 1, which is there before")));
}

} // namespace
} // namespace voxtact::test

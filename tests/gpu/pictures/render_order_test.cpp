// SPDX-License-Identifier: MIT
// Pictures in an embedder's own command buffer.
#include "own_image.h"
#include "render_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <array>

namespace voxtact::test {
namespace {

constexpr VkExtent2D kOrderExtent{56, 48};
constexpr ControlPoint kOrderOpacity[] = {{30, 0}, {200, 0.3}};

class RenderOrderTest : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        function_.opacity = {kOrderOpacity, {0, 255}, 256};
        function_.opacityUnit = 20;
        function_.step = 5;
        scene_.clip_from_world = framingCamera(data_.grid, kOrderExtent.width, kOrderExtent.height);
    }

    VolumeData data_ = take(makeBuiltinVolume("head:32"));
    RenderTransferFunctionDesc function_;
    Scene scene_;
};

TEST_F(RenderOrderTest, UpdatesTakeEffectInCommandBufferOrder) {
    OwnImage image(gpu().device, kOrderExtent);
    constexpr ControlPoint kOther[] = {{90, 0}, {100, 0.5}};
    const RenderTransferFunctionDesc first = function_;
    RenderTransferFunctionDesc second = first;
    second.opacity.points = kOther;
    const Volume volume = upload(data_);
    RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), first));
    RenderTargets targets = take(RenderTargets::create(renderer(), kOrderExtent));
    scene_.volume = &volume;
    scene_.transferFunction = &function;
    const VkCommandBuffer commands = image.raw.begin();
    take(renderer().cmdRender(commands, scene_, image.target(targets)));
    const std::uint8_t* before = image.cmdCopy(commands);
    take(function.cmdUpdate(commands, second));
    take(renderer().cmdRender(commands, scene_, image.target(targets)));
    const std::uint8_t* after = image.cmdCopy(commands);
    image.raw.submitAndWait(commands);
    const auto expected = [&](const RenderTransferFunctionDesc& desc) {
        const RenderTransferFunction alone = take(RenderTransferFunction::upload(renderer(), queue(), desc));
        scene_.transferFunction = &alone;
        return take(blocking().render(scene_, kOrderExtent)).rgba;
    };
    EXPECT_EQ(std::vector<std::uint8_t>(before, before + image.bytes()), expected(first));
    EXPECT_EQ(std::vector<std::uint8_t>(after, after + image.bytes()), expected(second));
    EXPECT_NE(expected(first), expected(second));
}

TEST_F(RenderOrderTest, TimestampsOfMeshAndVolume) {
    if (!gpu().device.hasTimestamps()) {
        GTEST_SKIP() << "the queue has no timestamps";
    }
    OwnImage image(gpu().device, kOrderExtent);
    const Volume volume = upload(data_);
    const Mesh mesh = upload(take(makeEllipsoid(500)));
    const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), function_));
    RenderTargets targets = take(RenderTargets::create(renderer(), kOrderExtent));
    scene_.volume = &volume;
    scene_.transferFunction = &function;
    scene_.mesh = &mesh;
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 5;
    VkQueryPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(image.raw.vk().vkCreateQueryPool(image.raw.device(), &info, nullptr, &pool), VK_SUCCESS);
    const VkCommandBuffer commands = image.raw.begin();
    image.raw.vk().vkCmdResetQueryPool(commands, pool, 0, info.queryCount);
    Target target = image.target(targets);
    target.timestamps = pool;
    target.firstTimestamp = 1;
    take(renderer().cmdRender(commands, scene_, target));
    image.raw.submitAndWait(commands);
    std::array<std::uint64_t, 3> ticks{};
    EXPECT_EQ(image.raw.vk().vkGetQueryPoolResults(image.raw.device(), pool, 1, 3, sizeof ticks, ticks.data(),
                                                   sizeof ticks[0], VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_LT(ticks[0], ticks[1]);
    EXPECT_LT(ticks[1], ticks[2]);
    std::uint64_t none = 0;
    EXPECT_EQ(image.raw.vk().vkGetQueryPoolResults(image.raw.device(), pool, 4, 1, sizeof none, &none, sizeof none,
                                                   VK_QUERY_RESULT_64_BIT),
              VK_NOT_READY);
    image.raw.vk().vkDestroyQueryPool(image.raw.device(), pool, nullptr);
}

} // namespace
} // namespace voxtact::test

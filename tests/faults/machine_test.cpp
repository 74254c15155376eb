// SPDX-License-Identifier: MIT
// The machine itself: code with a known mistake in it must be complained of.
#include "driver/pretend_driver.h"
#include "embedder.h"
#include "sweep.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// Vulkan's functions as the library gets them on a stage.
DeviceFunctions above(const Stage& stage) {
    DeviceFunctions functions;
    functions.load(stage.context.getInstanceProcAddr, stage.context.instance, stage.context.device, true);
    return functions;
}

Pass playCode(const std::function<void(const DeviceFunctions&, VkDevice, const Stage&)>& code,
              const std::optional<Fault>& fault = std::nullopt) {
    return playDry({"code",
                    [&](Play& play) {
                        code(above(play.stage()), play.stage().context.device, play.stage());
                        return std::string();
                    }},
                   fault);
}

VkFence makeFence(const DeviceFunctions& vk, VkDevice device, VkFenceCreateFlags flags = 0) {
    VkFenceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    info.flags = flags;
    VkFence fence = VK_NULL_HANDLE;
    vk.CreateFence(device, &info, nullptr, &fence);
    return fence;
}

void submitNothing(const DeviceFunctions& vk, const Stage& stage, VkFence fence) {
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    vk.QueueSubmit2(stage.queue.queue, 1, &info, fence);
}

TEST(Machine, SeesWhatIsNotDestroyed) {
    const Pass pass = playCode([](const DeviceFunctions& vk, VkDevice device, const Stage&) { makeFence(vk, device); });
    EXPECT_THAT(pass.complaints, Contains(HasSubstr("Fence")));
}

TEST(Machine, SeesGarbageThatIsDestroyed) {
    const auto code = [](const DeviceFunctions& vk, VkDevice device, const Stage&) {
        vk.DestroyFence(device, makeFence(vk, device), nullptr);
    };
    EXPECT_THAT(playCode(code).complaints, IsEmpty());
    EXPECT_THAT(playCode(code, Fault{0, VK_ERROR_OUT_OF_HOST_MEMORY}).complaints, Contains(HasSubstr("never made")));
}

TEST(Machine, SeesWhatIsDestroyedTwice) {
    const Pass pass = playCode([](const DeviceFunctions& vk, VkDevice device, const Stage&) {
        const VkFence fence = makeFence(vk, device);
        vk.DestroyFence(device, fence, nullptr);
        vk.DestroyFence(device, fence, nullptr);
    });
    EXPECT_THAT(pass.complaints, Contains(HasSubstr("not any more")));
}

TEST(Machine, SeesWhatIsDestroyedInUse) {
    const Pass pass = playCode([](const DeviceFunctions& vk, VkDevice device, const Stage& stage) {
        const VkFence fence = makeFence(vk, device);
        submitNothing(vk, stage, fence);
        vk.DestroyFence(device, fence, nullptr);
    });
    EXPECT_THAT(pass.complaints, Contains(HasSubstr("while a submission uses it")));
}

TEST(Machine, SeesFencesThatSayTooMuch) {
    const Pass pass = playCode([](const DeviceFunctions& vk, VkDevice device, const Stage& stage) {
        const VkFence fence = makeFence(vk, device, VK_FENCE_CREATE_SIGNALED_BIT);
        submitNothing(vk, stage, fence);
        vk.WaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX);
        vk.DestroyFence(device, fence, nullptr);
    });
    EXPECT_THAT(pass.complaints, Contains(HasSubstr("signalled already")));
}

TEST(Machine, SeesWaitsThatNeverEnd) {
    const Pass pass = playCode([](const DeviceFunctions& vk, VkDevice device, const Stage&) {
        const VkFence fence = makeFence(vk, device);
        vk.WaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX);
        vk.DestroyFence(device, fence, nullptr);
    });
    EXPECT_THAT(pass.complaints, Contains(HasSubstr("nothing will signal")));
}

TEST(Machine, KeepsWhatIsNotFlushedFromTheDevice) {
    std::vector<std::byte> seen;
    const Pass pass = playCode([&](const DeviceFunctions& vk, VkDevice device, const Stage&) {
        VkMemoryAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        info.allocationSize = 4;
        info.memoryTypeIndex = 1;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        vk.AllocateMemory(device, &info, nullptr, &memory);
        void* mapped = nullptr;
        vk.MapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        auto* first = static_cast<std::byte*>(mapped);
        *first = std::byte{1};
        VkMappedMemoryRange range{};
        range.memory = memory;
        range.size = VK_WHOLE_SIZE;
        vk.InvalidateMappedMemoryRanges(device, 1, &range); // takes back what was not flushed
        seen.push_back(*first);
        *first = std::byte{2};
        vk.FlushMappedMemoryRanges(device, 1, &range);
        vk.InvalidateMappedMemoryRanges(device, 1, &range);
        seen.push_back(*first);
        vk.FreeMemory(device, memory, nullptr);
    });
    EXPECT_THAT(pass.complaints, IsEmpty());
    ASSERT_EQ(seen.size(), 2U);
    EXPECT_NE(seen[0], std::byte{1});
    EXPECT_EQ(seen[1], std::byte{2});
}

/// An answer that the fault changed, an error that says nothing, and a fault that became none.
TEST(Machine, SeesWrongAnswers) {
    const auto failures = [](const std::function<std::string(Play&, VkResult)>& after) {
        const Scenario scenario{"code", [&](Play& play) {
                                    const DeviceFunctions vk = above(play.stage());
                                    VkFence fence = VK_NULL_HANDLE;
                                    VkFenceCreateInfo info{};
                                    const VkResult made =
                                        vk.CreateFence(play.stage().context.device, &info, nullptr, &fence);
                                    if (made == VK_SUCCESS) {
                                        vk.DestroyFence(play.stage().context.device, fence, nullptr);
                                    }
                                    return after(play, made);
                                }};
        return sweep(
                   "code", [&](const std::optional<Fault>& fault) { return playDry(scenario, fault); }, 1)
            .failures;
    };
    EXPECT_THAT(failures([](Play&, VkResult) { return "the same"; }), Contains(HasSubstr("became no error")));
    EXPECT_THAT(failures([](Play&, VkResult made) { return std::to_string(made); }),
                Contains(HasSubstr("the answer is another")));
    EXPECT_THAT(failures([](Play& play, VkResult made) {
                    bool first = true;
                    play.ask("code", [&]() -> Result<void> {
                        if (made == VK_SUCCESS || !std::exchange(first, false)) {
                            return {};
                        }
                        return Error{ErrorCode::OutOfMemory, made, "no"};
                    });
                    return std::string();
                }),
                Contains(AnyOf(HasSubstr("says nothing"), HasSubstr("has code"))));
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#include "lab/paper/frame_target.h"

#include "core/try.h"
#include "device/created.h"
#include "device/timed_commands.h"

namespace voxtact::lab {

namespace {

constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

} // namespace

struct FrameTarget::State {
    State(const Session& owner, TimedCommands made) : session(owner), device(owner.device), commands(std::move(made)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Result<void> makeImage(VkFormat format, VkExtent2D extent);
    Result<void> makeMemory();

    const Session& session;
    const VulkanDevice& device;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    TimedCommands commands;
};

FrameTarget::State::~State() {
    const VolkDeviceTable& vk = device.table();
    // After an error: the image may be drawn to.
    commands.waitForAll();
    vk.vkDestroyImageView(device.handle(), view, nullptr);
    vk.vkDestroyImage(device.handle(), image, nullptr);
    vk.vkFreeMemory(device.handle(), memory, nullptr);
}

Result<void> FrameTarget::State::makeMemory() {
    const VolkDeviceTable& vk = device.table();
    VkMemoryRequirements needs{};
    vk.vkGetImageMemoryRequirements(device.handle(), image, &needs);
    VkPhysicalDeviceMemoryProperties kinds{};
    instanceFunction<PFN_vkGetPhysicalDeviceMemoryProperties>(session, "vkGetPhysicalDeviceMemoryProperties")(
        device.physical().handle, &kinds);
    // A later kind of the device's own memory is never better than an earlier one, and any is better than none.
    std::uint32_t chosen = kinds.memoryTypeCount;
    for (std::uint32_t i = kinds.memoryTypeCount; i-- > 0;) {
        const bool usable = (needs.memoryTypeBits >> i & 1U) != 0;
        const bool local = (kinds.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0;
        if (usable && (local || chosen == kinds.memoryTypeCount)) {
            chosen = i;
        }
    }
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = chosen;
    VkResult result = createdOrNull(vk.vkAllocateMemory(device.handle(), &info, nullptr, &memory), memory);
    if (result == VK_SUCCESS) {
        result = vk.vkBindImageMemory(device.handle(), image, memory, 0);
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "making memory for the frame failed");
}

Result<void> FrameTarget::State::makeImage(VkFormat format, VkExtent2D extent) {
    const VolkDeviceTable& vk = device.table();
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (const VkResult result = createdOrNull(vk.vkCreateImage(device.handle(), &info, nullptr, &image), image);
        result != VK_SUCCESS) {
        return vulkanError(result, "making the image of the frame failed");
    }
    VOXTACT_TRY(makeMemory());
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = format;
    viewInfo.subresourceRange = kWhole;
    const VkResult result = createdOrNull(vk.vkCreateImageView(device.handle(), &viewInfo, nullptr, &view), view);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "making the image of the frame failed");
}

FrameTarget::FrameTarget(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
FrameTarget::FrameTarget(FrameTarget&&) noexcept = default;
FrameTarget& FrameTarget::operator=(FrameTarget&&) noexcept = default;
FrameTarget::~FrameTarget() = default;

Result<FrameTarget> FrameTarget::create(const Session& session, VkFormat format, VkExtent2D extent) {
    Result<TimedCommands> commands = TimedCommands::create(session, kFrameStamps);
    VOXTACT_TRY(commands);
    auto state = std::make_unique<State>(session, std::move(*commands));
    VOXTACT_TRY(state->makeImage(format, extent));
    return FrameTarget(std::move(state));
}

VkImageView FrameTarget::view() const noexcept {
    return state_->view;
}

VkQueryPool FrameTarget::timestamps() const noexcept {
    return state_->commands.timestamps();
}

Result<VkCommandBuffer> FrameTarget::begin() {
    Result<VkCommandBuffer> commands = state_->commands.begin();
    if (!commands.ok()) {
        return commands;
    }
    state_->commands.cmdStamp(kFrameBegins);
    VkImageMemoryBarrier2 ready{};
    ready.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    ready.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    ready.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    ready.dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    ready.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    ready.newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    ready.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    ready.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    ready.image = state_->image;
    ready.subresourceRange = kWhole;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &ready;
    state_->device.table().vkCmdPipelineBarrier2(*commands, &dependency);
    return commands;
}

Result<void> FrameTarget::end() {
    state_->commands.cmdStamp(kFrameEnds);
    return state_->commands.end();
}

Result<void> FrameTarget::submit() {
    return state_->commands.submit();
}

Result<void> FrameTarget::wait() {
    return state_->commands.wait();
}

Result<std::optional<double>> FrameTarget::between(std::uint32_t from, std::uint32_t to) const {
    return state_->commands.between(from, to);
}

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "app/frame_target.h"

#include <limits>
#include <vector>

namespace voxtact::app {

namespace {

/// A function of the instance's: the one that it gives for a name is the one of that name.
template <class Function> Function instanceFunction(const Session& session, const char* name) {
    return reinterpret_cast<Function>(session.instance.getInstanceProcAddr()(session.instance.handle(), name));
}

/// How the counter of a queue is read. It may have fewer than 64 bits, and wraps.
struct QueueClock {
    double milliseconds = 0; ///< of a tick
    std::uint64_t mask = 0;
};

QueueClock clockOf(const Session& session) {
    const VkPhysicalDevice physical = session.device.physical().handle;
    VkPhysicalDeviceProperties properties{};
    instanceFunction<PFN_vkGetPhysicalDeviceProperties>(session, "vkGetPhysicalDeviceProperties")(physical,
                                                                                                  &properties);
    const auto families = instanceFunction<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        session, "vkGetPhysicalDeviceQueueFamilyProperties");
    std::uint32_t count = 0;
    families(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> all(count);
    families(physical, &count, all.data());
    const std::uint32_t bits = all[session.device.queueAccess().family].timestampValidBits;
    return {static_cast<double>(properties.limits.timestampPeriod) * 1e-6,
            bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1};
}

constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

} // namespace

struct FrameTarget::State {
    explicit State(const Session& owner) : session(owner), device(owner.device) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Result<void> makeImage(VkFormat format, VkExtent2D extent);
    Result<void> makeMemory();
    Result<void> makeCommands();
    void cmdStamp(std::uint32_t number) const;

    const Session& session;
    const VulkanDevice& device;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkQueryPool timestamps = VK_NULL_HANDLE;
    QueueClock clock;
};

FrameTarget::State::~State() {
    const VolkDeviceTable& vk = device.table();
    // After an error: nothing that a submission uses may end before it does.
    vk.vkDeviceWaitIdle(device.handle());
    vk.vkDestroyQueryPool(device.handle(), timestamps, nullptr);
    vk.vkDestroyFence(device.handle(), fence, nullptr);
    vk.vkDestroyCommandPool(device.handle(), pool, nullptr);
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
    VkResult result = vk.vkAllocateMemory(device.handle(), &info, nullptr, &memory);
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
    if (const VkResult result = vk.vkCreateImage(device.handle(), &info, nullptr, &image); result != VK_SUCCESS) {
        return vulkanError(result, "making the image of the frame failed");
    }
    if (Result<void> made = makeMemory(); !made.ok()) {
        return made;
    }
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = format;
    viewInfo.subresourceRange = kWhole;
    const VkResult result = vk.vkCreateImageView(device.handle(), &viewInfo, nullptr, &view);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "making the image of the frame failed");
}

Result<void> FrameTarget::State::makeCommands() {
    const VolkDeviceTable& vk = device.table();
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = device.queueAccess().family;
    VkResult result = vk.vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool);
    if (result == VK_SUCCESS) {
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = pool;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        result = vk.vkAllocateCommandBuffers(device.handle(), &info, &commands);
    }
    if (result == VK_SUCCESS) {
        VkFenceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        result = vk.vkCreateFence(device.handle(), &info, nullptr, &fence);
    }
    if (result == VK_SUCCESS && device.hasTimestamps()) {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = kFrameStamps;
        result = vk.vkCreateQueryPool(device.handle(), &info, nullptr, &timestamps);
        clock = clockOf(session);
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "making a command buffer failed");
}

void FrameTarget::State::cmdStamp(std::uint32_t number) const {
    if (timestamps != VK_NULL_HANDLE) {
        device.table().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps, number);
    }
}

FrameTarget::FrameTarget(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
FrameTarget::FrameTarget(FrameTarget&&) noexcept = default;
FrameTarget& FrameTarget::operator=(FrameTarget&&) noexcept = default;
FrameTarget::~FrameTarget() = default;

Result<FrameTarget> FrameTarget::create(const Session& session, VkFormat format, VkExtent2D extent) {
    auto state = std::make_unique<State>(session);
    if (Result<void> made = state->makeImage(format, extent); !made.ok()) {
        return made.error();
    }
    if (Result<void> made = state->makeCommands(); !made.ok()) {
        return made.error();
    }
    return FrameTarget(std::move(state));
}

VkImageView FrameTarget::view() const noexcept {
    return state_->view;
}

VkQueryPool FrameTarget::timestamps() const noexcept {
    return state_->timestamps;
}

Result<VkCommandBuffer> FrameTarget::begin() {
    const VolkDeviceTable& vk = state_->device.table();
    VkResult result = vk.vkResetCommandPool(state_->device.handle(), state_->pool, 0);
    if (result == VK_SUCCESS) {
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        result = vk.vkBeginCommandBuffer(state_->commands, &info);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "recording the frame failed");
    }
    if (state_->timestamps != VK_NULL_HANDLE) {
        vk.vkCmdResetQueryPool(state_->commands, state_->timestamps, 0, kFrameStamps);
    }
    state_->cmdStamp(kFrameBegins);
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
    vk.vkCmdPipelineBarrier2(state_->commands, &dependency);
    return state_->commands;
}

Result<void> FrameTarget::end() {
    state_->cmdStamp(kFrameEnds);
    const VkResult result = state_->device.table().vkEndCommandBuffer(state_->commands);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "recording the frame failed");
}

Result<void> FrameTarget::submit() {
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = state_->commands;
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    const VkResult result =
        state_->device.table().vkQueueSubmit2(state_->device.queueAccess().queue, 1, &info, state_->fence);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "submitting the frame failed");
}

Result<void> FrameTarget::wait() {
    const VolkDeviceTable& vk = state_->device.table();
    VkResult result = vk.vkWaitForFences(state_->device.handle(), 1, &state_->fence, VK_TRUE,
                                         std::numeric_limits<std::uint64_t>::max());
    if (result == VK_SUCCESS) {
        result = vk.vkResetFences(state_->device.handle(), 1, &state_->fence);
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "waiting for the frame failed");
}

Result<std::optional<double>> FrameTarget::between(std::uint32_t from, std::uint32_t to) const {
    if (state_->timestamps == VK_NULL_HANDLE) {
        return std::optional<double>();
    }
    std::array<std::uint64_t, 2> ticks{};
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const VkResult result = state_->device.table().vkGetQueryPoolResults(
            state_->device.handle(), state_->timestamps, i == 0 ? from : to, 1, sizeof ticks[i], &ticks[i],
            sizeof ticks[i], VK_QUERY_RESULT_64_BIT);
        if (result != VK_SUCCESS) {
            return vulkanError(result, "reading timestamps failed");
        }
    }
    return std::optional(static_cast<double>((ticks[1] - ticks[0]) & state_->clock.mask) * state_->clock.milliseconds);
}

} // namespace voxtact::app

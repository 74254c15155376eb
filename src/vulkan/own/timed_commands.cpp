// SPDX-License-Identifier: MIT
#include "vulkan/own/timed_commands.h"

#include "core/base/try.h"
#include "vulkan/own/created.h"
#include "vulkan/timestamps.h"

#include <array>
#include <limits>
#include <vector>

namespace voxtact::device {

namespace {

/// How the counter of a queue is read. It may have fewer than 64 bits, and wraps.
struct QueueClock {
    double milliseconds = 0; ///< of a tick
    std::uint32_t bits = 0;
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
    return {static_cast<double>(properties.limits.timestampPeriod) * 1e-6,
            all[session.device.queueAccess().family].timestampValidBits};
}

} // namespace

struct TimedCommands::State {
    State(const Session& session, std::uint32_t number) : device(session.device), stamps(number) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Result<void> make(const Session& session);
    /// Waits for everything on the device; false where even that fails.
    bool waitForAll() noexcept;
    /// What a wait for the fence found.
    Result<void> waited(VkResult result);

    const VulkanDevice& device;
    std::uint32_t stamps = 0;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkQueryPool timestamps = VK_NULL_HANDLE;
    QueueClock clock;
    bool inFlight = false; ///< submitted, or perhaps so, and not known to be done
};

bool TimedCommands::State::waitForAll() noexcept {
    const VkResult result = [this] {
        const auto lock = device.lockQueue();
        return device.table().vkDeviceWaitIdle(device.handle());
    }();
    if (result == VK_SUCCESS || result == VK_ERROR_DEVICE_LOST) {
        inFlight = false;
    }
    return !inFlight;
}

TimedCommands::State::~State() {
    const VolkDeviceTable& vk = device.table();
    // After an error: nothing that a submission uses may end before it does. What cannot be waited for keeps it.
    if (inFlight && !waitForAll()) {
        return;
    }
    vk.vkDestroyQueryPool(device.handle(), timestamps, nullptr);
    vk.vkDestroyFence(device.handle(), fence, nullptr);
    vk.vkDestroyCommandPool(device.handle(), pool, nullptr);
}

Result<void> TimedCommands::State::make(const Session& session) {
    const VolkDeviceTable& vk = device.table();
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = device.queueAccess().family;
    VkResult result = createdOrNull(vk.vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool), pool);
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
        result = createdOrNull(vk.vkCreateFence(device.handle(), &info, nullptr, &fence), fence);
    }
    if (result == VK_SUCCESS && device.hasTimestamps() && stamps > 0) {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = stamps;
        result = createdOrNull(vk.vkCreateQueryPool(device.handle(), &info, nullptr, &timestamps), timestamps);
        clock = clockOf(session);
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "making a command buffer failed");
}

TimedCommands::TimedCommands(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
TimedCommands::TimedCommands(TimedCommands&&) noexcept = default;
TimedCommands& TimedCommands::operator=(TimedCommands&&) noexcept = default;
TimedCommands::~TimedCommands() = default;

Result<TimedCommands> TimedCommands::create(const Session& session, std::uint32_t stamps) {
    auto state = std::make_unique<State>(session, stamps);
    VOXTACT_TRY(state->make(session));
    return TimedCommands(std::move(state));
}

VkQueryPool TimedCommands::timestamps() const noexcept {
    return state_->timestamps;
}

Result<VkCommandBuffer> TimedCommands::begin(Use use) {
    const VolkDeviceTable& vk = state_->device.table();
    if (state_->inFlight && !state_->waitForAll()) {
        return Error{ErrorCode::Vulkan, 0, "recording failed: an earlier submission cannot be waited for"};
    }
    VkResult result = vk.vkResetCommandPool(state_->device.handle(), state_->pool, 0);
    if (result == VK_SUCCESS) {
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        if (use == Use::Once) {
            info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        }
        result = vk.vkBeginCommandBuffer(state_->commands, &info);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "recording failed");
    }
    if (state_->timestamps != VK_NULL_HANDLE) {
        vk.vkCmdResetQueryPool(state_->commands, state_->timestamps, 0, state_->stamps);
    }
    return state_->commands;
}

void TimedCommands::cmdStamp(std::uint32_t number) const {
    if (state_->timestamps != VK_NULL_HANDLE) {
        state_->device.table().vkCmdWriteTimestamp2(state_->commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                                    state_->timestamps, number);
    }
}

Result<void> TimedCommands::end() {
    const VkResult result = state_->device.table().vkEndCommandBuffer(state_->commands);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "recording failed");
}

Result<void> TimedCommands::submit() {
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = state_->commands;
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    const VolkDeviceTable& vk = state_->device.table();
    // Before the submission, so that a failure leaves no fence that says too early that the next one is done.
    VkResult result = vk.vkResetFences(state_->device.handle(), 1, &state_->fence);
    if (result == VK_SUCCESS) {
        state_->inFlight = true;
        const auto lock = state_->device.lockQueue();
        result = vk.vkQueueSubmit2(state_->device.queueAccess().queue, 1, &info, state_->fence);
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "submitting failed");
}

Result<void> TimedCommands::State::waited(VkResult result) {
    if (result == VK_SUCCESS) {
        inFlight = false;
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "waiting for the device failed");
}

Result<void> TimedCommands::wait() {
    return state_->waited(state_->device.table().vkWaitForFences(state_->device.handle(), 1, &state_->fence, VK_TRUE,
                                                                 std::numeric_limits<std::uint64_t>::max()));
}

Result<void> TimedCommands::poll() {
    const VolkDeviceTable& vk = state_->device.table();
    VkResult result = VK_NOT_READY;
    while (result == VK_NOT_READY) {
        result = vk.vkGetFenceStatus(state_->device.handle(), state_->fence);
    }
    return state_->waited(result);
}

void TimedCommands::waitForAll() const {
    static_cast<void>(state_->waitForAll());
}

Result<std::optional<double>> TimedCommands::between(std::uint32_t from, std::uint32_t to) const {
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
    const std::optional<std::uint64_t> passed = ticksBetween(ticks[0], ticks[1], state_->clock.bits);
    if (!passed) {
        state_->device.missTimestamp();
        return std::optional<double>();
    }
    return std::optional(static_cast<double>(*passed) * state_->clock.milliseconds);
}

} // namespace voxtact::device

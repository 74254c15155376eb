// SPDX-License-Identifier: MIT
#include "app/timed_submission.h"

#include <array>
#include <chrono>
#include <limits>
#include <vector>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

/// How the queue counts time.
struct Ticks {
    double milliseconds = 0; ///< a tick
    std::uint64_t mask = 0;  ///< the counter has fewer than 64 bits on some queues and wraps; 0: there is none
};

template <class Function> Function instanceFunction(const Session& session, const char* name) {
    // The function that an instance gives for a name is the one of that name.
    return reinterpret_cast<Function>(session.instance.getInstanceProcAddr()(session.instance.handle(), name));
}

Ticks ticksOf(const Session& session) {
    const VkPhysicalDevice physical = session.device.physical().handle;
    VkPhysicalDeviceProperties properties{};
    instanceFunction<PFN_vkGetPhysicalDeviceProperties>(session, "vkGetPhysicalDeviceProperties")(physical,
                                                                                                  &properties);
    const auto getFamilies = instanceFunction<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        session, "vkGetPhysicalDeviceQueueFamilyProperties");
    std::uint32_t count = 0;
    getFamilies(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    getFamilies(physical, &count, families.data());
    const std::uint32_t bits = families.at(session.device.queueAccess().family).timestampValidBits;
    return {static_cast<double>(properties.limits.timestampPeriod) * 1e-6,
            bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1};
}

} // namespace

struct TimedSubmission::State {
    explicit State(const Session& owner) : device(owner.device), ticks(ticksOf(owner)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Result<void> make();
    Result<void> submit(const std::function<Result<void>(VkCommandBuffer)>& record);
    void stamp(std::uint32_t query) const;
    [[nodiscard]] Result<std::optional<double>> elapsed() const;

    const VulkanDevice& device;
    Ticks ticks;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE; ///< null where there are no timestamps
};

TimedSubmission::State::~State() {
    const VolkDeviceTable& vk = device.table();
    vk.vkDestroyQueryPool(device.handle(), queries, nullptr);
    vk.vkDestroyFence(device.handle(), fence, nullptr);
    vk.vkDestroyCommandPool(device.handle(), pool, nullptr);
}

Result<void> TimedSubmission::State::make() {
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
    if (result == VK_SUCCESS && ticks.mask != 0) {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = 2;
        result = vk.vkCreateQueryPool(device.handle(), &info, nullptr, &queries);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a command buffer with timestamps failed");
    }
    return {};
}

void TimedSubmission::State::stamp(std::uint32_t query) const {
    if (queries != VK_NULL_HANDLE) {
        device.table().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries, query);
    }
}

Result<void> TimedSubmission::State::submit(const std::function<Result<void>(VkCommandBuffer)>& record) {
    const VolkDeviceTable& vk = device.table();
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkResult result = vk.vkResetCommandPool(device.handle(), pool, 0);
    if (result == VK_SUCCESS) {
        result = vk.vkBeginCommandBuffer(commands, &begin);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "recording failed");
    }
    if (queries != VK_NULL_HANDLE) {
        vk.vkCmdResetQueryPool(commands, queries, 0, 2);
    }
    stamp(0);
    if (Result<void> recorded = record(commands); !recorded.ok()) {
        return recorded;
    }
    stamp(1);
    result = vk.vkEndCommandBuffer(commands);
    if (result == VK_SUCCESS) {
        VkCommandBufferSubmitInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
        info.commandBuffer = commands;
        VkSubmitInfo2 submission{};
        submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
        submission.commandBufferInfoCount = 1;
        submission.pCommandBufferInfos = &info;
        result = vk.vkQueueSubmit2(device.queueAccess().queue, 1, &submission, fence);
    }
    if (result == VK_SUCCESS) {
        result = vk.vkWaitForFences(device.handle(), 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    }
    if (result == VK_SUCCESS) {
        result = vk.vkResetFences(device.handle(), 1, &fence);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "submitting and waiting failed");
    }
    return {};
}

Result<std::optional<double>> TimedSubmission::State::elapsed() const {
    if (queries == VK_NULL_HANDLE) {
        return std::optional<double>();
    }
    std::array<std::uint64_t, 2> read{};
    const VkResult result = device.table().vkGetQueryPoolResults(device.handle(), queries, 0, 2, sizeof read,
                                                                 read.data(), sizeof read[0], VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "reading timestamps failed");
    }
    return std::optional(static_cast<double>((read[1] - read[0]) & ticks.mask) * ticks.milliseconds);
}

TimedSubmission::TimedSubmission(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
TimedSubmission::TimedSubmission(TimedSubmission&&) noexcept = default;
TimedSubmission& TimedSubmission::operator=(TimedSubmission&&) noexcept = default;
TimedSubmission::~TimedSubmission() = default;

Result<TimedSubmission> TimedSubmission::create(const Session& session) {
    auto state = std::make_unique<State>(session);
    if (const Result<void> made = state->make(); !made.ok()) {
        return made.error();
    }
    return TimedSubmission(std::move(state));
}

Result<TimedSubmission::Times> TimedSubmission::run(const std::function<Result<void>(VkCommandBuffer)>& record) {
    const auto begun = Clock::now();
    if (const Result<void> done = state_->submit(record); !done.ok()) {
        state_->device.table().vkDeviceWaitIdle(state_->device.handle());
        return done.error();
    }
    Times times;
    times.wallMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
    const Result<std::optional<double>> gpu = state_->elapsed();
    if (!gpu.ok()) {
        return gpu.error();
    }
    times.gpuMilliseconds = *gpu;
    return times;
}

} // namespace voxtact::app

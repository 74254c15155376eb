// SPDX-License-Identifier: MIT
#include "device/engine/pair_pipeline.h"

#include "core/base/try.h"
#include "core/batch/batch_cutter.h"
#include "device/detector/many_poses.h"
#include "vulkan/own/created.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace voxtact::device {

namespace {

using Clock = std::chrono::steady_clock;

/// One submission in flight.
struct Flight {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    Results* results = nullptr;
    std::vector<Piece> pieces;
    std::uint64_t frame = 0;
    Clock::time_point begun;
    bool pending = false;
};

} // namespace

struct PairPipeline::State {
    State(const VulkanDevice& owner, const Detector& what, const PipelineDesc& how, ResultRing ring)
        : device(owner), detector(what), desc(how), results(std::move(ring)), flights(how.frames) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Result<void> makeFlight(Flight& flight) const;
    Result<void> launch(Flight& flight, const Batch& part);
    Result<void> land(Flight& flight, const Events& events);
    Result<void> run(const Batch& batch, const Events& events);
    bool drain() noexcept;

    const VulkanDevice& device;
    const Detector& detector;
    std::optional<Detector> forMany; ///< forManyPoses(), where it can be made; it then takes the place of the other
    PipelineDesc desc;
    ResultRing results;
    std::vector<Flight> flights;
    std::uint64_t frame = 0;
};

PairPipeline::State::~State() {
    const VolkDeviceTable& vk = device.table();
    if (!drain()) {
        return;
    }
    for (const Flight& flight : flights) {
        vk.vkDestroyFence(device.handle(), flight.fence, nullptr);
        vk.vkDestroyCommandPool(device.handle(), flight.pool, nullptr);
    }
}

Result<void> PairPipeline::State::makeFlight(Flight& flight) const {
    const VolkDeviceTable& vk = device.table();
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = device.queueAccess().family;
    VkResult result = createdOrNull(vk.vkCreateCommandPool(device.handle(), &pool, nullptr, &flight.pool), flight.pool);
    if (result == VK_SUCCESS) {
        VkCommandBufferAllocateInfo commands{};
        commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        commands.commandPool = flight.pool;
        commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        commands.commandBufferCount = 1;
        result = vk.vkAllocateCommandBuffers(device.handle(), &commands, &flight.commands);
    }
    if (result == VK_SUCCESS) {
        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        result = createdOrNull(vk.vkCreateFence(device.handle(), &fence, nullptr, &flight.fence), flight.fence);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a command buffer failed");
    }
    return {};
}

Result<void> PairPipeline::State::launch(Flight& flight, const Batch& part) {
    const VolkDeviceTable& vk = device.table();
    flight.begun = Clock::now();
    flight.frame = frame++;
    const Result<Results*> slot = results.begin(flight.frame);
    VOXTACT_TRY(slot);
    flight.results = *slot;

    VkResult result = vk.vkResetCommandPool(device.handle(), flight.pool, 0);
    if (result == VK_SUCCESS) {
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        result = vk.vkBeginCommandBuffer(flight.commands, &begin);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "recording the pairs failed");
    }
    VOXTACT_TRY((forMany ? *forMany : detector).cmdDetect(flight.commands, part, *flight.results));
    VOXTACT_TRY(flight.results->cmdReadBack(flight.commands));
    result = vk.vkEndCommandBuffer(flight.commands);
    if (result == VK_SUCCESS) {
        // Before the submission, so that a failure leaves no fence that says too early that the next one is done.
        result = vk.vkResetFences(device.handle(), 1, &flight.fence);
    }
    if (result == VK_SUCCESS) {
        VkCommandBufferSubmitInfo commands{};
        commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
        commands.commandBuffer = flight.commands;
        VkSubmitInfo2 submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
        submit.commandBufferInfoCount = 1;
        submit.pCommandBufferInfos = &commands;
        flight.pending = true;
        const auto lock = device.lockQueue();
        result = vk.vkQueueSubmit2(device.queueAccess().queue, 1, &submit, flight.fence);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "submitting the pairs failed");
    }
    return {};
}

Result<void> PairPipeline::State::land(Flight& flight, const Events& events) {
    const VolkDeviceTable& vk = device.table();
    const VkResult result =
        vk.vkWaitForFences(device.handle(), 1, &flight.fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    if (result != VK_SUCCESS) {
        return vulkanError(result, "waiting for the pairs failed");
    }
    flight.pending = false;
    const Result<std::span<const PairResult>> read = results.read(flight.frame);
    VOXTACT_TRY(read);
    const std::chrono::duration<double, std::milli> wall = Clock::now() - flight.begun;
    const auto pairs = static_cast<double>(read->size());
    TimedAnswer timed;
    timed.wallMilliseconds = wall.count() / pairs;
    if (desc.timestamps) {
        const Result<double> gpu = flight.results->gpuMilliseconds();
        VOXTACT_TRY(gpu);
        if (*gpu > 0) {
            timed.gpuMilliseconds = *gpu / pairs;
        } else {
            device.missTimestamp();
        }
    }
    for (const PairResult& pair : *read) {
        timed.answer = unpack(pair);
        timed.item = flight.pieces[timed.answer.item].item;
        timed.pose = flight.pieces[timed.answer.item].firstPose + timed.answer.pose;
        events.pair(timed);
    }
    BatchAnswer answer;
    VOXTACT_TRY(results.readOutputs(flight.frame, answer));
    if (flight.results->counted()) {
        const Result<CertifiedCounters> counters = flight.results->counters();
        VOXTACT_TRY(counters);
        answer.counters = *counters;
    }
    if (events.submission) {
        events.submission(answer);
    }
    if (events.pace != nullptr) {
        // What is in flight beside it had its share of the device.
        events.pace->took(static_cast<std::uint32_t>(read->size()), wall.count() / static_cast<double>(flights.size()));
    }
    return {};
}

Result<void> PairPipeline::State::run(const Batch& batch, const Events& events) {
    BatchCutter<BatchItem> cutter(batch.items);
    std::vector<BatchItem> items;
    std::vector<Piece> pieces;
    std::size_t next = 0; // the oldest flight, and the one to take next: they go round
    bool more = true;
    for (std::size_t landed = 0; more || landed < flights.size(); next = (next + 1) % flights.size()) {
        Flight& flight = flights[next];
        if (flight.pending) {
            VOXTACT_TRY(land(flight, events));
        }
        more = more && !(events.stop && events.stop()) &&
               cutter.next(events.pace != nullptr ? events.pace->size() : desc.pairsPerSubmission, items, pieces);
        if (!more) {
            ++landed;
            continue;
        }
        flight.pieces = pieces;
        VOXTACT_TRY(launch(flight, {items, batch.view, batch.threshold}));
    }
    return {};
}

/// After an error: nothing that a submission uses may end before it does. False where waiting for it fails too.
bool PairPipeline::State::drain() noexcept {
    if (std::ranges::none_of(flights, &Flight::pending)) {
        return true;
    }
    const VkResult result = [this] {
        const auto lock = device.lockQueue();
        return device.table().vkDeviceWaitIdle(device.handle());
    }();
    if (result != VK_SUCCESS && result != VK_ERROR_DEVICE_LOST) {
        return false;
    }
    for (Flight& flight : flights) {
        flight.pending = false;
    }
    return true;
}

PairPipeline::PairPipeline(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
PairPipeline::PairPipeline(PairPipeline&&) noexcept = default;
PairPipeline& PairPipeline::operator=(PairPipeline&&) noexcept = default;
PairPipeline::~PairPipeline() = default;

Result<PairPipeline> PairPipeline::create(const VulkanDevice& device, const Context& context, const Detector& detector,
                                          const PipelineDesc& desc) {
    PipelineDesc how = desc;
    how.timestamps = desc.timestamps && device.hasTimestamps();
    const ResultsDesc results{.maxPairs = how.pairsPerSubmission,
                              .readBack = true,
                              .timestamps = how.timestamps,
                              .queueFamily = device.queueAccess().family,
                              .room = how.room,
                              .staged = true};
    Result<ResultRing> ring = stagedWhereThereIsRoom(
        results, [&](const ResultsDesc& of) { return ResultRing::create(detector, how.frames, of); });
    VOXTACT_TRY(ring);
    auto state = std::make_unique<State>(device, detector, how, std::move(*ring));
    if (const std::optional<DetectorDesc> many = forManyPoses(detector.impl(), how.pairsPerSubmission)) {
        Result<Detector> made = Detector::create(context, *many);
        if (made.ok()) {
            state->forMany = std::move(*made);
        } else if (!doesWithout(made.error())) {
            return made.error();
        }
    }
    for (Flight& flight : state->flights) {
        VOXTACT_TRY(state->makeFlight(flight));
    }
    return PairPipeline(std::move(state));
}

Result<void> PairPipeline::run(const Batch& batch, const Events& events) {
    // Answers of an earlier batch, which failed, are nobody's.
    if (!state_->drain()) {
        return Error{ErrorCode::Vulkan, 0, "recording the pairs failed: earlier ones cannot be waited for"};
    }
    Result<void> done = state_->run(batch, events);
    if (!done.ok()) {
        static_cast<void>(state_->drain());
    }
    return done;
}

} // namespace voxtact::device

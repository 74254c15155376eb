// SPDX-License-Identifier: MIT
#include "viewer/frame/frame.h"

#include "core/base/try.h"
#include "core/method/method_table.h"
#include "vulkan/own/created.h"

#include <imgui.h>

#include <algorithm>
#include <limits>

namespace voxtact::view {

namespace {

using device::createdOrNull;
using device::vulkanError;

std::array<Extent, 3> extentsOf(const State& state) {
    return {state.slices[0].extent, state.slices[1].extent, state.slices[2].extent};
}

} // namespace

Result<std::unique_ptr<Frames>> Frames::create(const device::Session& session, VkSurfaceKHR surface) {
    std::unique_ptr<Frames> frames(new Frames(session));
    Result<Swapchain> swapchain = Swapchain::create(session.device, surface);
    VOXTACT_TRY(swapchain);
    frames->swapchain_.emplace(std::move(*swapchain));
    Result<Gui> gui = Gui::create(session, frames->swapchain_->format());
    VOXTACT_TRY(gui);
    frames->gui_ = std::move(*gui);
    VOXTACT_TRY(frames->makeSlots());
    VOXTACT_TRY(frames->makeTextures());
    return frames;
}

Result<void> Frames::makeSlots() {
    const VolkDeviceTable& table = session_->device.table();
    VkDevice device = session_->device.handle();
    for (Slot& slot : slots_) {
        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.queueFamilyIndex = session_->device.queueAccess().family;
        VkResult result = createdOrNull(table.vkCreateCommandPool(device, &pool, nullptr, &slot.pool), slot.pool);
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = slot.pool;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        result = result == VK_SUCCESS ? table.vkAllocateCommandBuffers(device, &allocate, &slot.commands) : result;
        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        if (result == VK_SUCCESS) {
            result = createdOrNull(table.vkCreateFence(device, &fence, nullptr, &slot.done), slot.done);
        }
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        if (result == VK_SUCCESS) {
            result = createdOrNull(table.vkCreateSemaphore(device, &semaphore, nullptr, &slot.acquired), slot.acquired);
        }
        if (result != VK_SUCCESS) {
            return vulkanError(result, "making the frames of the window");
        }
    }
    return {};
}

Result<void> Frames::makeTextures() {
    std::array<VkDescriptorSet, 5> sets{};
    for (VkDescriptorSet& set : sets) {
        const Result<VkDescriptorSet> texture = gui_->addTexture();
        VOXTACT_TRY(texture);
        set = *texture;
    }
    std::copy_n(sets.begin(), sliceSets_.size(), sliceSets_.begin());
    coarse_ = sets[3];
    fine_ = sets[4];
    return {};
}

void Frames::setTextures(State& state) {
    gui_->setTexture(coarse_, stage_->pictures->coarse(), VK_IMAGE_LAYOUT_GENERAL);
    gui_->setTexture(fine_, stage_->pictures->fine(), VK_IMAGE_LAYOUT_GENERAL);
    for (std::size_t slice = 0; slice < sliceSets_.size(); ++slice) {
        gui_->setTexture(sliceSets_[slice], stage_->slices->view(slice), VK_IMAGE_LAYOUT_GENERAL);
        state.slices[slice].texture = sliceSets_[slice];
    }
}

Frames::~Frames() {
    const VolkDeviceTable& table = session_->device.table();
    VkDevice device = session_->device.handle();
    // Returns also if the device is lost.
    static_cast<void>(waitForDevice());
    for (const Slot& slot : slots_) {
        table.vkDestroySemaphore(device, slot.acquired, nullptr);
        table.vkDestroyFence(device, slot.done, nullptr);
        table.vkDestroyCommandPool(device, slot.pool, nullptr);
    }
}

Result<void> Frames::waitForDevice() {
    const auto lock = session_->device.lockQueue();
    const VkResult result = session_->device.table().vkDeviceWaitIdle(session_->device.handle());
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "waiting for the frames of the window");
}

/// Does not wait for the work of other threads.
Result<void> Frames::waitForFrames() {
    for (const Slot& slot : slots_) {
        const VkResult result =
            slot.used ? session_->device.table().vkWaitForFences(session_->device.handle(), 1, &slot.done, VK_TRUE,
                                                                 std::numeric_limits<std::uint64_t>::max())
                      : VK_SUCCESS;
        if (result != VK_SUCCESS) {
            return vulkanError(result, "waiting for the frames of the window");
        }
    }
    return {};
}

Result<std::unique_ptr<Stage>> Frames::put(std::unique_ptr<Stage> stage, State& state) {
    VOXTACT_TRY(waitForFrames());
    std::unique_ptr<Stage> before = std::exchange(stage_, std::move(stage));
    setTextures(state);
    state.picture.texture = coarse_;
    state.methods = DeviceAnswers::choices(session_->context);
    answering_ = state.method;
    asked_ = 0;
    askedHost_ = 0;
    return before;
}

Result<void> Frames::renewSurface(const std::function<Result<VkSurfaceKHR>()>& make) {
    VOXTACT_TRY(waitForDevice());
    swapchain_.reset(); // together with the surface: a window has one at a time
    const Result<VkSurfaceKHR> surface = make();
    VOXTACT_TRY(surface);
    Result<Swapchain> swapchain = Swapchain::create(session_->device, *surface);
    VOXTACT_TRY(swapchain);
    swapchain_.emplace(std::move(*swapchain));
    return {};
}

bool Frames::ready() const {
    const Slot& next = slots_[slot_];
    return !next.used ||
           session_->device.table().vkGetFenceStatus(session_->device.handle(), next.done) != VK_NOT_READY;
}

Result<void> Frames::collect(State& state) {
    Slot& next = slot();
    const bool frame = next.used;
    double wall = 0;
    if (frame) {
        const VkResult result = session_->device.table().vkGetFenceStatus(session_->device.handle(), next.done);
        if (result != VK_SUCCESS) {
            return vulkanError(result, "a frame of the window failed");
        }
        next.used = false;
        wall = std::chrono::duration<double, std::milli>(State::Clock::now() - next.submitted).count();
    }
    return stage_ ? collectAnswers(state, wall, frame) : Result<void>();
}

/// Collects the answers of the slot's frame, if any, and of the host.
Result<void> Frames::collectAnswers(State& state, double wallMilliseconds, bool frame) {
    if (frame) {
        stage_->pictures->collect(slot_, wallMilliseconds);
        if (std::optional<Result<LiveAnswer>> answer = stage_->device->collect(slot_, wallMilliseconds)) {
            take(state, std::move(*answer));
        }
    }
    if (std::optional<Result<LiveAnswer>> answer = stage_->host->take()) {
        take(state, std::move(*answer));
    }
    if (std::optional<Result<LiveMeasures>> distances = stage_->host->takeDistances()) {
        if (distances->ok()) {
            state.distances = **distances;
        } else if (distances->error().code != ErrorCode::Cancelled) {
            state.complain(distances->error().text);
        }
    }
    VOXTACT_TRY(collectBeside(state));
    compareNext(state);
    return {};
}

/// Collects answers beside the frames. Reports a method that cannot answer, and restores the previous one.
Result<void> Frames::collectBeside(State& state) {
    if (std::optional<Result<LiveAnswer>> compared = stage_->host->takeCompared()) {
        state.comparison.take(std::move(*compared));
    }
    std::optional<Result<LiveAnswer>> answer = stage_->beside->take();
    if (!answer) {
        return {};
    }
    if (!answer->ok() && answer->error().code == ErrorCode::DeviceLost) {
        return answer->error();
    }
    if (besideCompares_) {
        state.comparison.take(std::move(*answer));
        return {};
    }
    if (!answer->ok()) {
        if (besideMethod_ == answering_) {
            return answer->error();
        }
        state.method = state.method == besideMethod_ ? answering_ : state.method;
    } else if ((*answer)->revision == state.revision) {
        asked_ = state.revision;
    }
    take(state, std::move(*answer));
    return {};
}

/// Asks the next method of the comparison, if no other question is pending.
void Frames::compareNext(State& state) {
    if (!state.comparing || !state.settled() || !state.comparison.isOf(state.document.edit) || stage_->beside->busy()) {
        return;
    }
    std::optional<LiveQuestion> question = state.comparison.next();
    if (!question) {
        return;
    }
    if (rowOf(question->method.count).host) {
        stage_->host->compare(std::move(*question));
    } else {
        besideCompares_ = true;
        stage_->beside->ask(std::move(*question));
    }
}

/// An answer of another method in the meantime is obsolete.
void Frames::take(State& state, Result<LiveAnswer> answer) {
    if (!answer.ok()) {
        if (answer.error().code != ErrorCode::Cancelled) {
            state.complain(answer.error().text);
        }
        return;
    }
    if (state.answer && state.answer->revision >= answer->revision) {
        return;
    }
    const PairAnswer& any = answer->meshes.front().pair; // all are answered in one way
    const bool host = rowOf(any.method).host;
    const std::string by = host ? "host" : session_->device.physical().name;
    const MethodChoice method{any.method, any.projection};
    if (!(method == answering_)) {
        state.times = {}; // of one method at a time
    }
    answering_ = method;
    state.times.add(answer->milliseconds);
    state.answeredBy = by;
    state.answer = std::move(*answer);
    if (const MeshAnswer* chosen = state.chosenAnswer()) {
        state.strip.add(state.seconds(), hitNumber(chosen->pair), state.answer->milliseconds);
    }
}

Result<void> Frames::fitSizes(State& state, VkExtent2D window) {
    const VkExtent2D extent = swapchain_->extent();
    if (swapchain_->stale() || extent.width != window.width || extent.height != window.height) {
        VOXTACT_TRY(waitForDevice()); // that shows the images, too
        VOXTACT_TRY(swapchain_->resize(window));
    }
    return stage_ ? fitStage(state) : Result<void>();
}

Result<void> Frames::fitStage(State& state) {
    const bool pictureFits = stage_->pictures->fits(state.picture.extent);
    const bool slicesFit = stage_->slices->fits(extentsOf(state));
    if (pictureFits && slicesFit) {
        return {};
    }
    VOXTACT_TRY(waitForFrames());
    if (!pictureFits) {
        VOXTACT_TRY(stage_->pictures->resize(stage_->scene->renderer(), state.picture.extent));
        state.fineShare = 0;
    }
    if (!slicesFit) {
        VOXTACT_TRY(stage_->slices->resize(extentsOf(state)));
    }
    setTextures(state);
    return {};
}

/// Asks a new question: of the host, in this frame, or, for a new method, on the separate thread.
Result<void> Frames::ask(State& state) {
    const LiveQuestion question{state.revision, state.document.edit, state.method};
    if (askedHost_ != state.revision) {
        askedHost_ = state.revision;
        stage_->host->ask(question, state.writes);
    }
    if (asked_ == state.revision) {
        return {};
    }
    const bool host = rowOf(state.method.count).host;
    if (!host && !stage_->device->ready(state.method)) {
        if (!stage_->beside->busy()) {
            besideCompares_ = false;
            besideMethod_ = question.method;
            stage_->beside->ask(question);
        }
        return {};
    }
    asked_ = state.revision;
    return host ? Result<void>() : stage_->device->record(slot().commands, *stage_->scene, question, slot_);
}

Result<void> Frames::begin() {
    const VolkDeviceTable& table = session_->device.table();
    VkResult result = table.vkResetCommandPool(session_->device.handle(), slot().pool, 0);
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    result = result == VK_SUCCESS ? table.vkBeginCommandBuffer(slot().commands, &info) : result;
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "recording a frame of the window");
}

/// Records the transfer function and the question. Reports a method that cannot answer, and restores the previous one.
Result<void> Frames::recordAnswer(State& state) {
    const std::lock_guard lock(stage_->scene->recording());
    VOXTACT_TRY(stage_->scene->cmdUpdate(slot().commands, state));
    if (const Result<void> asked = ask(state); !asked.ok()) {
        if (asked.error().code == ErrorCode::DeviceLost || state.method == answering_) {
            return asked.error();
        }
        state.complain(asked.error().text);
        state.method = answering_;
        // The recorded commands are not submitted.
        stage_->scene->forgetUpdate();
        VOXTACT_TRY(begin());
        VOXTACT_TRY(stage_->scene->cmdUpdate(slot().commands, state));
    }
    state.writes.forget(std::min(stage_->host->written(), stage_->scene->written()));
    return {};
}

Result<void> Frames::recordStage(State& state) {
    VOXTACT_TRY(recordAnswer(state));
    stage_->scene->paint(state, slot_);
    VOXTACT_TRY(stage_->pictures->record(slot().commands, *stage_->scene, state, slot_));
    stage_->slices->record(slot().commands, state);
    return {};
}

Result<void> Frames::record(State& state, const ImDrawData& panels, std::uint32_t image) {
    const VolkDeviceTable& table = session_->device.table();
    VkCommandBuffer commands = slot().commands;
    VOXTACT_TRY(begin());
    if (stage_) {
        VOXTACT_TRY(recordStage(state));
    }
    memoryBarrier(session_->device, commands,
                  {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
                  {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
    const BarrierSide draw{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
    layoutBarrier(session_->device, commands,
                  {swapchain_->image(image), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                  {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_NONE}, draw);
    beginRendering(session_->device, commands, swapchain_->view(image), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   swapchain_->extent());
    ShownTexture picture{coarse_, coarse_, {}};
    if (stage_ && state.fineShare >= 1) {
        picture.drawn = fine_;
    } else if (stage_) {
        picture.part = stage_->pictures->coarsePart();
    }
    const Result<void> drawn = gui_->record(commands, panels, slot_, picture);
    table.vkCmdEndRendering(commands);
    VOXTACT_TRY(drawn);
    layoutBarrier(session_->device, commands,
                  {swapchain_->image(image), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR},
                  draw, {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE});
    const VkResult result = table.vkEndCommandBuffer(commands);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "recording a frame of the window");
}

Result<void> Frames::submit(std::uint32_t image) {
    VkSemaphoreSubmitInfo wait{};
    wait.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
    wait.semaphore = slot().acquired;
    wait.stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    VkSemaphoreSubmitInfo signal = wait;
    signal.semaphore = swapchain_->drawn(image);
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkCommandBufferSubmitInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    buffer.commandBuffer = slot().commands;
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.waitSemaphoreInfoCount = 1;
    info.pWaitSemaphoreInfos = &wait;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    info.signalSemaphoreInfoCount = 1;
    info.pSignalSemaphoreInfos = &signal;
    const VolkDeviceTable& table = session_->device.table();
    VkResult result = table.vkResetFences(session_->device.handle(), 1, &slot().done);
    if (result == VK_SUCCESS) {
        const auto lock = session_->device.lockQueue();
        result = table.vkQueueSubmit2(session_->device.queueAccess().queue, 1, &info, slot().done);
    }
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "submitting a frame of the window");
}

Result<void> Frames::show(State& state, const ImDrawData& panels, VkExtent2D window) {
    VOXTACT_TRY(fitSizes(state, window));
    std::uint32_t image = 0;
    if (swapchain_->stale()) {
        return {}; // the window is not shown, or changes its size right now
    }
    const Result<bool> acquired = swapchain_->acquire(slot().acquired, image);
    VOXTACT_TRY(acquired);
    if (!*acquired) {
        return {};
    }
    VOXTACT_TRY(record(state, panels, image));
    VOXTACT_TRY(submit(image));
    slot().used = true;
    slot().submitted = State::Clock::now();
    slot_ = (slot_ + 1) % kFramesInFlight;
    if (stage_) {
        state.picture.texture = coarse_;
    }
    const auto lock = session_->device.lockQueue();
    return swapchain_->present(session_->device.queueAccess().queue, image);
}

std::pair<ShownScene, BlockingRenderer*> Frames::screenshot(const State& state, const Extent& extent) {
    return {stage_->scene->scene(state, slot_, true, extent), &stage_->scene->blocking()};
}

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/gui.h"
#include "viewer/frame/stage.h"
#include "viewer/frame/swapchain.h"

namespace voxtact::view {

/// Makes the window's frames: answer, picture, slices and panels in one submission, two of them in flight. Only a
/// change of size and a new stage wait for the device. Without a stage there are only panels.
class Frames {
  public:
    /// Takes the surface.
    [[nodiscard]] static Result<std::unique_ptr<Frames>> create(const device::Session& session, VkSurfaceKHR surface);
    /// Waits for the device.
    ~Frames();

    /// True if the next frame's slot is free.
    [[nodiscard]] bool ready() const;
    /// Call before the panels: takes new answers of the slot's frame and the host. Only when ready().
    [[nodiscard]] Result<void> collect(State& state);
    /// Call after the panels. `window`: pixels; shows nothing if one is 0.
    [[nodiscard]] Result<void> show(State& state, const ImDrawData& panels, VkExtent2D window);
    /// Shows another stage, that of `state`, from the next frame on. Returns the previous one, or null.
    [[nodiscard]] Result<std::unique_ptr<Stage>> put(std::unique_ptr<Stage> stage, State& state);
    /// Replaces a lost surface: takes another one for the window's images.
    [[nodiscard]] Result<void> renewSurface(const std::function<Result<VkSurfaceKHR>()>& make);
    /// Returns the scene of a picture at a size, and its renderer, for use on any one thread while the stage exists.
    /// Requires a stage.
    [[nodiscard]] std::pair<ShownScene, BlockingRenderer*> screenshot(const State& state, const Extent& extent);

  private:
    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence done = VK_NULL_HANDLE;
        VkSemaphore acquired = VK_NULL_HANDLE;
        State::Clock::time_point submitted{};
        bool used = false;
    };

    explicit Frames(const device::Session& session) : session_(&session) {}
    [[nodiscard]] Result<void> makeSlots();
    [[nodiscard]] Result<void> makeTextures();
    [[nodiscard]] Result<void> waitForFrames();
    [[nodiscard]] Result<void> waitForDevice();
    [[nodiscard]] Result<void> collectAnswers(State& state, double wallMilliseconds, bool frame);
    [[nodiscard]] Result<void> fitStage(State& state);
    [[nodiscard]] Result<void> recordStage(State& state);
    [[nodiscard]] Result<void> fitSizes(State& state, VkExtent2D window);
    void setTextures(State& state);
    [[nodiscard]] Result<void> ask(State& state);
    [[nodiscard]] Result<void> collectBeside(State& state);
    void compareNext(State& state);
    [[nodiscard]] Result<void> begin();
    [[nodiscard]] Result<void> recordAnswer(State& state);
    [[nodiscard]] Result<void> record(State& state, const ImDrawData& panels, std::uint32_t image);
    [[nodiscard]] Result<void> submit(std::uint32_t image);
    void take(State& state, Result<LiveAnswer> answer);
    [[nodiscard]] Slot& slot() { return slots_[slot_]; }

    const device::Session* session_;
    std::unique_ptr<Stage> stage_;
    std::optional<Swapchain> swapchain_;
    std::optional<Gui> gui_;
    std::array<Slot, kFramesInFlight> slots_{};
    std::uint32_t slot_ = 0;      ///< of the next frame
    std::uint64_t asked_ = 0;     ///< State::revision of the last question that the host or a frame was asked
    std::uint64_t askedHost_ = 0; ///< the same for the host, which measures distances
    bool besideCompares_ = false; ///< the question beside the frames belongs to the comparison
    MethodChoice besideMethod_;   ///< method of the other question beside the frames
    MethodChoice answering_;      ///< the last that gave an answer
    std::array<VkDescriptorSet, 3> sliceSets_{};
    VkDescriptorSet coarse_ = VK_NULL_HANDLE;
    VkDescriptorSet fine_ = VK_NULL_HANDLE;
};

} // namespace voxtact::view

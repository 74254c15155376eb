// SPDX-License-Identifier: MIT
#pragma once

#include "view/frame/device_answers.h"
#include "view/frame/gui.h"
#include "view/frame/host_answers.h"
#include "view/frame/pictures.h"
#include "view/frame/slice_pass.h"
#include "view/frame/swapchain.h"

namespace voxtact::view {

/// Makes the window's frames: answer, picture, slices and panels in one submission, two of them in flight. Nothing
/// waits for the device but a change of a size.
class Frames {
  public:
    /// Takes the surface. `wake`: called from another thread when the host has an answer.
    [[nodiscard]] static Result<std::unique_ptr<Frames>> create(const device::Session& session, VkSurfaceKHR surface,
                                                                State& state, const Lighting& light,
                                                                const std::function<void()>& wake);
    /// Waits for the device.
    ~Frames();

    /// Whether the next frame's slot is free.
    [[nodiscard]] bool ready() const;
    /// Before the panels: what the slot's frame and the host have answered since. Only when ready().
    [[nodiscard]] Result<void> collect(State& state);
    /// After the panels. `window`: pixels; nothing is shown where one is 0.
    [[nodiscard]] Result<void> show(State& state, const ImDrawData& panels, VkExtent2D window);
    /// The picture of the state at a size: blocks.
    [[nodiscard]] Result<Picture> screenshot(const State& state, const Extent& extent);

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
    [[nodiscard]] Result<void> makeTextures(State& state);
    [[nodiscard]] Result<void> fitSizes(State& state, VkExtent2D window);
    void setTextures(const State& state);
    [[nodiscard]] Result<void> ask(State& state);
    [[nodiscard]] Result<void> begin();
    [[nodiscard]] Result<void> recordAnswer(State& state);
    [[nodiscard]] Result<void> record(State& state, const ImDrawData& panels, std::uint32_t image);
    [[nodiscard]] Result<void> submit(std::uint32_t image);
    void take(State& state, Result<LiveAnswer> answer);
    [[nodiscard]] Slot& slot() { return slots_[slot_]; }

    const device::Session* session_;
    std::unique_ptr<DeviceScene> scene_;
    std::optional<DeviceAnswers> device_;
    std::unique_ptr<HostAnswers> host_;
    std::optional<Swapchain> swapchain_;
    std::optional<Gui> gui_;
    std::optional<Pictures> pictures_;
    std::optional<SlicePass> slices_;
    std::array<Slot, kFramesInFlight> slots_{};
    std::uint32_t slot_ = 0;  ///< of the next frame
    std::uint64_t asked_ = 0; ///< State::revision of the last question
    MethodChoice answering_;  ///< the last that gave an answer
    VkDescriptorSet coarse_ = VK_NULL_HANDLE;
    VkDescriptorSet fine_ = VK_NULL_HANDLE;
};

} // namespace voxtact::view

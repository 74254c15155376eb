// SPDX-License-Identifier: MIT
#pragma once

#include "lab/measure/machine.h"

#include <array>
#include <memory>

namespace voxtact::lab {

/// Timestamps of a frame, by their numbers: around everything, and those of Target::timestamps.
inline constexpr std::uint32_t kFrameBegins = 0;
inline constexpr std::uint32_t kPictureBegins = 1;
inline constexpr std::uint32_t kMeshDone = 2;
inline constexpr std::uint32_t kVolumeDone = 3;
inline constexpr std::uint32_t kFrameEnds = 4;
inline constexpr std::uint32_t kFrameStamps = 5;

/// What an application that draws has of its own: an image to draw to, a command buffer, a fence, timestamps.
/// Thread-safety: none; one thread at a time.
class FrameTarget {
  public:
    /// The device must outlive it.
    [[nodiscard]] static Result<FrameTarget> create(const Session& session, VkFormat format, VkExtent2D extent);
    FrameTarget(FrameTarget&&) noexcept;
    FrameTarget& operator=(FrameTarget&&) noexcept;
    ~FrameTarget();

    [[nodiscard]] VkImageView view() const noexcept;
    /// Null where the queue has no timestamps.
    [[nodiscard]] VkQueryPool timestamps() const noexcept;

    /// Begins the command buffer anew, with the first timestamp, and makes the image ready to be drawn to.
    [[nodiscard]] Result<VkCommandBuffer> begin();
    /// The last timestamp; ends the command buffer.
    [[nodiscard]] Result<void> end();
    [[nodiscard]] Result<void> submit();
    [[nodiscard]] Result<void> wait();
    /// Between two timestamps of the frame that was waited for, ms. Nothing where the queue has none.
    [[nodiscard]] Result<std::optional<double>> between(std::uint32_t from, std::uint32_t to) const;

  private:
    struct State;
    explicit FrameTarget(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/device_scene.h"
#include "viewer/model/shown/pace.h"

namespace voxtact::view {

/// The large picture: coarse at first, as large as a frame has time for, then fine when nothing changes, some rows per
/// frame. Its images are in the layout GENERAL.
class Pictures {
  public:
    [[nodiscard]] static Result<Pictures> create(const device::Session& session, const Renderer& renderer,
                                                 const Extent& extent);
    Pictures(Pictures&& other) noexcept;
    Pictures& operator=(Pictures&&) = delete;
    ~Pictures();

    /// Creates images of that size. If it changes, nothing may be in flight.
    [[nodiscard]] Result<void> resize(const Renderer& renderer, const Extent& extent);
    [[nodiscard]] bool fits(const Extent& extent) const;

    /// Records the frame's share of the picture of `state`, if any, and sets the progress of the fine picture.
    [[nodiscard]] Result<void> record(VkCommandBuffer commands, DeviceScene& scene, State& state, std::uint32_t slot);
    /// Records the times of a slot's completed frame.
    void collect(std::uint32_t slot, double wallMilliseconds);

    [[nodiscard]] VkImageView coarse() const { return coarse_.view(); }
    [[nodiscard]] VkImageView fine() const { return fine_.view(); }
    /// Returns the part of coarse() that was drawn last.
    [[nodiscard]] SampledPart coarsePart() const { return sampledPart(shown_, full_); }

  private:
    explicit Pictures(const device::Session& session) : session_(&session) {}

    /// Result of a slot's frame.
    struct Made {
        double coarse = 0; ///< pixels
        double fine = 0;
        bool timed = false; ///< timestamps were written
    };

    const device::Session* session_;
    VkQueryPool timestamps_ = VK_NULL_HANDLE;
    double tick_ = 0; ///< ms
    std::optional<RenderTargets> targets_;
    Image coarse_;
    Image fine_;
    Extent full_{0, 0};
    Extent shown_{1, 1};
    std::uint64_t coarseOf_ = 0; ///< State::pictureRevision
    std::uint64_t fineOf_ = 0;
    std::uint32_t fineRows_ = 0; ///< that are there
    Pace pace_{45};
    std::array<Made, kFramesInFlight> made_{};
};

} // namespace voxtact::view

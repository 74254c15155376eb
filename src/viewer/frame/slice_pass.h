// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/resources.h"
#include "viewer/state.h"
#include "voxtact/scene.h"

#include <array>

namespace voxtact::view {

/// The gray slices, drawn from the volume's image on the device. Images in GENERAL.
class SlicePass {
  public:
    [[nodiscard]] static Result<SlicePass> create(const device::Session& session, const Volume& volume);

    /// Creates images of these sizes. If one changes, nothing may be in flight.
    [[nodiscard]] Result<void> resize(const std::array<Extent, 3>& extents);
    [[nodiscard]] bool fits(const std::array<Extent, 3>& extents) const;
    /// Records the slices that differ from the previous frame.
    void record(VkCommandBuffer commands, const State& state);

    [[nodiscard]] VkImageView view(std::size_t slice) const { return images_[slice].view(); }

  private:
    explicit SlicePass(const device::Session& session) : session_(&session) {}

    /// The push constants of slice.frag.
    struct Push {
        std::array<float, 16> texture_from_clip;
        std::array<float, 2> units;
        std::array<float, 2> window;
        std::array<float, 8> opaque;

        [[nodiscard]] bool operator==(const Push&) const = default;
    };
    [[nodiscard]] Push pushOf(const State& state, std::size_t slice) const;

    const device::Session* session_;
    Drawing drawing_;
    VkDescriptorSet volume_ = VK_NULL_HANDLE;
    std::array<Image, 3> images_;
    std::array<std::optional<Push>, 3> drawn_;
    std::uint64_t written_ = 0; ///< number of State::writes in them
};

} // namespace voxtact::view

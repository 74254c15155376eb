// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// Holes that are drilled into the volume, and filled again by undo.
namespace voxtact::view {

/// A hole: what the voxels of its box were, and what they are with it. Scalars of the volume's type, as in VolumeView.
struct Hole {
    VoxelBox box;
    std::vector<std::byte> before;
    std::vector<std::byte> after;
};

/// What is to be done with a volume's voxels, wherever there is a copy of it.
struct HoleWrite {
    std::shared_ptr<const Hole> hole;
    bool filled = false; ///< what was there before, instead of the hole

    [[nodiscard]] const std::vector<std::byte>& voxels() const { return filled ? hole->before : hole->after; }
    /// What was there until then.
    [[nodiscard]] const std::vector<std::byte>& replaced() const { return filled ? hole->after : hole->before; }
};

/// Writes to a volume for those who have copies of it, numbered from 0 in their order.
class HoleWrites {
  public:
    void add(HoleWrite write) { kept_.push_back(std::move(write)); }
    /// The number of the next one.
    [[nodiscard]] std::uint64_t end() const { return first_ + kept_.size(); }
    /// From this number on, of which none may be forgotten. Valid until the next change.
    [[nodiscard]] std::span<const HoleWrite> from(std::uint64_t number) const;
    /// The owner of a copy has done all before this number.
    void forget(std::uint64_t before);
    /// How many are not forgotten.
    [[nodiscard]] std::size_t kept() const { return kept_.size(); }

  private:
    std::vector<HoleWrite> kept_;
    std::uint64_t first_ = 0; ///< the number of the first that is kept
};

/// Voxels of a hole's box, at most.
inline constexpr std::uint64_t kMostHoleVoxels = std::uint64_t{1} << 24U;

/// The voxels of a ball get one value, in the image's units. With an empty box where the ball has no voxel. Refuses a
/// ball that voxelBounds() refuses, more than kMostHoleVoxels (LimitExceeded), and a value that no voxel can have.
[[nodiscard]] Result<Hole> holeOf(const VolumeView& volume, const Ball& ball, double value);

/// Holes in the order in which they were drilled, of which the first so many are there.
class Holes {
  public:
    [[nodiscard]] std::size_t drilled() const { return drilled_; }
    /// One more into the volume as it is; those that were filled again are forgotten.
    void add(Hole hole);
    /// Drills and fills until there are so many, at most as many as are known. Returns what it did, in order.
    [[nodiscard]] std::vector<HoleWrite> bring(VolumeData& volume, std::size_t number);

  private:
    std::vector<std::shared_ptr<const Hole>> holes_;
    std::size_t drilled_ = 0; ///< of holes_
};

} // namespace voxtact::view

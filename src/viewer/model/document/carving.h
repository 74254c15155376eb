// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// Holes drilled into the volume; undo fills them.
namespace voxtact::view {

/// A hole: the voxels of its box before and after drilling. Scalars of the volume's type, like in VolumeView.
struct Hole {
    VoxelBox box;
    std::vector<std::byte> before;
    std::vector<std::byte> after;
};

/// A change of a volume's voxels, for each copy.
struct HoleWrite {
    std::shared_ptr<const Hole> hole;
    bool filled = false; ///< restores the previous voxels

    [[nodiscard]] const std::vector<std::byte>& voxels() const { return filled ? hole->before : hole->after; }
    /// Returns the previous voxels.
    [[nodiscard]] const std::vector<std::byte>& replaced() const { return filled ? hole->after : hole->before; }
};

/// Changes of a volume for its copies, numbered from 0 in order.
class HoleWrites {
  public:
    void add(HoleWrite write) { kept_.push_back(std::move(write)); }
    /// Returns the number of the next change.
    [[nodiscard]] std::uint64_t end() const { return first_ + kept_.size(); }
    /// Returns the changes from this number on, none of which may be dropped. Valid until the next change.
    [[nodiscard]] std::span<const HoleWrite> from(std::uint64_t number) const;
    /// The owner of a copy has applied all changes before this number.
    void forget(std::uint64_t before);
    /// Returns the number of kept changes.
    [[nodiscard]] std::size_t kept() const { return kept_.size(); }

  private:
    std::vector<HoleWrite> kept_;
    std::uint64_t first_ = 0; ///< number of the first kept change
};

/// Maximum voxels of a hole's box.
inline constexpr std::uint64_t kMostHoleVoxels = std::uint64_t{1} << 24U;

/// Returns a hole that sets the voxels of a ball to a value, in the image's units; its box is empty if the ball has no
/// voxel. Refuses a ball that voxelBounds() refuses, more than kMostHoleVoxels (LimitExceeded), and a value that no
/// voxel can have.
[[nodiscard]] Result<Hole> holeOf(const VolumeView& volume, const Ball& ball, double value);

/// Holes in the order of drilling; the first `count` of them exist.
class Holes {
  public:
    [[nodiscard]] std::size_t drilled() const { return drilled_; }
    /// Drills another hole; forgets the filled ones.
    void add(Hole hole);
    /// Drills and fills until this number of holes exists, at most the known ones. Returns the changes, in order.
    [[nodiscard]] std::vector<HoleWrite> bring(VolumeData& volume, std::size_t number);

  private:
    std::vector<std::shared_ptr<const Hole>> holes_;
    std::size_t drilled_ = 0; ///< of holes_
};

} // namespace voxtact::view

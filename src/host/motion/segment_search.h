// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/rigid_motion.h"
#include "host/motion/bending.h"
#include "host/search/pair_at.h"

#include <memory>
#include <vector>

namespace voxtact::cpu {

/// One segment on one thread: halves of it, the earliest first, until each is free or has no more than the resolution.
///
/// A half is free where the mesh at its middle, swept as far as it moves in half of it (Sweep), is apart from what is
/// opaque. Nothing is sampled: what is called free is free at all of its poses.
class SegmentSearch {
  public:
    /// All must live as long as it. `bending`: of the mesh on its way; null: it does not bend.
    SegmentSearch(const BatchItem& item, const OpaquePart& part, const RigidMotion& motion, const Motion& desc,
                  ThreadMemory& memory, std::uint32_t firstPose, CancelFlag cancel, Bending* bending = nullptr);

    void run(SegmentMotion& out);

  private:
    struct Interval {
        double from = 0;
        double to = 1;
        /// What of mesh and volume may meet in it; null: all.
        std::shared_ptr<const OpenPairs> open{};

        [[nodiscard]] double middle() const noexcept { return 0.5 * (from + to); }
    };

    [[nodiscard]] double length(const Interval& interval) const noexcept {
        return (interval.to - interval.from) * speed_;
    }
    /// The mesh there.
    [[nodiscard]] PairAt pairAt(double parameter) const;
    [[nodiscard]] const Box& bounds() const;
    /// How near what is opaque comes to the mesh in an interval.
    struct Seen {
        bool isFree = false;
        bool isMet = false; ///< it seems that some of it is met
    };
    [[nodiscard]] Seen see(const Interval& interval, bool last);
    /// The poses after it are not examined any more.
    [[nodiscard]] bool touches(double parameter, SegmentMotion& out);
    void look(const Interval& interval, SegmentMotion& out);

    const BatchItem& item_;
    const OpaquePart& part_;
    const RigidMotion& motion_;
    const Motion& desc_;
    ThreadMemory& memory_;
    CancelFlag cancel_;
    Bending* bending_;
    double scale_;               ///< no pose makes more mm of a unit of object space
    double speed_;               ///< mm for the whole segment: of the fastest point
    double deformation_;         ///< mm: RigidMotion::deformation()
    double rounding_;            ///< mm, of a pose and of vertices
    std::uint64_t steps_ = 0;    ///< so far
    std::vector<Interval> left_; ///< the earliest at the end
};

} // namespace voxtact::cpu

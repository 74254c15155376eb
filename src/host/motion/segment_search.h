// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/rigid_motion.h"
#include "host/motion/bending.h"
#include "host/search/pair_at.h"

#include <memory>
#include <vector>

namespace voxtact::cpu {

/// Searches one segment on one thread: halves it, the earliest half first, until each piece is free or at most as long
/// as the resolution.
///
/// A piece is free if the mesh at its middle, swept over its motion in that piece (Sweep), is apart from the opaque
/// region. No sampling: a free piece is free at all of its poses.
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
        /// Pairs of mesh and volume that may meet in the piece; null: all.
        std::shared_ptr<const OpenPairs> open{};

        [[nodiscard]] double middle() const noexcept { return 0.5 * (from + to); }
    };

    [[nodiscard]] double length(const Interval& interval) const noexcept {
        return (interval.to - interval.from) * speed_;
    }
    /// The mesh there.
    [[nodiscard]] PairAt pairAt(double parameter) const;
    [[nodiscard]] const Box& bounds() const;
    /// Proximity of the opaque region to the mesh in an interval.
    struct Seen {
        bool isFree = false;
        bool isMet = false; ///< a pair seems to meet
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
    std::uint64_t steps_ = 0;    ///< iterations so far
    std::vector<Interval> left_; ///< the earliest at the end
};

} // namespace voxtact::cpu

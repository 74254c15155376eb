// SPDX-License-Identifier: MIT
#include "host/motion/segment_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::cpu {

namespace {

/// Smallest piece, relative to the resolution: a touch that begins where two pieces meet is found at the middle of the
/// second.
constexpr double kLastPiece = 0.25;
/// After a graze, only a touch is searched for, at steps of this fraction of the distance from it.
constexpr double kCoarser = 0.5;
/// Smallest box of the volume, relative to the length of a piece, unless the piece is not halved any more.
constexpr double kFinestBox = 0.0625;

/// Upper bound of the length of a unit vector after a pose, or after a pose that differs by a motion: its square is at
/// most a row sum of the symmetric matrix of squared lengths.
double scaleOf(const Mat4& pose) {
    double most = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        double sum = 0;
        for (std::size_t column = 0; column < 3; ++column) {
            double product = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                product += pose[4 * row + i] * pose[4 * column + i];
            }
            sum += std::abs(product);
        }
        most = std::max(most, sum);
    }
    return (1 + 4 * kMaxDeformation) * std::sqrt(most);
}

} // namespace

SegmentSearch::SegmentSearch(const BatchItem& item, const OpaquePart& part, const RigidMotion& motion,
                             const Motion& desc, ThreadMemory& memory, std::uint32_t firstPose, CancelFlag cancel,
                             Bending* bending)
    : item_(item), part_(part), motion_(motion), desc_(desc), memory_(memory), cancel_(cancel), bending_(bending),
      scale_(scaleOf(item.world_from_object[firstPose])), speed_(motion.speed(bounds())),
      deformation_(motion.deformation(bounds())), rounding_(motion.rounding(bounds())) {
    if (bending_ != nullptr) {
        speed_ += scale_ * bending_->reach().most;
        rounding_ += 2 * scale_ * bending_->rounding(); // of its position, and of its possible positions
    }
}

const Box& SegmentSearch::bounds() const {
    return bending_ != nullptr ? bending_->bounds() : item_.mesh->facts().bounds;
}

PairAt SegmentSearch::pairAt(double parameter) const {
    return {item_, part_, motion_.at(parameter), cancel_, bending_ != nullptr ? &bending_->at(parameter) : nullptr};
}

SegmentSearch::Seen SegmentSearch::see(const Interval& interval, bool last) {
    // A longer one that is not soon found to be free is halved, which makes it easier.
    constexpr std::uint64_t kSoon = 600;
    constexpr std::uint64_t kMost = 1U << 16U; // more decide no more than whether it grazes
    constexpr double kEnough = 1e-3;
    const double half = 0.5 * (interval.to - interval.from);
    const RigidMotion::Tangent tangent = motion_.tangent(interval.middle());
    Sweep sweep;
    sweep.linear = half * tangent.linear;
    sweep.offset = half * tangent.offset;
    sweep.straight = half * tangent.straight;
    sweep.bend = 0.5 * half * motion_.angle();
    sweep.slack = half * deformation_ + rounding_;
    if (bending_ != nullptr) {
        sweep.each = &bending_->reach();
        sweep.eachScale = half * scale_;
    }
    const SearchGoal goal{.tolerance = 0,
                          .maximum = std::numeric_limits<double>::denorm_min(),
                          .enough = (last ? kEnough : 1) * desc_.resolution,
                          .finest = std::max(kLastPiece * desc_.resolution, last ? 0 : kFinestBox * length(interval)),
                          .maxSteps =
                              std::min(desc_.maxSteps - std::min(steps_, desc_.maxSteps - 1), last ? kMost : kSoon)};
    const Found found = pairAt(interval.middle()).search(memory_, goal, sweep, interval.open.get());
    steps_ += found.steps + 1;
    return {found.lo > 0, found.hi <= goal.enough};
}

bool SegmentSearch::touches(double parameter, SegmentMotion& out) {
    constexpr std::uint64_t kTouchSteps = 256; // a hard decision takes as long as many search steps
    const PairAt at = pairAt(parameter);
    std::optional<TouchPoint> point;
    steps_ += kTouchSteps;
    if (at.touch(point).certain == 0) {
        return false;
    }
    MotionTouch touch;
    touch.at = parameter;
    touch.world_from_object = at.world_from_object;
    if (point) {
        touch.position = point->position;
        touch.triangle = point->triangle;
    }
    out.touch = touch;
    left_.clear();
    return true;
}

/// All before it is free, or a graze is known.
void SegmentSearch::look(const Interval& interval, SegmentMotion& out) {
    const bool grazes = out.freeUntil < interval.from;
    const double finest =
        std::max(kLastPiece * desc_.resolution, grazes ? kCoarser * speed_ * (interval.from - out.freeUntil) : 0.0);
    const bool last = length(interval) <= finest || interval.middle() <= interval.from;
    const Seen seen = see(interval, last);
    if (seen.isFree) {
        out.freeUntil = grazes ? out.freeUntil : interval.to;
        return;
    }
    if (last) {
        // The next piece is tested at its own middle, unless there is none.
        static_cast<void>(touches(interval.middle(), out) || (interval.to == 1 && touches(1, out)));
        return;
    }
    // A pair that is apart during the whole piece is apart in each half.
    const auto open = std::make_shared<const OpenPairs>(memory_.search.left());
    if (!(seen.isMet && touches(interval.middle(), out))) {
        left_.push_back({interval.middle(), interval.to, open});
    }
    left_.push_back({interval.from, interval.middle(), open});
}

void SegmentSearch::run(SegmentMotion& out) {
    if (touches(0, out)) {
        return;
    }
    left_.emplace_back();
    while (!left_.empty() && steps_ < desc_.maxSteps && !isCancelled(cancel_)) {
        const Interval next = left_.back();
        left_.pop_back();
        look(next, out);
    }
    if (!left_.empty()) {
        out.end = MotionEnd::Budget;
    } else if (out.touch ? length({out.freeUntil, out.touch->at}) > desc_.resolution : out.freeUntil < 1) {
        out.end = MotionEnd::Grazes;
    }
    out.possible = !out.touch && out.freeUntil < 1;
}

} // namespace voxtact::cpu

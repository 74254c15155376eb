// SPDX-License-Identifier: MIT
#include "host/count/occupancy.h"
#include "core/geometry/pair_transform.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

constexpr std::size_t kSlack = 4;
/// Beyond that many comparisons the table is the shorter way.
constexpr std::size_t kMostIntervals = 8;
/// Interpolation of larger voxels may overflow.
constexpr float kLargestVoxel = 1e37F;

/// Seven interpolations may leave the range of their corners by their rounding: less than 21 units of 2^-24 of the
/// largest corner.
float interpolationError(float lo, float hi) {
    return std::max(std::abs(lo), std::abs(hi)) * 0x1p-19F;
}

} // namespace

Occupancy::Occupancy(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold)
    : count_(volume.bricks.count), constants_(itemConstants(1, volume.storedIntercept, function.domain, threshold)),
      table_(function.table), set_(table_, constants_) {
    classify(volume.bricks);
    sums_ = BrickSums<std::uint64_t>(count_, [this](std::size_t brick) {
        return (classes_[brick] & 1U) + (std::uint64_t{classes_[brick] & 2U} << 31U);
    });
}

void Occupancy::classify(const BrickRanges& ranges) {
    classes_.assign(ranges.lo.size() + kSlack, kMixedBrick);
    const bool bounded = *std::min_element(ranges.lo.begin(), ranges.lo.end()) >= -kLargestVoxel &&
                         *std::max_element(ranges.hi.begin(), ranges.hi.end()) <= kLargestVoxel;
    if (!set_.valid() || !bounded) {
        return;
    }
    useIntervals_ = set_.intervals().size() <= kMostIntervals;
    for (std::size_t brick = 0; brick < ranges.lo.size(); ++brick) {
        const float error = interpolationError(ranges.lo[brick], ranges.hi[brick]);
        const float lo = ranges.lo[brick] - error;
        const float hi = ranges.hi[brick] + error;
        if (!set_.meets(lo, hi)) {
            classes_[brick] = kClearBrick;
        } else if (set_.contains(lo, hi)) {
            classes_[brick] = kOpaqueBrick;
        }
    }
}

BrickClass Occupancy::within(const BrickBox& box) const noexcept {
    // The halves do not disturb each other: both final numbers are between 0 and the number of bricks.
    const std::uint64_t found = sums_.within(box);
    if ((found & 0xffffffffU) == 0) {
        return kClearBrick;
    }
    const std::uint64_t bricks = static_cast<std::uint64_t>(box.hi[0] - box.lo[0] + 1) *
                                 static_cast<std::uint64_t>(box.hi[1] - box.lo[1] + 1) *
                                 static_cast<std::uint64_t>(box.hi[2] - box.lo[2] + 1);
    return found >> 32U == bricks ? kOpaqueBrick : kMixedBrick;
}

bool Occupancy::nothingOpaque() const noexcept {
    return (sums_.all() & 0xffffffffU) == 0;
}

} // namespace voxtact::cpu

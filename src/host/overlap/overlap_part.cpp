// SPDX-License-Identifier: MIT
#include "host/overlap/overlap_part.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::cpu {

namespace {

/// A cell is divided until its bounds are so near at level 0, of a voxel, or so often; at each further level they are
/// nearer by the factor, and it is divided more often.
constexpr double kNear = 0x1p-6;
constexpr double kNearer = 0x1p-5;
constexpr unsigned kDivisions = 6;
constexpr unsigned kMoreDivisions = 6;
constexpr unsigned kMaxLevel = 4;

/// Halves a box in the middle across an axis.
CellPartBox halfOf(const CellPartBox& box, int axis, bool upper) {
    CellPartBox half = box;
    (upper ? half.lo : half.hi)[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
    return half;
}

/// Opaque voxels of a box.
ValueRange divided(BoxMeasure& measure, const CellPartBox& box, double near, unsigned divisions) {
    const BoxVolume whole = measure.opaque(box);
    if (whole.gain <= near || divisions == 0) {
        return {whole.lo, whole.hi};
    }
    const ValueRange below = divided(measure, halfOf(box, whole.axis, false), near / 2, divisions - 1);
    const ValueRange above = divided(measure, halfOf(box, whole.axis, true), near / 2, divisions - 1);
    return {std::max(whole.lo, below.lo + above.lo), std::min(whole.hi, below.hi + above.hi)};
}

} // namespace

OverlapPart::OverlapPart(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold)
    : part(volume, function, threshold, kDefaultResolution), kinds_(volume.bricks.lo.size(), Kind::Clear),
      slots_(kinds_.size()) {
    std::uint32_t mixed = 0;
    for (std::size_t brick = 0; brick < kinds_.size(); ++brick) {
        const auto lo = static_cast<double>(volume.bricks.lo[brick]);
        const auto hi = static_cast<double>(volume.bricks.hi[brick]);
        const double error = 8 * valueError(lo, hi);
        slots_[brick] = mixed;
        if (part.intervals.contain(lo - error, hi + error)) {
            kinds_[brick] = Kind::Opaque;
        } else if (part.intervals.mayMeet(lo - error, hi + error)) {
            kinds_[brick] = Kind::Mixed;
            ++mixed;
        }
    }
    for (auto& level : volumes_) {
        level = MadeOnce<std::shared_ptr<const BrickVolumes>>(mixed);
    }
}

bool OverlapPart::isCertainOutside(const VolumeImpl& volume, const BrickBox& box) const {
    const auto& count = volume.bricks.count;
    std::size_t number = 0;
    for (std::int32_t z = 0; z < count[2]; ++z) {
        for (std::int32_t y = 0; y < count[1]; ++y) {
            for (std::int32_t x = 0; x < count[0]; ++x, ++number) {
                const bool isIn = x >= box.lo[0] && x <= box.hi[0] && y >= box.lo[1] && y <= box.hi[1] &&
                                  z >= box.lo[2] && z <= box.hi[2];
                if (!isIn && kinds_[number] != Kind::Clear &&
                    part.intervals.certainlyMeet(static_cast<double>(volume.bricks.lo[number]),
                                                 static_cast<double>(volume.bricks.hi[number]))) {
                    return true;
                }
            }
        }
    }
    return false;
}

OverlapPart::Kind OverlapPart::kind(const VolumeImpl& volume, const NodePlace& cell) const {
    const Kind ofBrick = kinds_[part.occupancy.brickNumber(brickOf(cell))];
    if (ofBrick != Kind::Mixed) {
        return ofBrick;
    }
    const ValueRange range = part.cornerRange(volume, cell);
    const double error = 8 * valueError(range.lo, range.hi);
    if (part.intervals.contain(range.lo - error, range.hi + error)) {
        return Kind::Opaque;
    }
    return part.intervals.mayMeet(range.lo - error, range.hi + error) ? Kind::Mixed : Kind::Clear;
}

BoxVolume OverlapPart::cell(const VolumeImpl& volume, const NodePlace& cell, unsigned level) const {
    const CellPartBox box = wholeCell(volume, cell);
    const double near = kNear * std::pow(kNearer, level);
    const auto make = [&] {
        BoxMeasure measure(volume, part, 0);
        return divided(measure, box, near, kDivisions + kMoreDivisions * level);
    };
    ValueRange found;
    if (isKept(level)) {
        const std::uint32_t slot = slots_[part.occupancy.brickNumber(brickOf(cell))];
        const auto* brick = volumes_[level].find(slot);
        if (brick == nullptr) {
            brick = &volumes_[level].keep(slot, std::make_shared<const BrickVolumes>());
        }
        found = (*brick)->get(placeOf(cell), [&] {
            constexpr double kDown = 1 - 0x1p-22; // rounded outward
            const ValueRange made = make();
            return std::array{static_cast<float>(made.lo * kDown), static_cast<float>(made.hi / kDown)};
        });
    } else {
        found = make();
    }
    BoxVolume out;
    out.lo = found.lo;
    out.hi = std::min(found.hi, box.volume());
    out.mayLeave = false;
    out.gain = level < kMaxLevel ? out.hi - out.lo : 0;
    return out;
}

} // namespace voxtact::cpu

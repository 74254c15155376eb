// SPDX-License-Identifier: MIT
#include "host/touch/cells/certified_occupancy.h"
#include "core/method/certified_constants.h"

namespace voxtact::cpu {

namespace {
/// A larger box probably contains a cell that may be opaque, and takes long to test.
constexpr std::uint32_t kMostBricks = 27;
} // namespace

CertifiedOccupancy::CertifiedOccupancy(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold,
                                       double resolution)
    : numbers_(
          opaqueNumbers(function.points, threshold, {1, volume.storedIntercept}, volume.image.type != Stored::Float)),
      opaque_(numbers_.values()), item_(certifiedItem(volume.grid, numbers_, resolution)), count_(volume.bricks.count),
      mixed_(volume.bricks.lo.size()) {
    for (std::size_t brick = 0; brick < mixed_.size(); ++brick) {
        const bool may =
            shader::certifiedRangeMayBeOpaque(opaque_, item_, volume.bricks.lo[brick], volume.bricks.hi[brick]);
        mixed_[brick] = may ? 1 : 0;
    }
    bricks_ = CertifiedBricks(mixed_);
    sums_ = BrickSums<std::uint32_t>(count_, [this](std::size_t brick) { return std::uint32_t{mixed_[brick]}; });
}

bool CertifiedOccupancy::mayBeOpaque(const VolumeImpl& volume, const CellBox& cells) const {
    const BrickBox box = cells.bricks();
    if (box.hi == box.lo) {
        return mayBeOpaque(volume, box.lo, cells);
    }
    // A few bricks are tested one by one.
    if (box.hi[0] - box.lo[0] > 1 || box.hi[1] - box.lo[1] > 1 || box.hi[2] - box.lo[2] > 1) {
        const std::uint32_t mixed = sums_.within(box);
        if (mixed == 0 || mixed > kMostBricks) {
            return mixed != 0;
        }
    }
    for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
        for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
            for (std::int32_t x = box.lo[0]; x <= box.hi[0]; ++x) {
                if (mayBeOpaque(volume, {x, y, z}, cells)) {
                    return true;
                }
            }
        }
    }
    return false;
}

bool CertifiedOccupancy::mayBeOpaque(const VolumeImpl& volume, const std::array<std::int32_t, 3>& brick,
                                     const CellBox& cells) const {
    const std::size_t number = brickNumber(brick);
    return mayBeOpaque(number) && bricks_.at(volume, item_, opaque_, number, brick).any(cells.within(brick));
}

} // namespace voxtact::cpu

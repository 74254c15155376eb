// SPDX-License-Identifier: MIT
#include "host/touch/cells/brick_occupancy.h"
#include "core/transfer/opaque_ranges.h"
#include "host/scene/scene_impl.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Weights of 8 fraction bits put a sample this far, in voxels, from its place; rounding comes on top.
constexpr double kPlace = 1.0 / 64;
/// A normalised texel of 16 bits.
constexpr double kLargestTexel = 65535;

/// The largest term of a texel, in the image's units.
double largestTexel(const VolumeImpl& volume) {
    if (volume.image.type != Stored::Float) {
        return kLargestTexel;
    }
    double largest = 0;
    for (const std::vector<float>* ends : {&volume.bricks.lo, &volume.bricks.hi}) {
        for (const float value : *ends) {
            largest = std::max(largest, std::abs(static_cast<double>(value)));
        }
    }
    return largest;
}

} // namespace

BrickOccupancy::BrickOccupancy(const Volume& volume, const TransferFunction& function, double threshold,
                               double tolerance)
    : size_(volume.impl().image.size) {
    const VolumeImpl& image = volume.impl();
    const TransferFunctionImpl& table = function.impl();
    const OpaqueRanges opaque(table.table, table.domain, threshold,
                              largestTerm(image.storedIntercept, largestTexel(image), table.domain));
    sums_ = BrickSums<std::uint32_t>(image.bricks.count, [&](std::size_t brick) {
        const double lo = static_cast<double>(image.bricks.lo[brick]) - tolerance + image.storedIntercept;
        const double hi = static_cast<double>(image.bricks.hi[brick]) + tolerance + image.storedIntercept;
        return opaque.mayBeOpaque({lo, hi}) ? 1U : 0U;
    });
}

bool BrickOccupancy::mayBeOpaque(const Box& texture) const noexcept {
    BrickBox bricks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The padded number of the cell at a place: core/volume/bricks.h.
        const auto brick = [&](double place) {
            const double cell = std::floor(std::clamp(place, 0.0, static_cast<double>(size_[axis])));
            return static_cast<std::int32_t>(cell) >> kBrickShift;
        };
        bricks.lo[axis] = brick(texture.lo[axis] * size_[axis] + 0.5 - kPlace);
        bricks.hi[axis] = brick(texture.hi[axis] * size_[axis] + 0.5 + kPlace);
    }
    return sums_.within(bricks) != 0;
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
// The verdict on texture coordinates: range test or clamp, bricks, trilinear interpolation, transfer function.
#if defined(VOXTACT_CPU_SIMD_SAMPLE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_SAMPLE_H
#undef VOXTACT_CPU_SIMD_SAMPLE_H
#else
#define VOXTACT_CPU_SIMD_SAMPLE_H
#endif

#include "host/count/scalar_sample.h"
#include "host/count/simd_base.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {

using FloatM = hn::Mask<Floats>;

/// exactCell() along one axis: the padded index of the lower corner, and the weight.
struct Cell {
    IntV index;
    FloatV weight;
};

HWY_INLINE Cell cellOf(FloatV coordinate, float size) {
    const Floats d;
    const Ints ints;
    const FloatV shifted = hn::Sub(hn::Mul(coordinate, hn::Set(d, size)), hn::Set(d, 0.5F));
    const FloatV whole = hn::Floor(shifted);
    return {hn::Add(hn::ConvertTo(ints, whole), hn::Set(ints, 1)), hn::Sub(shifted, whole)};
}

/// Interpolation along x between the voxel at `index` and the next. Four bytes are read at once.
HWY_INLINE FloatV along(const std::uint8_t* voxels, IntV index, FloatV weight) {
    const Floats d;
    const Ints ints;
    const IntV four = hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(voxels), index);
    const IntV byte = hn::Set(ints, 0xff);
    return lerp(hn::ConvertTo(d, hn::And(four, byte)), hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(four), byte)),
                weight);
}
HWY_INLINE FloatV along(const std::uint16_t* voxels, IntV index, FloatV weight) {
    const Floats d;
    const Ints ints;
    const hn::RebindToUnsigned<Floats> unsignedInts;
    const IntV two = hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(voxels), hn::ShiftLeft<1>(index));
    const auto upper = hn::ShiftRight<16>(hn::BitCast(unsignedInts, two));
    return lerp(hn::ConvertTo(d, hn::And(two, hn::Set(ints, 0xffff))), hn::ConvertTo(d, hn::BitCast(ints, upper)),
                weight);
}
HWY_INLINE FloatV along(const float* voxels, IntV index, FloatV weight) {
    const Floats d;
    return lerp(hn::GatherIndex(d, voxels, index), hn::GatherIndex(d, voxels + 1, index), weight);
}

template <class Kept> class Sampler {
  public:
    Sampler(const PairJob& job, const Kept* voxels)
        : job_(job), voxels_(voxels), wide_(!fitsOffsets(job.volume.image)),
          rowStride_(static_cast<std::int32_t>(job.volume.image.stride[1])),
          layerStride_(wide_ ? 0 : static_cast<std::int32_t>(job.volume.image.stride[2])) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            size_[axis] = static_cast<float>(job.volume.image.size[axis]);
        }
    }

    /// Returns the number of passing lanes in `live`.
    HWY_INLINE std::size_t survivors(FloatV x, FloatV y, FloatV z, FloatM live) const {
        const Floats d;
        const FloatV zero = hn::Zero(d);
        const FloatV one = hn::Set(d, 1.0F);
        if (job_.view.rangeTest) {
            const FloatM low = hn::And(hn::And(hn::Ge(x, zero), hn::Ge(y, zero)), hn::Ge(z, zero));
            const FloatM high = hn::And(hn::And(hn::Le(x, one), hn::Le(y, one)), hn::Le(z, one));
            live = hn::And(live, hn::And(low, high));
            if (hn::AllFalse(d, live)) {
                return 0;
            }
        }
        // Includes inactive lanes: every lookup must stay in the image, for any coordinate.
        x = hn::IfThenElseZero(hn::Ge(x, zero), hn::Min(x, one));
        y = hn::IfThenElseZero(hn::Ge(y, zero), hn::Min(y, one));
        z = hn::IfThenElseZero(hn::Ge(z, zero), hn::Min(z, one));
        return HWY_UNLIKELY(wide_) ? oneByOne(x, y, z, live) : looked(x, y, z, live);
    }

  private:
    HWY_INLINE std::size_t looked(FloatV x, FloatV y, FloatV z, FloatM live) const {
        const Floats d;
        const Ints ints;
        const Cell cellX = cellOf(x, size_[0]);
        const Cell cellY = cellOf(y, size_[1]);
        const Cell cellZ = cellOf(z, size_[2]);
        const IntV brick = hn::And(brickClasses(cellX.index, cellY.index, cellZ.index), hn::Set(ints, kOpaqueBrick));
        const FloatM certain =
            hn::And(live, hn::RebindMask(d, hn::Eq(brick, hn::Set(ints, std::int32_t{kOpaqueBrick}))));
        const FloatM mixed = hn::And(live, hn::RebindMask(d, hn::Eq(brick, hn::Set(ints, std::int32_t{kMixedBrick}))));
        const std::size_t found = hn::CountTrue(d, certain);
        if (hn::AllFalse(d, mixed)) {
            return found;
        }
        return found + hn::CountTrue(d, hn::And(mixed, opaque(interpolated(cellX, cellY, cellZ))));
    }

    HWY_INLINE IntV brickClasses(IntV x, IntV y, IntV z) const {
        const Ints ints;
        const auto& count = job_.volume.bricks.count;
        const IntV row =
            hn::Add(hn::ShiftRight<kBrickShift>(y), hn::Mul(hn::ShiftRight<kBrickShift>(z), hn::Set(ints, count[1])));
        const IntV index = hn::Add(hn::ShiftRight<kBrickShift>(x), hn::Mul(row, hn::Set(ints, count[0])));
        return hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(job_.occupancy.classes()), index);
    }

    HWY_INLINE FloatV interpolated(const Cell& x, const Cell& y, const Cell& z) const {
        const Ints ints;
        const IntV index = hn::Add(x.index, hn::Add(hn::Mul(y.index, hn::Set(ints, rowStride_)),
                                                    hn::Mul(z.index, hn::Set(ints, layerStride_))));
        const IntV nextRow = hn::Add(index, hn::Set(ints, rowStride_));
        const Kept* above = voxels_ + layerStride_;
        const FloatV nearer = lerp(along(voxels_, index, x.weight), along(voxels_, nextRow, x.weight), y.weight);
        const FloatV farther = lerp(along(above, index, x.weight), along(above, nextRow, x.weight), y.weight);
        return lerp(nearer, farther, z.weight);
    }

    HWY_INLINE FloatM opaque(FloatV stored) const {
        const Floats d;
        if (HWY_UNLIKELY(!job_.occupancy.useIntervals())) {
            return lookedUp(stored);
        }
        FloatM found = hn::Lt(hn::Set(d, 1.0F), hn::Zero(d));
        for (const Interval& interval : job_.occupancy.intervals()) {
            found = hn::Or(found,
                           hn::And(hn::Ge(stored, hn::Set(d, interval.lo)), hn::Le(stored, hn::Set(d, interval.hi))));
        }
        return found;
    }

    /// exactEntry() and the table.
    HWY_INLINE FloatM lookedUp(FloatV stored) const {
        const Floats d;
        const Ints ints;
        const shader::ItemConstants& constants = job_.occupancy.constants();
        const std::vector<float>& table = job_.occupancy.table();
        const FloatV last = hn::Set(d, static_cast<float>(static_cast<int>(table.size()) - 1));
        const FloatV scalar =
            hn::Add(hn::Mul(stored, hn::Set(d, constants.scalarScale)), hn::Set(d, constants.scalarBias));
        const FloatV shifted =
            hn::Sub(hn::Mul(scalar, hn::Set(d, static_cast<float>(static_cast<int>(table.size())))), hn::Set(d, 0.5F));
        const FloatV clamped = hn::IfThenElseZero(hn::Ge(shifted, hn::Zero(d)), hn::Min(shifted, last));
        const FloatV whole = hn::Floor(clamped);
        const IntV below = hn::ConvertTo(ints, whole);
        const IntV above = hn::ConvertTo(ints, hn::Min(hn::Add(whole, hn::Set(d, 1.0F)), last));
        const FloatV opacity = lerp(hn::GatherIndex(d, table.data(), below), hn::GatherIndex(d, table.data(), above),
                                    hn::Sub(clamped, whole));
        return hn::Ge(opacity, hn::Set(d, constants.threshold));
    }

    /// For volumes beyond the reach of 32-bit offsets.
    HWY_NOINLINE std::size_t oneByOne(FloatV x, FloatV y, FloatV z, FloatM live) const {
        const Floats d;
        HWY_ALIGN float coordinates[3][kMaxLanes];
        HWY_ALIGN float alive[kMaxLanes];
        hn::Store(x, d, coordinates[0]);
        hn::Store(y, d, coordinates[1]);
        hn::Store(z, d, coordinates[2]);
        hn::Store(hn::IfThenElseZero(live, hn::Set(d, 1.0F)), d, alive);
        std::size_t found = 0;
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
            found += alive[lane] != 0 && sampleIsOpaque(job_.volume.image, job_.occupancy, coordinates[0][lane],
                                                        coordinates[1][lane], coordinates[2][lane])
                         ? 1U
                         : 0U;
        }
        return found;
    }

    const PairJob& job_;
    const Kept* voxels_;
    bool wide_;
    std::int32_t rowStride_;
    std::int32_t layerStride_;
    float size_[3];
};

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif

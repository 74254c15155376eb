// SPDX-License-Identifier: MIT
// Rows of a brick's cells as vectors, for one target.
#if defined(VOXTACT_CPU_SIMD_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_ROWS_H
#undef VOXTACT_CPU_SIMD_ROWS_H
#else
#define VOXTACT_CPU_SIMD_ROWS_H
#endif

#include "host/touch/cells/cell_box.h"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A row, as far as it fits into a vector.
using RowFloats = hn::CappedTag<float, kBrickSide>;
using RowV = hn::Vec<RowFloats>;

/// Bit i for lane i.
HWY_INLINE unsigned bitsOf(hn::Mask<RowFloats> mask) {
    const RowFloats d;
    std::uint8_t bits[8] = {}; // as many as StoreMaskBits() may write
    hn::StoreMaskBits(d, mask, bits);
    return bits[0];
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif

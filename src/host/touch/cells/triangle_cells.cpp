// SPDX-License-Identifier: MIT
#include "host/touch/cells/triangle_cells.h"

#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/touch/cells/triangle_cells.cpp"
#include <hwy/foreach_target.h>

#include "host/touch/cells/simd_rows.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Floats = RowFloats;
using FloatV = RowV;

HWY_INLINE FloatV dotted(FloatV x, FloatV y, FloatV z, const shader::VoxelPoint& at) {
    const Floats d;
    return hn::Add(hn::Add(hn::Mul(x, hn::Set(d, at.x)), hn::Mul(y, hn::Set(d, at.y))), hn::Mul(z, hn::Set(d, at.z)));
}

/// From normals of any length; `second` and `third` are the triangle's corners, the first is at 0.
void setShadows(TriangleAxes& axes, const shader::VoxelPoint& second, const shader::VoxelPoint& third) {
    constexpr float kShortest = 1e-12F;
    const Floats d;
    const FloatV half = hn::Set(d, 0.5F);
    for (std::size_t i = 0; i < TriangleAxes::kCount; i += hn::Lanes(d)) {
        FloatV x = hn::LoadU(d, axes.x.data() + i);
        FloatV y = hn::LoadU(d, axes.y.data() + i);
        FloatV z = hn::LoadU(d, axes.z.data() + i);
        const FloatV size = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
        const FloatV scale = hn::Div(hn::Set(d, 1.0F), hn::Max(size, hn::Set(d, kShortest)));
        x = hn::Mul(x, scale);
        y = hn::Mul(y, scale);
        z = hn::Mul(z, scale);
        const FloatV atSecond = dotted(x, y, z, second);
        const FloatV atThird = dotted(x, y, z, third);
        const FloatV zero = hn::Zero(d);
        hn::StoreU(x, d, axes.x.data() + i);
        hn::StoreU(y, d, axes.y.data() + i);
        hn::StoreU(z, d, axes.z.data() + i);
        hn::StoreU(hn::Sub(hn::Min(zero, hn::Min(atSecond, atThird)), half), d, axes.lo.data() + i);
        hn::StoreU(hn::Add(hn::Max(zero, hn::Max(atSecond, atThird)), half), d, axes.hi.data() + i);
    }
}

/// Depth of `at` inside the projection, along an axis.
HWY_INLINE FloatV insideOf(FloatV at, FloatV lo, FloatV hi) {
    return hn::Min(hn::Sub(at, lo), hn::Sub(hi, at));
}

/// The cells of a cube, by their numbers: from the first one's middle to theirs.
struct Places {
    FloatV x;
    FloatV y;
    FloatV z;
};

HWY_INLINE Places placesOf(const std::int32_t* numbers, const shader::VoxelPoint& from) {
    static_assert(TriangleCells::kSide == 4);
    const Floats d;
    const hn::RebindToSigned<Floats> whole;
    const auto number = hn::LoadU(whole, numbers);
    const auto last = hn::Set(whole, TriangleCells::kSide - 1);
    return {hn::Add(hn::Set(d, from.x), hn::ConvertTo(d, hn::And(number, last))),
            hn::Add(hn::Set(d, from.y), hn::ConvertTo(d, hn::And(hn::ShiftRight<2>(number), last))),
            hn::Add(hn::Set(d, from.z), hn::ConvertTo(d, hn::ShiftRight<4>(number)))};
}

HWY_INLINE FloatV insideAlong(const TriangleAxes& axes, std::size_t axis, const Places& at) {
    const Floats d;
    const FloatV place =
        hn::Add(hn::Add(hn::Mul(hn::Set(d, axes.x[axis]), at.x), hn::Mul(hn::Set(d, axes.y[axis]), at.y)),
                hn::Mul(hn::Set(d, axes.z[axis]), at.z));
    return insideOf(place, hn::Set(d, axes.lo[axis]), hn::Set(d, axes.hi[axis]));
}

/// One bit per lane, lowest first.
struct LaneBits {
    unsigned some = 0;
    unsigned none = 0;
};

HWY_INLINE LaneBits overlapOf(const TriangleAxes& axes, const Places& at) {
    const Floats d;
    const FloatV margin = hn::Set(d, axes.margin);
    const FloatV slack = hn::Set(d, axes.slack);
    const FloatV inPlane = insideAlong(axes, TriangleAxes::kNormal, at);
    const FloatV outermost = hn::Neg(margin);
    FloatV inside = hn::Set(d, std::numeric_limits<float>::infinity());
    for (std::size_t axis = TriangleAxes::kNormal + 1; axis < TriangleAxes::kUsed; ++axis) {
        inside = hn::Min(inside, insideAlong(axes, axis, at));
    }
    return {bitsOf(hn::Gt(hn::Min(inside, hn::Sub(inPlane, slack)), margin)),
            bitsOf(hn::Lt(hn::Min(inside, hn::Add(inPlane, slack)), outermost))};
}

/// `from`: the middle of the first cell.
TriangleCells::Overlap overlapsOf(const TriangleAxes& axes, TriangleCells::Bits cells, const shader::VoxelPoint& from) {
    const Floats d;
    std::int32_t numbers[64] = {};
    std::size_t count = 0;
    for (; cells != 0; cells &= cells - 1) {
        numbers[count++] = std::countr_zero(cells);
    }
    TriangleCells::Overlap overlap;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const LaneBits bits = overlapOf(axes, placesOf(numbers + i, from));
        for (std::size_t lane = 0; lane < hn::Lanes(d) && i + lane < count; ++lane) {
            overlap.some |= TriangleCells::Bits{bits.some >> lane & 1U} << static_cast<unsigned>(numbers[i + lane]);
            overlap.none |= TriangleCells::Bits{bits.none >> lane & 1U} << static_cast<unsigned>(numbers[i + lane]);
        }
    }
    return overlap;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(setShadows);
HWY_EXPORT(overlapsOf);

namespace {

using shader::VoxelPoint;

/// Normals may have any length.
void setNormals(const std::array<VoxelPoint, 3>& edges, const VoxelPoint& normal, TriangleAxes& axes) {
    constexpr std::size_t kBox = TriangleAxes::kNormal + 1;
    constexpr std::size_t kEdges = kBox + 3;
    axes.x[TriangleAxes::kNormal] = normal.x;
    axes.y[TriangleAxes::kNormal] = normal.y;
    axes.z[TriangleAxes::kNormal] = normal.z;
    axes.x[kBox] = 1;
    axes.y[kBox + 1] = 1;
    axes.z[kBox + 2] = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const VoxelPoint& edge = edges[i];
        const std::size_t first = kEdges + 3 * i;
        axes.y[first] = -edge.z; // across x
        axes.z[first] = edge.y;
        axes.x[first + 1] = edge.z; // across y
        axes.z[first + 1] = -edge.x;
        axes.x[first + 2] = -edge.y; // across z
        axes.y[first + 2] = edge.x;
    }
    static_assert(kEdges + 3 * 3 == TriangleAxes::kUsed);
}

} // namespace

TriangleCells::TriangleCells(const shader::CertifiedTriangle& triangle) noexcept : corner_(triangle.corner0) {
    const VoxelPoint second = shader::voxelDifference(triangle.corner1, corner_);
    const VoxelPoint third = shader::voxelDifference(triangle.corner2, corner_);
    const VoxelPoint& normal = triangle.normal;
    setNormals({second, shader::voxelDifference(third, second), third}, normal, axes_);
    HWY_DYNAMIC_DISPATCH(setShadows)(axes_, second, third);
    axes_.margin = shader::certifiedOverlapMargin(triangle.delta);
    // Same as in certifiedPlaneMisses().
    const float size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    const float cube = triangle.reach * triangle.reach * (triangle.reach + static_cast<float>(2 * kBrickSide));
    axes_.slack = size > 0 ? cube * CERTIFIED_CLIP_ERROR / size : std::numeric_limits<float>::infinity();
}

TriangleCells::Overlap TriangleCells::of(Bits cells, const std::array<std::int32_t, 3>& first) const noexcept {
    const VoxelPoint middle{static_cast<float>(first[0]) + 0.5F, static_cast<float>(first[1]) + 0.5F,
                            static_cast<float>(first[2]) + 0.5F};
    return HWY_DYNAMIC_DISPATCH(overlapsOf)(axes_, cells, shader::voxelDifference(middle, corner_));
}

} // namespace voxtact::cpu
#endif

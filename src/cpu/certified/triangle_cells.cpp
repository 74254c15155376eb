// SPDX-License-Identifier: MIT
#include "cpu/certified/triangle_cells.h"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/certified/triangle_cells.cpp"
#include <hwy/foreach_target.h>

#include "cpu/certified/simd_rows.h"

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

/// From normals of any length; `second` and `third` are the triangle's corners, the first being at 0.
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

/// How far inside the shadow what is at `at` on an axis is.
HWY_INLINE FloatV insideOf(FloatV at, FloatV lo, FloatV hi) {
    return hn::Min(hn::Sub(at, lo), hn::Sub(hi, at));
}

/// On the axes that are the same for all of a row: the least.
HWY_INLINE float insideStill(const TriangleAxes& axes, const shader::VoxelPoint& from) {
    const Floats d;
    FloatV least = hn::Set(d, std::numeric_limits<float>::infinity());
    for (std::size_t i = TriangleAxes::kStill; i < TriangleAxes::kCount; i += hn::Lanes(d)) {
        const FloatV at = dotted(hn::LoadU(d, axes.x.data() + i), hn::LoadU(d, axes.y.data() + i),
                                 hn::LoadU(d, axes.z.data() + i), from);
        least = hn::Min(least, insideOf(at, hn::LoadU(d, axes.lo.data() + i), hn::LoadU(d, axes.hi.data() + i)));
    }
    return hn::GetLane(hn::MinOfLanes(d, least));
}

/// Of some cells of a row on one axis; `cells` are their numbers.
HWY_INLINE FloatV insideAlong(const TriangleAxes& axes, std::size_t axis, const shader::VoxelPoint& from,
                              FloatV cells) {
    const Floats d;
    const float first = axes.x[axis] * from.x + axes.y[axis] * from.y + axes.z[axis] * from.z;
    const FloatV at = hn::Add(hn::Set(d, first), hn::Mul(cells, hn::Set(d, axes.x[axis])));
    return insideOf(at, hn::Set(d, axes.lo[axis]), hn::Set(d, axes.hi[axis]));
}

/// `from`: the middle of the first cell.
TriangleCells::Row rowOf(const TriangleAxes& axes, const shader::VoxelPoint& from) {
    const float still = insideStill(axes, from);
    if (still < -TriangleCells::kMargin) {
        return {0, (1U << TriangleCells::kRow) - 1};
    }
    const Floats d;
    const FloatV margin = hn::Set(d, TriangleCells::kMargin);
    const FloatV slack = hn::Set(d, axes.slack);
    TriangleCells::Row row;
    for (std::size_t cell = 0; cell < TriangleCells::kRow; cell += hn::Lanes(d)) {
        const FloatV cells = hn::Iota(d, static_cast<float>(cell));
        FloatV inside = hn::Set(d, still);
        for (std::size_t axis = 0; axis < TriangleAxes::kAlong; ++axis) {
            inside = hn::Min(inside, insideAlong(axes, axis, from, cells));
        }
        const FloatV inPlane = insideAlong(axes, TriangleAxes::kNormal, from, cells);
        const FloatV surely = hn::Min(inside, hn::Sub(inPlane, slack));
        const FloatV perhaps = hn::Min(inside, hn::Add(inPlane, slack));
        row.some |= bitsOf(hn::Gt(surely, margin)) << cell;
        row.none |= bitsOf(hn::Lt(perhaps, hn::Neg(margin))) << cell;
    }
    return row;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(setShadows);
HWY_EXPORT(rowOf);

namespace {

using shader::VoxelPoint;

/// Of any length.
void setNormals(const std::array<VoxelPoint, 3>& edges, const VoxelPoint& normal, TriangleAxes& axes) {
    for (std::size_t i = 0; i < 3; ++i) {
        const VoxelPoint& edge = edges[i];
        axes.x[2 * i] = edge.z; // across y
        axes.z[2 * i] = -edge.x;
        axes.x[2 * i + 1] = -edge.y; // across z
        axes.y[2 * i + 1] = edge.x;
        axes.y[TriangleAxes::kStill + i] = -edge.z; // across x
        axes.z[TriangleAxes::kStill + i] = edge.y;
    }
    axes.x[6] = 1;
    axes.y[TriangleAxes::kStill + 3] = 1;
    axes.z[TriangleAxes::kStill + 4] = 1;
    axes.x[TriangleAxes::kNormal] = normal.x;
    axes.y[TriangleAxes::kNormal] = normal.y;
    axes.z[TriangleAxes::kNormal] = normal.z;
}

} // namespace

TriangleCells::TriangleCells(const shader::CertifiedTriangle& triangle) noexcept : corner_(triangle.corner0) {
    const VoxelPoint second = shader::voxelDifference(triangle.corner1, corner_);
    const VoxelPoint third = shader::voxelDifference(triangle.corner2, corner_);
    const VoxelPoint& normal = triangle.normal;
    setNormals({second, shader::voxelDifference(third, second), third}, normal, axes_);
    HWY_DYNAMIC_DISPATCH(setShadows)(axes_, second, third);
    // As certifiedPlaneMisses() has it.
    const float size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    const float cube = triangle.reach * triangle.reach * (triangle.reach + static_cast<float>(2 * kRow));
    axes_.slack = size > 0 ? cube * CERTIFIED_CLIP_ERROR / size : std::numeric_limits<float>::infinity();
}

TriangleCells::Row TriangleCells::row(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
    const VoxelPoint middle{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, static_cast<float>(z) + 0.5F};
    return HWY_DYNAMIC_DISPATCH(rowOf)(axes_, shader::voxelDifference(middle, corner_));
}

} // namespace voxtact::cpu
#endif

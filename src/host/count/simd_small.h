// SPDX-License-Identifier: MIT
// Small triangles, one a lane: boxes, edge functions in 32 bits, and the fragments of a vector of triangles shaded in
// full vectors.
#if defined(VOXTACT_CPU_SIMD_SMALL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_SMALL_H
#undef VOXTACT_CPU_SIMD_SMALL_H
#else
#define VOXTACT_CPU_SIMD_SMALL_H
#endif

#include "host/count/simd_sample.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {

using IntM = hn::Mask<Ints>;

/// The pixels whose centre may be covered, inclusive: exactSetUp()'s minX to maxY.
struct PixelBox {
    IntV minX, minY, maxX, maxY;
};

struct Corners {
    IntV x[3];
    IntV y[3];
};

HWY_INLINE IntV least(const IntV (&v)[3]) {
    return hn::Min(hn::Min(v[0], v[1]), v[2]);
}
HWY_INLINE IntV most(const IntV (&v)[3]) {
    return hn::Max(hn::Max(v[0], v[1]), v[2]);
}

HWY_INLINE PixelBox pixelBox(const ViewFacts& view, const Corners& corners) {
    const Ints ints;
    const IntV zero = hn::Zero(ints);
    const IntV up = hn::Set(ints, 127);
    const IntV half = hn::Set(ints, 128);
    return {hn::Max(hn::ShiftRight<8>(hn::Add(least(corners.x), up)), zero),
            hn::Max(hn::ShiftRight<8>(hn::Add(least(corners.y), up)), zero),
            hn::Min(hn::ShiftRight<8>(hn::Sub(most(corners.x), half)), hn::Set(ints, view.width - 1)),
            hn::Min(hn::ShiftRight<8>(hn::Sub(most(corners.y), half)), hn::Set(ints, view.height - 1))};
}

/// An edge function: its value at the first pixel, its steps, and its bias (0 or -1).
struct Edge {
    IntV value, stepX, stepY, bias;
};

HWY_INLINE Edge edgeOf(IntV ax, IntV ay, IntV bx, IntV by, IntV px, IntV py) {
    const Ints ints;
    const IntV zero = hn::Zero(ints);
    const IntV dx = hn::Sub(bx, ax);
    const IntV dy = hn::Sub(by, ay);
    const IntV value = hn::Sub(hn::Mul(dx, hn::Sub(py, ay)), hn::Mul(dy, hn::Sub(px, ax)));
    const IntM covers = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
    return {value, hn::ShiftLeft<8>(hn::Neg(dy)), hn::ShiftLeft<8>(dx),
            hn::IfThenElse(covers, zero, hn::Set(ints, -1))};
}

/// A vector of triangles after set-up; edges as exactFragment() numbers them.
struct SmallTriangles {
    Edge edge[3];
    IntV lastX, lastY; ///< columns and rows less one; negative: none
    IntV vertex[3];
    FloatV rcpArea;
};

HWY_INLINE SmallTriangles setUp(const ViewFacts& view, const PendingTriangles& pending, IntM valid) {
    const Floats d;
    const Ints ints;
    Corners corners;
    SmallTriangles out;
    for (std::size_t i = 0; i < 3; ++i) {
        corners.x[i] = hn::LoadU(ints, pending.x[i]);
        corners.y[i] = hn::LoadU(ints, pending.y[i]);
        out.vertex[i] = hn::LoadU(ints, pending.vertex[i]);
    }
    const PixelBox box = pixelBox(view, corners);
    const IntV area = hn::Sub(hn::Mul(hn::Sub(corners.x[1], corners.x[0]), hn::Sub(corners.y[2], corners.y[0])),
                              hn::Mul(hn::Sub(corners.y[1], corners.y[0]), hn::Sub(corners.x[2], corners.x[0])));
    const IntM turned = hn::Lt(area, hn::Zero(ints));
    const auto swap = [&](IntV& a, IntV& b) {
        const IntV kept = a;
        a = hn::IfThenElse(turned, b, a);
        b = hn::IfThenElse(turned, kept, b);
    };
    swap(corners.x[1], corners.x[2]);
    swap(corners.y[1], corners.y[2]);
    swap(out.vertex[1], out.vertex[2]);
    out.rcpArea = reciprocal(d, hn::ConvertTo(d, hn::Abs(area)));
    const IntV px = hn::Add(hn::ShiftLeft<8>(box.minX), hn::Set(ints, 128));
    const IntV py = hn::Add(hn::ShiftLeft<8>(box.minY), hn::Set(ints, 128));
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t a = (i + 1) % 3;
        const std::size_t b = (i + 2) % 3;
        out.edge[i] = edgeOf(corners.x[a], corners.y[a], corners.x[b], corners.y[b], px, py);
    }
    const IntV nothing = hn::Set(ints, -1);
    valid = hn::AndNot(hn::Eq(area, hn::Zero(ints)), valid);
    out.lastX = hn::IfThenElse(valid, hn::Sub(box.maxX, box.minX), nothing);
    out.lastY = hn::IfThenElse(valid, hn::Sub(box.maxY, box.minY), nothing);
    return out;
}

/// Calls `covered(column, row, mask)` for every place in the boxes that some triangle covers.
template <class Covered> HWY_INLINE void forCovered(const SmallTriangles& triangles, Covered&& covered) {
    const Ints ints;
    const IntV outside = hn::Set(ints, -1);
    const std::int32_t columns = hn::GetLane(hn::MaxOfLanes(ints, triangles.lastX));
    const std::int32_t rows = hn::GetLane(hn::MaxOfLanes(ints, triangles.lastY));
    IntV row0 = hn::Add(triangles.edge[0].value, triangles.edge[0].bias);
    IntV row1 = hn::Add(triangles.edge[1].value, triangles.edge[1].bias);
    IntV row2 = hn::Add(triangles.edge[2].value, triangles.edge[2].bias);
    for (std::int32_t y = 0; y <= rows; ++y) {
        const IntM inRow = hn::Gt(triangles.lastY, hn::Set(ints, y - 1));
        IntV at0 = row0;
        IntV at1 = row1;
        IntV at2 = row2;
        for (std::int32_t x = 0; x <= columns; ++x) {
            const IntM inside = hn::Gt(hn::Or(hn::Or(at0, at1), at2), outside);
            const IntM mask = hn::And(hn::And(inside, inRow), hn::Gt(triangles.lastX, hn::Set(ints, x - 1)));
            covered(x, y, mask);
            at0 = hn::Add(at0, triangles.edge[0].stepX);
            at1 = hn::Add(at1, triangles.edge[1].stepX);
            at2 = hn::Add(at2, triangles.edge[2].stepX);
        }
        row0 = hn::Add(row0, triangles.edge[0].stepY);
        row1 = hn::Add(row1, triangles.edge[1].stepY);
        row2 = hn::Add(row2, triangles.edge[2].stepY);
    }
}

/// Inputs of the interpolation in exactFragment(), one triangle per lane.
struct Planes {
    FloatV q0, q1q0, q2q0;
    FloatV t[3], u[3], v[3];
    FloatV affine; ///< bits set where all w are 1
};

HWY_INLINE Planes planesOf(const PairJob& job, const SmallTriangles& triangles, const VertexLanes& vertices) {
    const Floats d;
    const Ints ints;
    Planes out;
    const float* coordinates[3] = {vertices.tx, vertices.ty, vertices.tz};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.t[axis] = hn::GatherIndex(d, coordinates[axis], triangles.vertex[0]);
        out.u[axis] = hn::Sub(hn::GatherIndex(d, coordinates[axis], triangles.vertex[1]), out.t[axis]);
        out.v[axis] = hn::Sub(hn::GatherIndex(d, coordinates[axis], triangles.vertex[2]), out.t[axis]);
    }
    out.q0 = out.q1q0 = out.q2q0 = out.affine = hn::Zero(d);
    if (!job.orthographic) {
        out.q0 = hn::GatherIndex(d, vertices.q, triangles.vertex[0]);
        out.q1q0 = hn::Sub(hn::GatherIndex(d, vertices.q, triangles.vertex[1]), out.q0);
        out.q2q0 = hn::Sub(hn::GatherIndex(d, vertices.q, triangles.vertex[2]), out.q0);
        const IntV state = hn::Or(hn::Or(hn::GatherIndex(ints, vertices.state, triangles.vertex[0]),
                                         hn::GatherIndex(ints, vertices.state, triangles.vertex[1])),
                                  hn::GatherIndex(ints, vertices.state, triangles.vertex[2]));
        const IntM affine = hn::Eq(hn::And(state, hn::Set(ints, kNotAffine)), hn::Zero(ints));
        out.affine = hn::BitCast(d, hn::VecFromMask(ints, affine));
    }
    return out;
}

/// Shades the listed fragments; returns the number of passing ones.
template <class Kept>
HWY_INLINE std::size_t shadeFragments(const PairJob& job, const Sampler<Kept>& sampler, const SmallTriangles& triangles,
                                      const Planes& planes, const std::int32_t* fragments, std::size_t count) {
    const Floats d;
    const Ints ints;
    const IntV low = hn::Set(ints, kSmallPixels - 1);
    std::size_t survivors = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const IntV fragment = hn::LoadU(ints, fragments + i);
        const auto lane = hn::IndicesFromVec(d, hn::And(fragment, low));
        const auto intLane = hn::IndicesFromVec(ints, hn::And(fragment, low));
        const IntV column = hn::And(hn::ShiftRight<4>(fragment), low);
        const IntV row = hn::ShiftRight<8>(fragment);
        const auto of = [&](FloatV v) { return hn::TableLookupLanes(v, lane); };
        const auto weight = [&](const Edge& edge) {
            const IntV value = hn::TableLookupLanes(edge.value, intLane);
            const IntV stepX = hn::TableLookupLanes(edge.stepX, intLane);
            const IntV stepY = hn::TableLookupLanes(edge.stepY, intLane);
            const IntV at = hn::Add(value, hn::Add(hn::Mul(column, stepX), hn::Mul(row, stepY)));
            return hn::Mul(hn::ConvertTo(d, at), of(triangles.rcpArea));
        };
        const FloatV weight1 = weight(triangles.edge[1]);
        const FloatV weight2 = weight(triangles.edge[2]);
        FloatV t[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            t[axis] = planeAt(of(planes.t[axis]), of(planes.u[axis]), of(planes.v[axis]), weight1, weight2);
        }
        if (!job.orthographic) {
            const FloatV q = planeAt(of(planes.q0), of(planes.q1q0), of(planes.q2q0), weight1, weight2);
            const FloatM affine = hn::MaskFromVec(of(planes.affine));
            const FloatV w = hn::IfThenElse(affine, hn::Set(d, 1.0F), reciprocal(d, q));
            for (FloatV& coordinate : t) {
                coordinate = hn::Mul(coordinate, w);
            }
        }
        const FloatM live = hn::FirstN(d, count - i);
        survivors += sampler.survivors(t[0], t[1], t[2], live);
    }
    return survivors;
}

/// Rasterises the first vector of the pending triangles.
template <class Kept>
HWY_INLINE std::size_t rasteriseSmall(const PairJob& job, const Sampler<Kept>& sampler, bool certain,
                                      Scratch& scratch) {
    const Ints ints;
    const SmallTriangles triangles = setUp(job.view, scratch.pending, hn::FirstN(ints, scratch.pending.count));
    std::size_t count = 0;
    if (certain) {
        forCovered(triangles, [&](std::int32_t, std::int32_t, IntM mask) { count += hn::CountTrue(ints, mask); });
        return count;
    }
    const IntV lanes = hn::Iota(ints, 0);
    std::int32_t* fragments = scratch.fragments;
    forCovered(triangles, [&](std::int32_t x, std::int32_t y, IntM mask) {
        const IntV ids = hn::Or(lanes, hn::Set(ints, x << 4 | y << 8));
        hn::StoreU(hn::Compress(ids, mask), ints, fragments + count);
        count += hn::CountTrue(ints, mask);
    });
    if (count == 0) {
        return 0;
    }
    // Lanes beyond the last fragment must name lanes, too.
    hn::StoreU(hn::Zero(ints), ints, fragments + count);
    return shadeFragments(job, sampler, triangles, planesOf(job, triangles, scratch.vertices), fragments, count);
}

/// Drops the first vector of the pending triangles.
HWY_INLINE void dropPending(PendingTriangles& pending) {
    const Ints ints;
    const std::size_t lanes = hn::Lanes(ints);
    const auto move = [&](std::int32_t* values) { hn::StoreU(hn::LoadU(ints, values + lanes), ints, values); };
    for (std::size_t i = 0; i < 3; ++i) {
        move(pending.x[i]);
        move(pending.y[i]);
        move(pending.vertex[i]);
    }
    pending.count = pending.count > lanes ? pending.count - lanes : 0;
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif

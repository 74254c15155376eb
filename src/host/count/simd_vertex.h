// SPDX-License-Identifier: MIT
// The vertex stage: exactVertex(), exactInside(), and the vertex's part of exactBeyond() and exactSetUp().
#if defined(VOXTACT_CPU_SIMD_VERTEX_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_VERTEX_H
#undef VOXTACT_CPU_SIMD_VERTEX_H
#else
#define VOXTACT_CPU_SIMD_VERTEX_H
#endif

#include "host/count/simd_base.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {

/// exactDot()
HWY_INLINE FloatV dot(const shader::vec4& row, FloatV x, FloatV y, FloatV z) {
    const Floats d;
    const FloatV ab = hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y));
    return hn::Add(hn::Add(ab, hn::Mul(hn::Set(d, row[2]), z)), hn::Set(d, row[3]));
}

/// exactSubpixel(); 0 where a vertex is not `usable`.
HWY_INLINE IntV subpixel(FloatV clip, FloatV q, float scale, hn::Mask<Floats> usable) {
    const Floats d;
    const FloatV scales = hn::Set(d, scale);
    const FloatV placed = hn::Add(hn::Mul(hn::Mul(clip, q), scales), scales);
    const FloatV rounded = hn::Floor(hn::Add(placed, hn::Set(d, 0.5F)));
    return hn::ConvertTo(Ints(), hn::IfThenElseZero(usable, rounded));
}

/// The bits of a VertexState for necessary clipping.
HWY_INLINE IntV outsideBits(const ViewFacts& view, FloatV x, FloatV y, FloatV z, FloatV w) {
    const Floats d;
    const Ints ints;
    const FloatV zero = hn::Zero(d);
    const FloatV edgeX = hn::Mul(hn::Set(d, view.guardX), w);
    const FloatV edgeY = hn::Mul(hn::Set(d, view.guardY), w);
    const auto bit = [&](FloatV distance, std::int32_t plane) {
        const auto inside = hn::RebindMask(ints, hn::Ge(distance, zero));
        return hn::IfThenElse(inside, hn::Zero(ints), hn::Set(ints, plane));
    };
    const IntV depth = hn::Or(bit(z, 1), bit(hn::Sub(w, z), 2));
    const IntV sides = hn::Or(bit(hn::Add(edgeX, x), 4), bit(hn::Sub(edgeX, x), 8));
    return hn::Or(hn::Or(depth, sides), hn::Or(bit(hn::Add(edgeY, y), 16), bit(hn::Sub(edgeY, y), 32)));
}

/// The bits of a VertexState for the side of the image beyond which a vertex is: exactBeyond().
HWY_INLINE IntV beyondBits(const FloatV (&t)[3]) {
    const Floats d;
    const Ints ints;
    const FloatV lo = hn::Set(d, -EXACT_BEYOND);
    const FloatV hi = hn::Set(d, 1.0F + EXACT_BEYOND);
    IntV bits = hn::Zero(ints);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto bit = [&](auto mask, std::int32_t first) {
            return hn::IfThenElseZero(hn::RebindMask(ints, mask), hn::Set(ints, first << (2 * axis)));
        };
        bits = hn::Or(bits, hn::Or(bit(hn::Lt(t[axis], lo), 0x100), bit(hn::Gt(t[axis], hi), 0x200)));
    }
    return bits;
}

struct ClipW {
    FloatV w, q;
    IntV state;
};

HWY_INLINE ClipW clipW(const PairJob& job, FloatV x, FloatV y, FloatV z) {
    const Floats d;
    const Ints ints;
    const FloatV one = hn::Set(d, 1.0F);
    if (job.orthographic) {
        return {one, one, hn::Zero(ints)};
    }
    const FloatV w = dot(job.transform.clip_from_object[3], x, y, z);
    const auto isOne = hn::Eq(w, one);
    const auto usable = hn::And(hn::Ge(w, hn::Set(d, 1e-30F)), hn::Le(w, hn::Set(d, 1e30F)));
    const FloatV q = hn::IfThenElse(isOne, one, reciprocal(d, w));
    const IntV state = hn::Or(hn::IfThenElse(hn::RebindMask(ints, isOne), hn::Zero(ints), hn::Set(ints, kNotAffine)),
                              hn::IfThenElse(hn::RebindMask(ints, usable), hn::Zero(ints), hn::Set(ints, kBadW)));
    return {w, q, state};
}

/// Transforms a cluster's vertices to `at` of the scratch's vertices; returns all their states together. A cluster
/// that is certain to be opaque needs no texture coordinates.
HWY_INLINE std::int32_t transformVertices(const PairJob& job, const ClusterPlace& place, bool textured, std::size_t at,
                                          VertexLanes& out) {
    const Floats d;
    const Ints ints;
    const shader::PairTransform& transform = job.transform;
    IntV states = hn::Zero(ints);
    for (std::size_t i = 0; i < place.vertexCount; i += hn::Lanes(d)) {
        const FloatV x = hn::LoadU(d, job.mesh.x.data() + place.firstVertex + i);
        const FloatV y = hn::LoadU(d, job.mesh.y.data() + place.firstVertex + i);
        const FloatV z = hn::LoadU(d, job.mesh.z.data() + place.firstVertex + i);
        const ClipW clip = clipW(job, x, y, z);
        const FloatV clipX = dot(transform.clip_from_object[0], x, y, z);
        const FloatV clipY = dot(transform.clip_from_object[1], x, y, z);
        const FloatV clipZ = dot(transform.clip_from_object[2], x, y, z);
        IntV state = hn::Or(clip.state, outsideBits(job.view, clipX, clipY, clipZ, clip.w));
        const auto usable =
            hn::RebindMask(d, hn::Eq(hn::And(state, hn::Set(ints, kOutsideBits | kBadW)), hn::Zero(ints)));
        hn::StoreU(subpixel(clipX, clip.q, job.view.scaleX, usable), ints, out.x + at + i);
        hn::StoreU(subpixel(clipY, clip.q, job.view.scaleY, usable), ints, out.y + at + i);
        if (textured) {
            const FloatV t[3] = {dot(transform.texture_from_object[0], x, y, z),
                                 dot(transform.texture_from_object[1], x, y, z),
                                 dot(transform.texture_from_object[2], x, y, z)};
            if (job.view.rangeTest) {
                state = hn::Or(state, beyondBits(t));
            }
            hn::StoreU(clip.q, d, out.q + at + i);
            hn::StoreU(hn::Mul(t[0], clip.q), d, out.tx + at + i);
            hn::StoreU(hn::Mul(t[1], clip.q), d, out.ty + at + i);
            hn::StoreU(hn::Mul(t[2], clip.q), d, out.tz + at + i);
        }
        hn::StoreU(state, ints, out.state + at + i);
        states = hn::Or(states, state);
    }
    HWY_ALIGN std::int32_t lanes[kMaxLanes] = {};
    hn::Store(states, ints, lanes);
    std::int32_t all = 0;
    for (const std::int32_t lane : lanes) {
        all |= lane;
    }
    return all;
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif

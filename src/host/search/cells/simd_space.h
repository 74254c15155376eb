// SPDX-License-Identifier: MIT
// Points, triangles and distances as vectors of doubles, for one target. No operation of it depends on the target, and
// none is fused: all give the same numbers.
#if defined(VOXTACT_CPU_SIMD_SPACE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_SPACE_H
#undef VOXTACT_CPU_SIMD_SPACE_H
#else
#define VOXTACT_CPU_SIMD_SPACE_H
#endif

#include "host/search/found.h"
#include "host/search/placed.h"

#include <glm/mat3x3.hpp>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kMostDoubles>;
using DoubleV = hn::Vec<Doubles>;
using DoubleM = hn::Mask<Doubles>;

HWY_INLINE DoubleV all(double value) {
    return hn::Set(Doubles(), value);
}

/// Bit i for lane i.
HWY_INLINE unsigned bitsOf(DoubleM mask) {
    std::uint8_t bits[8] = {}; // as many as StoreMaskBits() may write
    hn::StoreMaskBits(Doubles(), mask, bits);
    return bits[0];
}

HWY_INLINE DoubleM maskOf(unsigned bits) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits)};
    return hn::LoadMaskBits(Doubles(), bytes);
}

/// A point or a direction in each lane.
struct PointV {
    DoubleV x, y, z;
};

HWY_INLINE PointV all(const glm::dvec3& v) {
    return {all(v.x), all(v.y), all(v.z)};
}

HWY_INLINE PointV operator+(const PointV& a, const PointV& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE PointV operator-(const PointV& a, const PointV& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE PointV operator*(const PointV& a, const PointV& b) {
    return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

HWY_INLINE PointV operator*(DoubleV a, const PointV& b) {
    return {hn::Mul(a, b.x), hn::Mul(a, b.y), hn::Mul(a, b.z)};
}

HWY_INLINE DoubleV sum(const PointV& a) {
    return hn::Add(hn::Add(a.x, a.y), a.z);
}

HWY_INLINE DoubleV dot(const PointV& a, const PointV& b) {
    return sum(a * b);
}

HWY_INLINE PointV cross(const PointV& a, const PointV& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

HWY_INLINE PointV abs(const PointV& a) {
    return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}

HWY_INLINE PointV choose(DoubleM mask, const PointV& yes, const PointV& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

/// The greater, or `b` where one is not a number: that of processors differ there.
HWY_INLINE DoubleV greater(DoubleV a, DoubleV b) {
    return hn::IfThenElse(hn::Gt(a, b), a, b);
}

HWY_INLINE DoubleV lesser(DoubleV a, DoubleV b) {
    return hn::IfThenElse(hn::Lt(a, b), a, b);
}

HWY_INLINE PointV lesser(const PointV& a, const PointV& b) {
    return {lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z)};
}

HWY_INLINE PointV greater(const PointV& a, const PointV& b) {
    return {greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z)};
}

/// VolumeSpace::toWorld()
HWY_INLINE PointV times(const glm::dmat3& m, const PointV& v) {
    return v.x * all(m[0]) + v.y * all(m[1]) + v.z * all(m[2]);
}

/// A direction in the coordinates that `m` takes to its own.
HWY_INLINE PointV times(const PointV& v, const glm::dmat3& m) {
    return {dot(v, all(m[0])), dot(v, all(m[1])), dot(v, all(m[2]))};
}

struct TriangleV {
    PointV a, b, c;
};

/// PlacedCluster::inverses
struct InverseV {
    DoubleV ab, ac, bc, area;
};

HWY_INLINE InverseV inversesOf(const TriangleV& triangle) {
    const PointV ab = triangle.b - triangle.a;
    const PointV ac = triangle.c - triangle.a;
    const PointV bc = triangle.c - triangle.b;
    const PointV normal = cross(ab, ac);
    const DoubleV one = all(1.0);
    const DoubleV square = dot(normal, normal);
    const DoubleM flat = hn::Gt(square, hn::Mul(all(kNoArea), hn::Mul(dot(ab, ab), dot(ac, ac))));
    return {hn::Div(one, dot(ab, ab)), hn::Div(one, dot(ac, ac)), hn::Div(one, dot(bc, bc)),
            hn::IfThenElseZero(flat, hn::Div(one, square))};
}

/// Reach of the farthest corner along a normal.
HWY_INLINE DoubleV reach(const PointV& normal, const TriangleV& triangle) {
    return greater(greater(dot(normal, triangle.a), dot(normal, triangle.b)), dot(normal, triangle.c));
}

/// Returns the vector from about the closest point of a segment, along `side` from 0, to `to`.
HWY_INLINE PointV offSegment(const PointV& to, const PointV& side, DoubleV inverse) {
    const DoubleV part = hn::Mul(dot(to, side), inverse);
    return to - lesser(greater(part, hn::Zero(Doubles())), all(1.0)) * side;
}

HWY_INLINE PointV shorter(const PointV& a, const PointV& b) {
    return choose(hn::Lt(dot(a, a), dot(b, b)), a, b);
}

/// Returns the vector from about the closest point of a triangle to a point: from its projection on the plane if that
/// is inside, else from the sides.
HWY_INLINE PointV offTriangle(const TriangleV& triangle, const InverseV& inverse, const PointV& point) {
    const DoubleV zero = hn::Zero(Doubles());
    const PointV ab = triangle.b - triangle.a;
    const PointV ac = triangle.c - triangle.a;
    const PointV ap = point - triangle.a;
    const PointV sides = shorter(shorter(offSegment(ap, ab, inverse.ab), offSegment(ap, ac, inverse.ac)),
                                 offSegment(point - triangle.b, triangle.c - triangle.b, inverse.bc));
    const PointV normal = cross(ab, ac);
    const DoubleV toB = hn::Mul(dot(normal, cross(ap, ac)), inverse.area);
    const DoubleV toC = hn::Mul(dot(normal, cross(ab, ap)), inverse.area);
    const DoubleM within = hn::And(hn::And(hn::Ge(toB, zero), hn::Ge(toC, zero)), hn::Le(hn::Add(toB, toC), all(1.0)));
    const DoubleM inside = hn::And(within, hn::Gt(inverse.area, zero));
    return choose(inside, hn::Mul(dot(normal, ap), inverse.area) * normal, sides);
}

/// DistanceError::below()
HWY_INLINE DoubleV below(DoubleV distance, double error) {
    return greater(hn::Sub(hn::Mul(distance, all(1 - DistanceError::kRelative)), all(error)), hn::Zero(Doubles()));
}

/// Lower bound, mm, of the distance along a normal between a set with minimum `least` and one with maximum `reach`; 0
/// if the normal is too short.
HWY_INLINE DoubleV apart(DoubleV least, DoubleV reach, const PointV& normal, double error) {
    constexpr double kLeastSquare = 1e-280;
    const DoubleV square = dot(normal, normal);
    const DoubleV distance = below(hn::Div(hn::Sub(least, reach), hn::Sqrt(square)), error);
    return hn::IfThenElseZero(hn::Gt(square, all(kLeastSquare)), distance);
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif

// SPDX-License-Identifier: MIT
#include "host/search/cells/cluster_culling.h"
#include "core/geometry/clusters.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/search/cells/cluster_culling.cpp"
#include <hwy/foreach_target.h>

#include "host/search/cells/simd_piece.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

using Row = PlacedCluster::Row;

HWY_INLINE PointV pointsAt(const std::array<Row, 3>& rows, std::size_t first) {
    const Doubles d;
    return {hn::Load(d, rows[0].data() + first), hn::Load(d, rows[1].data() + first),
            hn::Load(d, rows[2].data() + first)};
}

HWY_INLINE TriangleV trianglesAt(const PlacedCluster& triangles, std::size_t first) {
    return {pointsAt(triangles.corners[0], first), pointsAt(triangles.corners[1], first),
            pointsAt(triangles.corners[2], first)};
}

HWY_INLINE PointV offTriangles(const PlacedCluster& triangles, std::size_t first, const TriangleV& triangle,
                               const PointV& point) {
    const Doubles d;
    const InverseV inverse{
        hn::Load(d, triangles.inverses[0].data() + first), hn::Load(d, triangles.inverses[1].data() + first),
        hn::Load(d, triangles.inverses[2].data() + first), hn::Load(d, triangles.inverses[3].data() + first)};
    return offTriangle(triangle, inverse, point);
}

/// `bound(first, open)` returns bounds of the triangles from `first` on whose bits in `open` are set.
template <class Bound> HWY_INLINE RemainingTriangles cull(const CullingJob& job, const Bound& bound) {
    const Doubles d;
    const std::size_t lanes = hn::Lanes(d);
    const std::uint64_t group = (std::uint64_t{1} << lanes) - 1;
    const DoubleV cut = all(job.cut);
    RemainingTriangles out;
    DoubleV gone = all(out.leastGone);
    alignas(kRowAlignment) std::array<double, kMostDoubles> bounds;
    for (std::size_t first = 0; first < kClusterTriangles; first += lanes) {
        const auto among = static_cast<unsigned>(job.among >> first & group);
        if (among == 0) {
            continue;
        }
        const DoubleM open = maskOf(among);
        const DoubleV lo = greater(bound(first, open), all(job.lo));
        const DoubleM kept = hn::And(open, hn::Lt(lo, cut));
        gone = lesser(hn::IfThenElse(hn::AndNot(kept, open), lo, gone), gone);
        hn::Store(lo, d, bounds.data());
        const unsigned bits = bitsOf(kept);
        out.kept |= std::uint64_t{bits} << first;
        for (unsigned left = bits; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(left));
            if (bounds[lane] < out.least) {
                out.least = bounds[lane];
                out.nearest = static_cast<std::uint8_t>(first + lane);
            }
        }
    }
    hn::Store(gone, d, bounds.data());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        out.leastGone = bounds[lane] < out.leastGone ? bounds[lane] : out.leastGone;
    }
    return out;
}

HWY_INLINE DoubleV boundAlong(const CullingJob& job, const TriangleV& triangle,
                              std::span<const LeastAlong> directions) {
    DoubleV lo = hn::Zero(Doubles());
    for (const LeastAlong& one : directions) {
        const PointV normal = all(one.normal);
        const DoubleV distance = hn::Mul(hn::Sub(all(one.least), reach(normal, triangle)), all(one.inverse));
        lo = greater(below(distance, job.error), lo);
    }
    return lo;
}

/// Calls `better()` only if a bound does not prune yet: the result of a triangle must not depend on its neighbours in a
/// vector.
template <class Better>
HWY_INLINE DoubleV unlessClosed(const CullingJob& job, DoubleV lo, DoubleM open, const Better& better) {
    const DoubleM left = hn::And(open, hn::Lt(lo, all(job.cut)));
    return hn::AllFalse(Doubles(), left) ? lo : hn::IfThenElse(left, greater(better(), lo), lo);
}

RemainingTriangles cullAlong(const CullingJob& job, std::span<const LeastAlong> directions) {
    return cull(job, [&](std::size_t first, DoubleM /*open*/) {
        return boundAlong(job, trianglesAt(job.triangles, first), directions);
    });
}

RemainingTriangles cullByBox(const CullingJob& job, const VolumeSpace& space, const VoxelBox3& box) {
    const PointV lowest = all(box.lo);
    const PointV highest = all(box.hi);
    const PointV twiceMiddle = all(box.lo + box.hi);
    const PointV sides = all(box.hi - box.lo);
    const PointV middle = all(space.toWorld(0.5 * (box.lo + box.hi)));
    const PointV spacing = all(space.spacing);
    return cull(job, [&](std::size_t first, DoubleM open) {
        const PointV zero = all(glm::dvec3(0));
        const PointV off = spacing * greater(greater(lowest - pointsAt(job.triangles.hi, first),
                                                     pointsAt(job.triangles.lo, first) - highest),
                                             zero);
        const DoubleV gap = below(hn::Sqrt(dot(off, off)), job.error);
        return unlessClosed(job, gap, open, [&] {
            const TriangleV triangle = trianglesAt(job.triangles, first);
            const PointV normal = offTriangles(job.triangles, first, triangle, middle);
            const PointV along = times(normal, space.local_from_voxel);
            const DoubleV least = hn::Mul(all(0.5), hn::Sub(dot(along, twiceMiddle), dot(abs(along), sides)));
            return apart(least, reach(normal, triangle), normal, job.error);
        });
    });
}

RemainingTriangles cullByPiece(const CullingJob& job, const VolumeSpace& space, const PieceBounds& piece,
                               const LeastAlong& direction) {
    const PieceV pieces = all(piece);
    return cull(job, [&](std::size_t first, DoubleM open) {
        const TriangleV triangle = trianglesAt(job.triangles, first);
        const DoubleV lo = boundAlong(job, triangle, {&direction, 1});
        return unlessClosed(job, lo, open, [&] {
            const PointV normal = offTriangles(job.triangles, first, triangle, pieces.middle);
            return apart(leastOf(pieces, space, normal), reach(normal, triangle), normal, job.error);
        });
    });
}

void placeVertices(const PlaceJob& job, const std::array<double*, 3>& local) {
    const Doubles d;
    const hn::Rebind<float, Doubles> floats;
    const auto row = [&](const float* from) { return hn::PromoteTo(d, hn::LoadU(floats, from)); };
    for (std::size_t i = 0; i < job.vertexCount; i += hn::Lanes(d)) {
        const PointV vertex{row(job.vertices[0] + i), row(job.vertices[1] + i), row(job.vertices[2] + i)};
        const PointV at = times(job.local_from_object, vertex) + all(job.origin);
        hn::StoreU(at.x, d, local[0] + i);
        hn::StoreU(at.y, d, local[1] + i);
        hn::StoreU(at.z, d, local[2] + i);
    }
}

HWY_INLINE void store(const PointV& points, std::array<Row, 3>& rows, std::size_t first) {
    const Doubles d;
    hn::Store(points.x, d, rows[0].data() + first);
    hn::Store(points.y, d, rows[1].data() + first);
    hn::Store(points.z, d, rows[2].data() + first);
}

void placeTriangles(const PlaceJob& job, const std::array<const double*, 3>& local, PlacedCluster& triangles) {
    const Doubles d;
    const hn::Rebind<std::int64_t, Doubles> longs;
    const hn::Rebind<std::int32_t, Doubles> ints;
    const hn::Rebind<std::uint8_t, Doubles> bytes;
    for (std::size_t i = 0; i < job.triangleCount; i += hn::Lanes(d)) {
        const auto cornerAt = [&](std::size_t corner) {
            const auto at = hn::PromoteTo(longs, hn::PromoteTo(ints, hn::LoadU(bytes, job.corners[corner] + i)));
            return PointV{hn::GatherIndex(d, local[0], at), hn::GatherIndex(d, local[1], at),
                          hn::GatherIndex(d, local[2], at)};
        };
        const TriangleV triangle{cornerAt(0), cornerAt(1), cornerAt(2)};
        store(triangle.a, triangles.corners[0], i);
        store(triangle.b, triangles.corners[1], i);
        store(triangle.c, triangles.corners[2], i);
        const PointV a = times(job.voxel_from_local, triangle.a);
        const PointV b = times(job.voxel_from_local, triangle.b);
        const PointV c = times(job.voxel_from_local, triangle.c);
        store(lesser(lesser(a, b), c), triangles.lo, i);
        store(greater(greater(a, b), c), triangles.hi, i);
        const InverseV inverse = inversesOf(triangle);
        hn::Store(inverse.ab, d, triangles.inverses[0].data() + i);
        hn::Store(inverse.ac, d, triangles.inverses[1].data() + i);
        hn::Store(inverse.bc, d, triangles.inverses[2].data() + i);
        hn::Store(inverse.area, d, triangles.inverses[3].data() + i);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(cullAlong);
HWY_EXPORT(cullByBox);
HWY_EXPORT(cullByPiece);
HWY_EXPORT(placeVertices);
HWY_EXPORT(placeTriangles);

RemainingTriangles cullAlong(const CullingJob& job, std::span<const LeastAlong> directions) {
    return HWY_DYNAMIC_DISPATCH(cullAlong)(job, directions);
}

RemainingTriangles cullByBox(const CullingJob& job, const VolumeSpace& space, const VoxelBox3& box) {
    return HWY_DYNAMIC_DISPATCH(cullByBox)(job, space, box);
}

RemainingTriangles cullByPiece(const CullingJob& job, const VolumeSpace& space, const PieceBounds& piece,
                               const LeastAlong& direction) {
    return HWY_DYNAMIC_DISPATCH(cullByPiece)(job, space, piece, direction);
}

void placeVertices(const PlaceJob& job, const std::array<double*, 3>& local) {
    HWY_DYNAMIC_DISPATCH(placeVertices)(job, local);
}

void placeTriangles(const PlaceJob& job, const std::array<const double*, 3>& local, PlacedCluster& triangles) {
    HWY_DYNAMIC_DISPATCH(placeTriangles)(job, local, triangles);
}

} // namespace voxtact::cpu
#endif

// SPDX-License-Identifier: MIT
// The projection `certified`: what single precision leaves undecided, placed again. Rounding of a vertex to a float
// of voxel space is what keeps most fragments undecided: a ten-thousandth of a voxel. Here places are sums of two and
// three floats (precise.h), and what is dropped is added up: where nothing was, the place is exact. One text for GLSL
// and C++; every operation is a single-precision addition or multiplication.
#ifndef VOXTACT_CERTIFIED_PRECISE_H
#define VOXTACT_CERTIFIED_PRECISE_H

#include "certified_cell.h"
#include "precise.h"

/// Relative to the largest coordinate, in voxels: bounds the error of a position of two floats after a division, a cut
/// and their sums.
#define PRECISE_PLACE_ERROR 3.637978807091713e-12f
/// Voxels: bounds the error of a position in a cell by rounding to floats, and of its pieces by halving.
#define PRECISE_LEAST_DELTA 9.5367431640625e-7f
#define PRECISE_FACES 6
/// End of the domain in a cell, as in certifiedDomain().
#define CERTIFIED_DOMAIN_END 0.5f

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

// A pair is in GLSL its number among `transforms`, which it expects: what a loop chooses of a pair is read there, while
// all of a pair that is an argument would be copied before an index could choose.
#ifdef __cplusplus
using PairHandle = CertifiedPair;
#define PAIR_OF(pair) pair
#else
#define PairHandle uint
#define PAIR_OF(pair) transforms[pair]
#endif

/// high + middle + low, within `missing` of what was added up.
struct PreciseThree {
    float high, middle, low, missing;
};

EXACT PreciseThree preciseAdded(PreciseThree sum, float term) {
    const PreciseTwo high = preciseSum(sum.high, term);
    const PreciseTwo middle = preciseSum(sum.middle, high.low);
    const PreciseTwo low = preciseSum(sum.low, middle.low);
    PRECISE float missing = sum.missing + certifiedAbs(low.low);
    PreciseThree added;
    added.high = high.high;
    added.middle = middle.high;
    added.low = low.high;
    added.missing = missing;
    return added;
}

/// By its bits: a comparison may flush denormals to zero.
EXACT bool preciseIsZero(float value) {
    return (floatBitsToInt(value) & 0x7fffffff) == 0;
}

EXACT PreciseThree preciseAddedProduct(PreciseThree sum, float a, float b) {
    if (preciseIsZero(a) || preciseIsZero(b)) {
        return sum;
    }
    const PreciseTwo product = preciseProduct(a, b);
    PreciseThree added = preciseAdded(preciseAdded(sum, product.high), product.low);
    if (!(certifiedAbs(product.high) >= PRECISE_LEAST_PRODUCT)) {
        PRECISE float missing = added.missing + 2.0f * PRECISE_LEAST_PRODUCT;
        added.missing = missing;
    }
    return added;
}

/// Separates the parts of the same number: |middle| is at most a unit of `high`; if `high` is zero, all parts are.
EXACT PreciseThree preciseSettled(PreciseThree sum) {
    ROLLED for (int round = 0; round < 3; ++round) {
        const PreciseTwo first = preciseSum(sum.high, sum.middle);
        const PreciseTwo second = preciseSum(first.low, sum.low);
        sum.high = first.high;
        sum.middle = second.high;
        sum.low = second.low;
    }
    return sum;
}

struct PrecisePoint {
    PreciseTwo x, y, z;
};

/// A vertex in voxel space.
struct PreciseVertex {
    PrecisePoint point;
    float error; // voxels, along each axis
    // One bit per face of the domain, 2 * axis for the near end and the next one for the far end: the vertex is
    // certainly in the closed half-space of the domain, in the face itself, beyond the face.
    int inside, on, beyond;
};

/// Millimetres from the near face of the domain, or voxels where the axes of the grid are not those of the world.
EXACT PreciseThree preciseFromFace(PairHandle pair, int axis, VoxelPoint vertex) {
    PreciseThree sum;
    sum.high = PAIR_OF(pair).place[axis][3];
    sum.middle = PAIR_OF(pair).place[3 + axis][3];
    sum.low = PAIR_OF(pair).place[6 + axis][3];
    sum.missing = 0.0f;
    ROLLED for (int part = 0; part < 3; ++part) {
        const vec4 row = PAIR_OF(pair).place[3 * part + axis];
        sum = preciseAddedProduct(sum, row[0], vertex.x);
        sum = preciseAddedProduct(sum, row[1], vertex.y);
        sum = preciseAddedProduct(sum, row[2], vertex.z);
    }
    return preciseSettled(sum);
}

/// Returns the position of a vertex relative to a face; `from` is its distance inside.
EXACT void preciseSide(PreciseThree from, float missing, int face, INOUT(PreciseVertex) vertex) {
    // The parts after `high` are less than half of it.
    PRECISE float least = 0.5f * from.high;
    vertex.inside |= least >= missing ? 1 << face : 0;
    vertex.on |= from.high == 0.0f && missing == 0.0f ? 1 << face : 0;
    vertex.beyond |= -least > missing ? 1 << face : 0;
}

/// Returns a coordinate of a vertex; `known` is the error that its inputs cause.
EXACT PreciseTwo precisePlace(PairHandle pair, CertifiedItem item, int axis, VoxelPoint at, float known,
                              INOUT(PreciseVertex) vertex) {
    const int size = axis == 0 ? item.sizeX : (axis == 1 ? item.sizeY : item.sizeZ);
    const float scale[3] = {item.scale[axis], item.scale[3 + axis], item.scale[6 + axis]};
    const PreciseThree near = preciseFromFace(pair, axis, at);
    PreciseThree far;
    far.high = -near.high;
    far.middle = -near.middle;
    far.low = -near.low;
    far.missing = near.missing;
    ROLLED for (int part = 0; part < 3; ++part) {
        far = preciseAddedProduct(far, scale[part], float(size));
    }
    far = preciseSettled(far);
    PRECISE float missing = near.missing * 1.0001f + known;
    PRECISE float farMissing = far.missing * 1.0001f + known;
    preciseSide(near, missing, 2 * axis, vertex);
    preciseSide(far, farMissing, 2 * axis + 1, vertex);
    const PreciseTwo place = preciseOver(preciseTwo(near.high, near.middle), preciseTwo(scale[0], scale[1]));
    PRECISE float dropped = missing + certifiedAbs(near.low);
    PRECISE float error = dropped * (1.0001f * exactReciprocal(scale[0]));
    vertex.error = error <= CERTIFIED_FARTHEST ? certifiedMax(vertex.error, error) : intBitsToFloat(0x7f800000);
    return precisePlus(place, preciseTwo(-0.5f, 0.0f));
}

EXACT PreciseVertex preciseVertex(PairHandle pair, CertifiedItem item, VoxelPoint at) {
    PreciseVertex vertex;
    vertex.error = 0.0f;
    vertex.inside = 0;
    vertex.on = 0;
    vertex.beyond = 0;
    float known = 0.0f;
    if (PAIR_OF(pair).reference[3] > 0.0f) {
        PRECISE float terms =
            exactDot(PAIR_OF(pair).error, certifiedAbs(at.x - PAIR_OF(pair).reference[0]),
                     certifiedAbs(at.y - PAIR_OF(pair).reference[1]), certifiedAbs(at.z - PAIR_OF(pair).reference[2]));
        known = terms * PAIR_OF(pair).reference[3];
    }
    PreciseTwo place[3];
    ROLLED for (int axis = 0; axis < 3; ++axis) {
        place[axis] = precisePlace(pair, item, axis, at, known, vertex);
    }
    vertex.point.x = place[0];
    vertex.point.y = place[1];
    vertex.point.z = place[2];
    return vertex;
}

/// A triangle in voxel space.
struct PreciseTriangle {
    PrecisePoint a, b, c;
    float error;  // voxels by which it, and cuts of it, may be displaced along each axis
    float delta;  // voxels by which its points in a cell, and pieces of it, may be displaced along each axis, at most
                  // twice; nothing is known of it unless delta <= CERTIFIED_MOST_DELTA
    float far;    // its largest coordinate in voxels, plus two
    int inside;   // of all of it: as in PreciseVertex
    bool outside; // the whole triangle is certainly beyond a face
};

/// Replaces what is beyond a face by a vertex in it where the triangle meets the half-space in vertices that are in the
/// face alone: what is left of it is the part that is in the half-space.
EXACT void preciseFold(int face, INOUT(PreciseVertex) a, INOUT(PreciseVertex) b, INOUT(PreciseVertex) c) {
    const int bit = 1 << face;
    const int either = (a.on | a.beyond) & (b.on | b.beyond) & (c.on | c.beyond) & bit;
    const int some = (a.on | b.on | c.on) & bit;
    if (either == 0 || some == 0) {
        return;
    }
    const PreciseVertex kept = (a.on & bit) != 0 ? a : ((b.on & bit) != 0 ? b : c);
    if ((a.on & bit) == 0) {
        a = kept;
    }
    if ((b.on & bit) == 0) {
        b = kept;
    }
    if ((c.on & bit) == 0) {
        c = kept;
    }
}

EXACT float preciseFarthest(PrecisePoint point) {
    return voxelLength(voxelPoint(point.x.high, point.y.high, point.z.high));
}

EXACT PreciseTriangle preciseTriangle(PairHandle pair, CertifiedItem item, VoxelPoint vertexA, VoxelPoint vertexB,
                                      VoxelPoint vertexC) {
    const VoxelPoint vertices[3] = {vertexA, vertexB, vertexC};
    PreciseVertex placed[3];
    ROLLED for (int i = 0; i < 3; ++i) {
        placed[i] = preciseVertex(pair, item, vertices[i]);
    }
    PreciseVertex a = placed[0];
    PreciseVertex b = placed[1];
    PreciseVertex c = placed[2];
    PreciseTriangle triangle;
    triangle.outside = (a.beyond & b.beyond & c.beyond) != 0;
    ROLLED for (int face = 0; face < PRECISE_FACES; ++face) {
        preciseFold(face, a, b, c);
    }
    triangle.outside = triangle.outside || (a.beyond & b.beyond & c.beyond) != 0;
    triangle.inside = a.inside & b.inside & c.inside;
    triangle.a = a.point;
    triangle.b = b.point;
    triangle.c = c.point;
    PRECISE float far =
        certifiedMax(preciseFarthest(a.point), certifiedMax(preciseFarthest(b.point), preciseFarthest(c.point))) + 2.0f;
    triangle.far = far;
    // Sums: they are not finite where one of them is not.
    PRECISE float errorAB = a.error + b.error;
    PRECISE float error = errorAB + c.error;
    PRECISE float shift = far * PRECISE_PLACE_ERROR;
    PRECISE float place = error + shift;
    PRECISE float delta = place + PRECISE_LEAST_DELTA;
    triangle.error = place;
    triangle.delta = delta;
    return triangle;
}

EXACT bool preciseKnown(PreciseTriangle triangle) {
    return triangle.delta <= CERTIFIED_MOST_DELTA;
}

EXACT PreciseTwo preciseAlong(PrecisePoint point, int axis) {
    return axis == 0 ? point.x : (axis == 1 ? point.y : point.z);
}

EXACT PreciseTwo preciseBetween(PreciseTwo from, PreciseTwo to, PreciseTwo weight) {
    return precisePlus(from, preciseTimes(weight, preciseMinus(to, from)));
}

/// Returns the intersection of a plane and the edge from a corner inside to one outside.
EXACT PrecisePoint preciseCut(PrecisePoint inside, PrecisePoint outside, PreciseTwo distanceInside,
                              PreciseTwo distanceOutside) {
    PreciseTwo weight = preciseOver(distanceInside, preciseMinus(distanceInside, distanceOutside));
    // Unless both are in the plane within rounding: then any point of the edge is right.
    if (!(weight.high >= 0.0f && weight.high <= 1.0f)) {
        weight = preciseTwo(0.0f, 0.0f);
    }
    PrecisePoint cut;
    cut.x = preciseBetween(inside.x, outside.x, weight);
    cut.y = preciseBetween(inside.y, outside.y, weight);
    cut.z = preciseBetween(inside.z, outside.z, weight);
    return cut;
}

/// certifiedInsideBy() of a precise point, plus `beyond`.
EXACT PreciseTwo preciseInsideBy(PrecisePoint point, int axis, float limit, bool above, float beyond) {
    const PreciseTwo past = precisePlus(preciseAlong(point, axis), preciseTwo(-limit, 0.0f));
    return precisePlus(above ? past : preciseTwo(-past.high, -past.low), preciseTwo(beyond, 0.0f));
}

EXACT PrecisePoint preciseRelative(PrecisePoint point, VoxelPoint origin) {
    PrecisePoint relative;
    relative.x = precisePlus(point.x, preciseTwo(-origin.x, 0.0f));
    relative.y = precisePlus(point.y, preciseTwo(-origin.y, 0.0f));
    relative.z = precisePlus(point.z, preciseTwo(-origin.z, 0.0f));
    return relative;
}

/// certifiedClip() of a precise triangle that is known: a little beyond the cell. With `within`, only points that are
/// certainly in the domain remain: a little less.
EXACT int preciseClip(PreciseTriangle triangle, CertifiedCell cell, VoxelPoint origin,
                      bool within HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS)) {
    PrecisePoint corners[2 * CERTIFIED_MAX_CORNERS];
    corners[0] = preciseRelative(triangle.a, origin);
    corners[1] = preciseRelative(triangle.b, origin);
    corners[2] = preciseRelative(triangle.c, origin);
    int first = 0;
    int count = 3;
    ROLLED for (int side = 0; side < PRECISE_FACES && count > 0; ++side) {
        const int axis = side >> 1;
        const bool above = (side & 1) == 0;
        const float end = voxelAlong(above ? cell.lo : cell.hi, axis);
        const bool inwards = within && end == CERTIFIED_DOMAIN_END;
        PRECISE float twice = triangle.error + triangle.error;
        const float beyond = inwards ? -twice : triangle.delta;
        const int left = CERTIFIED_MAX_CORNERS - first;
        int kept = 0;
        PrecisePoint here = corners[first];
        PreciseTwo distanceHere = preciseTwo(0.0f, 0.0f);
        // The first round only computes the distance of the first corner, so that one loop body serves all.
        for (int i = -1; i < count; ++i) {
            const PrecisePoint next = corners[first + (i + 1 < count ? i + 1 : 0)];
            const PreciseTwo distanceNext = preciseInsideBy(next, axis, end, above, beyond);
            const bool insideHere = distanceHere.high >= 0.0f;
            const bool insideNext = distanceNext.high >= 0.0f;
            if (i >= 0 && insideHere && kept < CERTIFIED_MAX_CORNERS) {
                corners[left + kept++] = here;
            }
            if (i >= 0 && insideHere != insideNext && kept < CERTIFIED_MAX_CORNERS) {
                corners[left + kept++] =
                    preciseCut(insideHere ? here : next, insideHere ? next : here,
                               insideHere ? distanceHere : distanceNext, insideHere ? distanceNext : distanceHere);
            }
            here = next;
            distanceHere = distanceNext;
        }
        first = left;
        count = kept;
    }
    UNKNOWN_ROUNDS for (int i = 0; i < count; ++i) {
        const PrecisePoint corner = corners[first + i];
        polygon[i] = voxelPoint(certifiedClamp(corner.x.high, cell.lo.x, cell.hi.x),
                                certifiedClamp(corner.y.high, cell.lo.y, cell.hi.y),
                                certifiedClamp(corner.z.high, cell.lo.z, cell.hi.z));
    }
    return count;
}

/// Returns the cell for a precise triangle: a triangle inside a face needs no distance from it.
EXACT CertifiedCell preciseCell(CertifiedItem item, PreciseTriangle triangle, CertifiedCorners corners, int x, int y,
                                int z) {
    CertifiedCell cell = certifiedCell(item, corners, x, y, z, triangle.delta);
    cell.safeLo.x = (triangle.inside & 1) != 0 ? -1.0f : cell.safeLo.x;
    cell.safeHi.x = (triangle.inside & 2) != 0 ? 2.0f : cell.safeHi.x;
    cell.safeLo.y = (triangle.inside & 4) != 0 ? -1.0f : cell.safeLo.y;
    cell.safeHi.y = (triangle.inside & 8) != 0 ? 2.0f : cell.safeHi.y;
    cell.safeLo.z = (triangle.inside & 16) != 0 ? -1.0f : cell.safeLo.z;
    cell.safeHi.z = (triangle.inside & 32) != 0 ? 2.0f : cell.safeHi.z;
    return cell;
}

/// Returns true if a precise triangle in this cell may leave the domain.
EXACT bool preciseCrosses(CertifiedCell cell) {
    return cell.safeLo.x > -1.0f || cell.safeLo.y > -1.0f || cell.safeLo.z > -1.0f || cell.safeHi.x < 2.0f ||
           cell.safeHi.y < 2.0f || cell.safeHi.z < 2.0f;
}

/// Returns the cell for the part of a precise triangle that is certainly in the domain.
EXACT CertifiedCell preciseWithin(CertifiedCell cell) {
    cell.safeLo = voxelPoint(-1.0f, -1.0f, -1.0f);
    cell.safeHi = voxelPoint(2.0f, 2.0f, 2.0f);
    return cell;
}

/// The plane of a triangle, about the volume's centre: its points q have normal * (q - centre) = offset.
struct PrecisePlane {
    VoxelPoint centre;
    VoxelPoint normal; // of length 2 along an axis at most
    float offset;
    float error; // of the offset
};

EXACT PreciseTwo preciseCross(PreciseTwo uy, PreciseTwo vz, PreciseTwo uz, PreciseTwo vy) {
    return preciseMinus(preciseTimes(uy, vz), preciseTimes(uz, vy));
}

EXACT PreciseTwo preciseScaled(PreciseTwo from, PreciseTwo to, float scale) {
    return preciseTimes(preciseMinus(to, from), preciseTwo(scale, 0.0f));
}

/// Returns the plane of a triangle of known position.
EXACT PrecisePlane precisePlane(CertifiedItem item, PreciseTriangle triangle) {
    const float scale = 0.5f * exactReciprocal(triangle.far);
    const PreciseTwo ux = preciseScaled(triangle.a.x, triangle.b.x, scale);
    const PreciseTwo uy = preciseScaled(triangle.a.y, triangle.b.y, scale);
    const PreciseTwo uz = preciseScaled(triangle.a.z, triangle.b.z, scale);
    const PreciseTwo vx = preciseScaled(triangle.a.x, triangle.c.x, scale);
    const PreciseTwo vy = preciseScaled(triangle.a.y, triangle.c.y, scale);
    const PreciseTwo vz = preciseScaled(triangle.a.z, triangle.c.z, scale);
    const PreciseTwo nx = preciseCross(uy, vz, uz, vy);
    const PreciseTwo ny = preciseCross(uz, vx, ux, vz);
    const PreciseTwo nz = preciseCross(ux, vy, uy, vx);
    PrecisePlane plane;
    plane.centre = voxelPoint(0.5f * float(item.sizeX), 0.5f * float(item.sizeY), 0.5f * float(item.sizeZ));
    plane.normal = voxelPoint(nx.high, ny.high, nz.high);
    const PrecisePoint from = preciseRelative(triangle.a, plane.centre);
    const PreciseTwo offset =
        precisePlus(precisePlus(preciseTimes(nx, from.x), preciseTimes(ny, from.y)), preciseTimes(nz, from.z));
    plane.offset = offset.high;
    // Each component of the normal is off by less than 16 times 2^-45.
    const float farthest = preciseFarthest(from);
    PRECISE float far = triangle.far + farthest;
    PRECISE float error = far * PRECISE_PLACE_ERROR * 4.0f;
    plane.error = error;
    return plane;
}

/// certifiedPlaneMisses(): for cubes that the volume has, or nearly.
EXACT bool precisePlaneMisses(PrecisePlane plane, VoxelPoint centre, float radius) {
    const VoxelPoint from = voxelDifference(centre, plane.centre);
    PRECISE float x = from.x * plane.normal.x;
    PRECISE float y = from.y * plane.normal.y;
    PRECISE float z = from.z * plane.normal.z;
    PRECISE float xy = x + y;
    PRECISE float sum = xy + z;
    PRECISE float distance = sum - plane.offset;
    PRECISE float sizeXY = certifiedAbs(plane.normal.x) + certifiedAbs(plane.normal.y);
    PRECISE float size = sizeXY + certifiedAbs(plane.normal.z);
    PRECISE float reach = radius + CERTIFIED_MOST_DELTA;
    PRECISE float extent = reach * size;
    PRECISE float termsXY = certifiedAbs(x) + certifiedAbs(y);
    PRECISE float terms = termsXY + certifiedAbs(z);
    PRECISE float allTerms = terms + certifiedAbs(plane.offset);
    PRECISE float rounding = allTerms * PRECISE_LEAST_DELTA;
    PRECISE float error = rounding + plane.error;
    PRECISE float most = extent + error;
    return certifiedAbs(distance) > most;
}

#undef PAIR_OF
#undef PairHandle

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif

// SPDX-License-Identifier: MIT
// The projection `certified`: whether a triangle has an opaque point in a voxel cell, decided with bounds. One text
// for GLSL and C++, in the manner of exact.h, so that device and host say the same of every fragment.
//
// Along a triangle the trilinear interpolant of a cell is a polynomial of degree three in the barycentric coordinates:
// it stays within the range of its Bernstein coefficients (Farin, "Triangular Bernstein-Bezier patches", 1986), which
// are means of the interpolant at mixed coordinates of the corners (its polar form, Ramshaw, "Blossoming", 1987).
#ifndef VOXTACT_CERTIFIED_H
#define VOXTACT_CERTIFIED_H

#include "certified_precise.h"

#define CERTIFIED_NONE 0      // the triangle has no opaque point in the cell
#define CERTIFIED_CERTAIN 1   // the triangle has an opaque point in the cell
#define CERTIFIED_UNDECIDED 2 // neither could be shown
/// Bisecting the longest edge halves all of them within three steps: enough for a resolution of 2^-12.
#define CERTIFIED_STACK 48
/// Voxels: minimum size of precisely placed pieces.
#define CERTIFIED_FINE_RESOLUTION 0.0009765625f
/// Maximum pieces of a fragment; then it stays undecided.
#define CERTIFIED_MAX_PIECES 2048

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// A piece of a fragment.
struct CertifiedPiece {
    VoxelPoint a, b, c;
};

/// The interpolant along a piece: at its corners, and the range of its Bernstein coefficients.
struct CertifiedRange {
    float atA, atB, atC;
    float lo, hi;
};

EXACT CertifiedRange certifiedRange(CertifiedCell cell, CertifiedPiece piece) {
    const VoxelPoint points[3] = {piece.a, piece.b, piece.c};
    float mixed[27]; // at x of point i, y of point j, z of point k: [i + 3 * j + 9 * k]
    for (int i = 0; i < 3; ++i) {
        const float v00 = exactLerp(cell.x000, cell.x100, points[i].x);
        const float v10 = exactLerp(cell.x010, cell.x110, points[i].x);
        const float v01 = exactLerp(cell.x001, cell.x101, points[i].x);
        const float v11 = exactLerp(cell.x011, cell.x111, points[i].x);
        for (int j = 0; j < 3; ++j) {
            const float v0 = exactLerp(v00, v10, points[j].y);
            const float v1 = exactLerp(v01, v11, points[j].y);
            for (int k = 0; k < 3; ++k) {
                mixed[i + 3 * j + 9 * k] = exactLerp(v0, v1, points[k].z);
            }
        }
    }
    CertifiedRange range;
    range.atA = mixed[0];
    range.atB = mixed[13];
    range.atC = mixed[26];
    range.lo = certifiedMin(range.atA, certifiedMin(range.atB, range.atC));
    range.hi = certifiedMax(range.atA, certifiedMax(range.atB, range.atC));
    const float third = 0.3333333432674407958984375f;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (i != j) {
                // Twice point i, once point j.
                PRECISE float two = mixed[j + 3 * i + 9 * i] + mixed[i + 3 * j + 9 * i];
                PRECISE float three = two + mixed[i + 3 * i + 9 * j];
                PRECISE float mean = three * third;
                range.lo = certifiedMin(range.lo, mean);
                range.hi = certifiedMax(range.hi, mean);
            }
        }
    }
    PRECISE float even = mixed[21] + mixed[7];
    PRECISE float evens = even + mixed[11];
    PRECISE float odd = mixed[5] + mixed[15];
    PRECISE float odds = odd + mixed[19];
    PRECISE float all = evens + odds;
    PRECISE float middle = all * 0.16666667163372039794921875f;
    range.lo = certifiedMin(range.lo, middle);
    range.hi = certifiedMax(range.hi, middle);
    return range;
}

/// Points of a fragment that are certainly in the domain: those with the minimum and the maximum entry.
struct CertifiedSamples {
    bool some;
    float lo, hi;
    VoxelPoint atLo, atHi;
};

EXACT bool certifiedSafe(CertifiedCell cell, VoxelPoint at) {
    return at.x >= cell.safeLo.x && at.x <= cell.safeHi.x && at.y >= cell.safeLo.y && at.y <= cell.safeHi.y &&
           at.z >= cell.safeLo.z && at.z <= cell.safeHi.z;
}

/// Returns true if a point of the cell proves a touch: it is certainly in the domain, and opaque. `entry` is the
/// interpolant there.
EXACT bool certifiedPointProves(OpaqueValues opaque, CertifiedCell cell, VoxelPoint at, float entry) {
    PRECISE float below = entry - cell.margin;
    PRECISE float above = entry + cell.margin;
    return certifiedSafe(cell, at) && certainlyAllOpaque(opaque, below, above);
}

EXACT void certifiedSample(CertifiedCell cell, VoxelPoint at, float entry, INOUT(CertifiedSamples) samples) {
    if (!certifiedSafe(cell, at)) {
        return;
    }
    if (!samples.some || entry < samples.lo) {
        samples.lo = entry;
        samples.atLo = at;
    }
    if (!samples.some || entry > samples.hi) {
        samples.hi = entry;
        samples.atHi = at;
    }
    samples.some = true;
}

/// Returns true if the samples together prove a touch: an opaque scalar lies between two of them (the triangle within
/// the domain is connected and the interpolant continuous).
EXACT bool certifiedCrossingProves(OpaqueValues opaque, CertifiedSamples samples, float margin) {
    PRECISE float above = samples.lo + margin;
    PRECISE float below = samples.hi - margin;
    return samples.some && certainlySomeOpaque(opaque, above, below);
}

EXACT VoxelPoint certifiedMiddle(VoxelPoint a, VoxelPoint b) {
    return voxelPoint(exactLerp(a.x, b.x, 0.5f), exactLerp(a.y, b.y, 0.5f), exactLerp(a.z, b.z, 0.5f));
}

/// Proof of a touch: a point of the fragment, relative to the cell's corner, and an opaque entry.
struct CertifiedWitness {
    VoxelPoint point;
    float entry;  // certainly opaque
    bool between; // the interpolant at a place within rounding of the point
};

EXACT CertifiedWitness certifiedWitnessAt(VoxelPoint point, float entry) {
    CertifiedWitness witness;
    witness.point = point;
    witness.entry = entry;
    witness.between = false;
    return witness;
}

/// Returns the witness of certifiedCrossingProves(): an opaque entry of a point on the segment between the samples, and
/// the place where bisection of the segment ends.
EXACT CertifiedWitness certifiedWitnessBetween(OpaqueValues opaque, CertifiedCell cell, CertifiedSamples samples) {
    PRECISE float above = samples.lo + cell.margin;
    CertifiedWitness witness;
    witness.point = samples.atLo;
    witness.entry = opaqueFrom(opaque, above);
    witness.between = true;
    VoxelPoint beyond = samples.atHi;
    for (int step = 0; step < 24; ++step) {
        const VoxelPoint middle = certifiedMiddle(witness.point, beyond);
        if (certifiedInterpolate(cell, middle.x, middle.y, middle.z) <= witness.entry) {
            witness.point = middle;
        } else {
            beyond = middle;
        }
    }
    return witness;
}

/// Returns true if no point of a piece is safe: all lie beyond one side of the safe box.
EXACT bool certifiedAllUnsafe(CertifiedCell cell, CertifiedPiece piece) {
    return certifiedMax(piece.a.x, certifiedMax(piece.b.x, piece.c.x)) < cell.safeLo.x ||
           certifiedMax(piece.a.y, certifiedMax(piece.b.y, piece.c.y)) < cell.safeLo.y ||
           certifiedMax(piece.a.z, certifiedMax(piece.b.z, piece.c.z)) < cell.safeLo.z ||
           certifiedMin(piece.a.x, certifiedMin(piece.b.x, piece.c.x)) > cell.safeHi.x ||
           certifiedMin(piece.a.y, certifiedMin(piece.b.y, piece.c.y)) > cell.safeHi.y ||
           certifiedMin(piece.a.z, certifiedMin(piece.b.z, piece.c.z)) > cell.safeHi.z;
}

/// Returns true if halving a piece cannot decide it: its bounds are within their error and it was sampled completely,
/// or not at all.
EXACT bool certifiedHopeless(CertifiedCell cell, CertifiedPiece piece, CertifiedRange range) {
    PRECISE float width = range.hi - range.lo;
    const bool sampled = certifiedSafe(cell, piece.a) && certifiedSafe(cell, piece.b) && certifiedSafe(cell, piece.c);
    return (!(width > cell.margin) && sampled) || certifiedAllUnsafe(cell, piece);
}

/// Returns true if every point of the cell is certainly opaque, for entries with an error of at most `error`.
EXACT bool certifiedAllOpaque(OpaqueValues opaque, CertifiedCell cell, float error) {
    PRECISE float lo = cell.least - error;
    PRECISE float hi = cell.greatest + error;
    if (!(lo <= hi) || !certainlyAllOpaque(opaque, lo, hi)) {
        return false;
    }
    // A NaN corner is no extreme.
    return certifiedInterpolate(cell, 0.5f, 0.5f, 0.5f) <= hi;
}

/// Returns true if every point of the cell is certainly opaque, displacements included.
EXACT bool certifiedCellAllOpaque(OpaqueValues opaque, CertifiedCell cell) {
    return certifiedAllOpaque(opaque, cell, cell.margin);
}

/// Returns true if any point that certainly is in the cell proves a touch: no value of the cell exceeds those at its
/// corners. So voxels at an end of an opaque interval are opaque, which is unknown of interpolated values.
EXACT bool certifiedInsideProves(OpaqueValues opaque, CertifiedCell cell, VoxelPoint at) {
    const float lo = cell.displacement;
    PRECISE float hi = 1.0f - cell.displacement;
    return certifiedAllOpaque(opaque, cell, cell.cornerError) && at.x >= lo && at.x <= hi && at.y >= lo && at.y <= hi &&
           at.z >= lo && at.z <= hi && certifiedSafe(cell, at);
}

/// Returns true if a corner of a polygon is certainly in the domain: the witness.
EXACT bool certifiedSafeCorner(CertifiedCell cell HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS), int count,
                               OUT(VoxelPoint) witness) {
    witness = polygon[0];
    for (int i = 0; i < count; ++i) {
        if (certifiedSafe(cell, polygon[i])) {
            witness = polygon[i];
            return true;
        }
    }
    return false;
}

/// Decides a fragment: the polygon of certifiedClip() in its cell. `witness` is set where it is certain.
EXACT int certifiedDecide(OpaqueValues opaque, CertifiedCell cell,
                          float resolution HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS), int count,
                          OUT(CertifiedWitness) witness) {
    CertifiedPiece stack[CERTIFIED_STACK];
    CertifiedSamples samples;
    samples.some = false;
    samples.lo = 0.0f;
    samples.hi = 0.0f;
    samples.atLo = polygon[0];
    samples.atHi = polygon[0];
    witness = certifiedWitnessAt(polygon[0], 0.0f);
    int waiting = 0;
    for (int i = count - 2; i > 0; --i) {
        stack[waiting].a = polygon[0];
        stack[waiting].b = polygon[i];
        stack[waiting].c = polygon[i + 1];
        ++waiting;
    }
    bool open = false;
    for (int pieces = 0; waiting > 0; ++pieces) {
        if (pieces == CERTIFIED_MAX_PIECES) {
            // Corners of pieces that were not examined: certifiedVertexProves() does not depend on their order.
            for (int i = 0; i < count; ++i) {
                const float entry = certifiedInterpolate(cell, polygon[i].x, polygon[i].y, polygon[i].z);
                if (certifiedPointProves(opaque, cell, polygon[i], entry)) {
                    witness = certifiedWitnessAt(polygon[i], entry);
                    return CERTIFIED_CERTAIN;
                }
            }
            return CERTIFIED_UNDECIDED;
        }
        const CertifiedPiece piece = stack[--waiting];
        const CertifiedRange range = certifiedRange(cell, piece);
        PRECISE float lo = range.lo - cell.margin;
        PRECISE float hi = range.hi + cell.margin;
        if (!mayBeOpaque(opaque, lo, hi)) {
            continue;
        }
        const VoxelPoint points[3] = {piece.a, piece.b, piece.c};
        const float entries[3] = {range.atA, range.atB, range.atC};
        for (int i = 0; i < 3; ++i) {
            if (certifiedPointProves(opaque, cell, points[i], entries[i])) {
                witness = certifiedWitnessAt(points[i], entries[i]);
                return CERTIFIED_CERTAIN;
            }
        }
        for (int i = 0; i < 3; ++i) {
            certifiedSample(cell, points[i], entries[i], samples);
        }
        if (certifiedCrossingProves(opaque, samples, cell.margin)) {
            witness = certifiedWitnessBetween(opaque, cell, samples);
            return CERTIFIED_CERTAIN;
        }
        const float ab = voxelLength(voxelDifference(piece.b, piece.a));
        const float bc = voxelLength(voxelDifference(piece.c, piece.b));
        const float ca = voxelLength(voxelDifference(piece.a, piece.c));
        const float longest = certifiedMax(ab, certifiedMax(bc, ca));
        if (!(longest > resolution) || waiting + 2 > CERTIFIED_STACK || certifiedHopeless(cell, piece, range)) {
            open = true;
            continue;
        }
        CertifiedPiece first = piece;
        CertifiedPiece second = piece;
        if (ab >= bc && ab >= ca) {
            const VoxelPoint middle = certifiedMiddle(piece.a, piece.b);
            first.b = middle;
            second.a = middle;
        } else if (bc >= ca) {
            const VoxelPoint middle = certifiedMiddle(piece.b, piece.c);
            first.c = middle;
            second.b = middle;
        } else {
            const VoxelPoint middle = certifiedMiddle(piece.c, piece.a);
            first.a = middle;
            second.c = middle;
        }
        stack[waiting++] = first;
        stack[waiting++] = second;
    }
    return open ? CERTIFIED_UNDECIDED : CERTIFIED_NONE;
}

/// The texture coordinate along an axis of a place in a cell.
EXACT float certifiedTexture(int cell, float within, int size) {
    PRECISE float place = float(cell) + within;
    PRECISE float shifted = place + 0.5f;
    PRECISE float coordinate = shifted * exactReciprocal(float(size));
    return coordinate;
}

/// Values of a witness.
struct CertifiedProof {
    VoxelPoint texture; // its texture coordinate
    float stored;       // the stored value there
    float opacity;      // the opacity of that value: not below the threshold
};

/// Returns the values of a witness in the cell (x, y, z).
EXACT CertifiedProof certifiedProof(OpaqueValues opaque, CertifiedItem item, CertifiedCorners corners,
                                    CertifiedWitness witness, int x, int y, int z) {
    const VoxelPoint at = witness.point;
    CertifiedProof proof;
    proof.texture = voxelPoint(certifiedTexture(x, at.x, item.sizeX), certifiedTexture(y, at.y, item.sizeY),
                               certifiedTexture(z, at.z, item.sizeZ));
    if (witness.between) {
        PRECISE float scaled = witness.entry * exactReciprocal(item.entryScale);
        PRECISE float stored = scaled + item.storedReference;
        proof.stored = stored;
    } else {
        const float v00 = exactLerp(corners.s000, corners.s100, at.x);
        const float v10 = exactLerp(corners.s010, corners.s110, at.x);
        const float v01 = exactLerp(corners.s001, corners.s101, at.x);
        const float v11 = exactLerp(corners.s011, corners.s111, at.x);
        proof.stored = exactLerp(exactLerp(v00, v10, at.y), exactLerp(v01, v11, at.y), at.z);
    }
    proof.opacity = opacityOfOpaque(opaque, witness.entry);
    return proof;
}

/// Returns the range along an axis of a triangle's part in a cell, relative to the cell's corner.
EXACT void certifiedPart(float a, float b, float c, float delta, float cellLo, float cellHi, OUT(float) lo,
                         OUT(float) hi) {
    PRECISE float least = certifiedMin(a, certifiedMin(b, c)) - delta;
    PRECISE float greatest = certifiedMax(a, certifiedMax(b, c)) + delta;
    lo = certifiedClamp(least, cellLo, cellHi);
    hi = certifiedClamp(greatest, cellLo, cellHi);
}

/// Returns the minimum and maximum value in a box of the cell, from the cell's corner: the interpolant is linear along
/// each axis, so its extremes in a box are at the corners.
EXACT void certifiedBoxRange(CertifiedCell cell, VoxelPoint lo, VoxelPoint hi, OUT(float) least, OUT(float) greatest) {
    least = 0.0f;
    greatest = 0.0f;
    ROLLED for (int side = 0; side < 2; ++side) {
        const float x = side == 0 ? lo.x : hi.x;
        const float v00 = exactLerp(cell.x000, cell.x100, x);
        const float v10 = exactLerp(cell.x010, cell.x110, x);
        const float v01 = exactLerp(cell.x001, cell.x101, x);
        const float v11 = exactLerp(cell.x011, cell.x111, x);
        const float lowLow = exactLerp(v00, v10, lo.y);
        const float lowHigh = exactLerp(v01, v11, lo.y);
        const float highLow = exactLerp(v00, v10, hi.y);
        const float highHigh = exactLerp(v01, v11, hi.y);
        const float p = exactLerp(lowLow, lowHigh, lo.z);
        const float q = exactLerp(lowLow, lowHigh, hi.z);
        const float r = exactLerp(highLow, highHigh, lo.z);
        const float s = exactLerp(highLow, highHigh, hi.z);
        const float smallest = certifiedMin(certifiedMin(p, q), certifiedMin(r, s));
        const float largest = certifiedMax(certifiedMax(p, q), certifiedMax(r, s));
        least = side == 0 ? smallest : certifiedMin(least, smallest);
        greatest = side == 0 ? largest : certifiedMax(greatest, largest);
    }
}

/// Returns true if a point in the box of the triangle's part in the cell may be opaque.
EXACT bool certifiedPartMayBeOpaque(OpaqueValues opaque, CertifiedTriangle triangle, CertifiedCell cell,
                                    VoxelPoint origin) {
    const VoxelPoint a = voxelDifference(triangle.corner0, origin);
    const VoxelPoint b = voxelDifference(triangle.corner1, origin);
    const VoxelPoint c = voxelDifference(triangle.corner2, origin);
    VoxelPoint lo;
    VoxelPoint hi;
    certifiedPart(a.x, b.x, c.x, triangle.delta, cell.lo.x, cell.hi.x, lo.x, hi.x);
    certifiedPart(a.y, b.y, c.y, triangle.delta, cell.lo.y, cell.hi.y, lo.y, hi.y);
    certifiedPart(a.z, b.z, c.z, triangle.delta, cell.lo.z, cell.hi.z, lo.z, hi.z);
    float least;
    float greatest;
    certifiedBoxRange(cell, lo, hi, least, greatest);
    return certifiedMayBeOpaque(opaque, least, greatest, cell.pointError);
}

/// Other results of certifiedBegin() and certifiedBeginAgain() than a number of corners.
#define CERTIFIED_NO_POLYGON -1

/// Returns true if a fragment may have an opaque point, before clipping. Expects a cell that may have one.
EXACT bool certifiedBeginMay(OpaqueValues opaque, CertifiedTriangle triangle, CertifiedCell cell, int x, int y, int z) {
    return certifiedCellAllOpaque(opaque, cell) ||
           certifiedPartMayBeOpaque(opaque, triangle, cell, voxelPoint(float(x), float(y), float(z)));
}

/// Returns the polygon of a fragment; none if it has no opaque point. Expects a cell that may have one.
EXACT int certifiedBegin(OpaqueValues opaque, CertifiedTriangle triangle, CertifiedCell cell, int x, int y,
                         int z HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS)) {
    if (!certifiedBeginMay(opaque, triangle, cell, x, y, z)) {
        return 0;
    }
    return certifiedClip(triangle, cell, voxelPoint(float(x), float(y), float(z)) HAND(polygon));
}

/// Like certifiedBegin(), for a precise triangle in the cell of preciseCell() or, with `within`, for its part that is
/// certainly in the domain, in the cell of preciseWithin(). Returns CERTIFIED_NO_POLYGON if nothing is known.
EXACT int certifiedBeginAgain(PreciseTriangle triangle, CertifiedCell cell, int x, int y, int z,
                              bool within HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS)) {
    if (!preciseKnown(triangle)) {
        return CERTIFIED_NO_POLYGON;
    }
    if (triangle.outside) {
        return 0;
    }
    return preciseClip(triangle, cell, voxelPoint(float(x), float(y), float(z)), within HAND(polygon));
}

/// The resolution for precise triangles: the few remaining fragments may take longer.
EXACT float certifiedFinest(CertifiedItem item) {
    return certifiedMin(item.resolution, CERTIFIED_FINE_RESOLUTION);
}

/// Returns a fragment's verdict, from its polygon. Sets `witness` if it is certain.
EXACT int certifiedSettle(OpaqueValues opaque, float resolution,
                          CertifiedCell cell HANDED(VoxelPoint, polygon, CERTIFIED_MAX_CORNERS), int count,
                          OUT(CertifiedWitness) witness) {
    witness = certifiedWitnessAt(voxelPoint(0.0f, 0.0f, 0.0f), 0.0f);
    if (count == 0) {
        return CERTIFIED_NONE;
    }
    if (count == CERTIFIED_NO_POLYGON) {
        return CERTIFIED_UNDECIDED;
    }
    VoxelPoint within;
    if (certifiedCellAllOpaque(opaque, cell) && certifiedSafeCorner(cell HAND(polygon), count, within)) {
        witness = certifiedWitnessAt(within, certifiedInterpolate(cell, within.x, within.y, within.z));
        return CERTIFIED_CERTAIN;
    }
    const VoxelPoint middle = certifiedMiddle(certifiedMiddle(polygon[0], polygon[1]), polygon[2]);
    if (certifiedInsideProves(opaque, cell, middle)) {
        witness = certifiedWitnessAt(middle, certifiedInterpolate(cell, middle.x, middle.y, middle.z));
        return CERTIFIED_CERTAIN;
    }
    return certifiedDecide(opaque, cell, resolution HAND(polygon), count, witness);
}

/// Returns true if a vertex alone proves that its triangle touches, in its cell (x, y, z). Expects a cell whose delta
/// is at least the triangle's. certifiedSettle() agrees for the triangle's own delta.
EXACT bool certifiedVertexProves(OpaqueValues opaque, CertifiedCell cell, VoxelPoint vertex, int x, int y, int z,
                                 OUT(CertifiedWitness) witness) {
    const VoxelPoint at = voxelDifference(vertex, voxelPoint(float(x), float(y), float(z)));
    witness = certifiedWitnessAt(at, certifiedInterpolate(cell, at.x, at.y, at.z));
    return certifiedPointProves(opaque, cell, at, witness.entry);
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif

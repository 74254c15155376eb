// SPDX-License-Identifier: MIT
// From a pose to what the passes need of a pair: in double precision, rounded to float once. One text for the host,
// which has the poses of most callers, and for the device (pair_setup.comp), so that both start from the same numbers.
#ifndef VOXTACT_PAIR_SETUP_H
#define VOXTACT_PAIR_SETUP_H

#include "shared.h"
#include "wide.h"

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// Column-major.
struct WideMatrix {
    Wide element[16];
};

/// Rounding of a vertex's difference from the reference, of the matrix to float, of three products and of three sums:
/// in all less than 7 units of 2^-24 of the sum of the terms' magnitudes.
#define PAIR_FLOAT_ERROR wideBits(0x3ea00000u, 0u) // 2^-21
/// The products of matrices in double, with the voxels' scale.
#define PAIR_DOUBLE_ERROR wideBits(0x3cf00000u, 0u) // 2^-48
/// The smallest normal float. Devices may take what is smaller for zero, wherever they load or compute it.
#define PAIR_LEAST_NORMAL wideBits(0x38100000u, 0u) // 2^-126
/// Such losses of a coordinate of a vertex relative to the reference: it, the reference, their difference; one more
/// for what that adds to the computed error.
#define PAIR_LOST_NORMALS wideBits(0x40100000u, 0u) // 4
/// Elements below the smallest normal float lose more than their relative error.
#define PAIR_LEAST_ERROR wideBits(0x38700000u, 0u) // 2^-120
/// Parts of a place are not smaller: all their bits are normal floats, and so is every sum of them.
#define PAIR_LEAST_PART wideBits(0x39b00000u, 0u) // 2^-100
/// Object units. A reference beyond it is worse than none.
#define PAIR_FARTHEST_REFERENCE wideBits(0x426d1a94u, 0xa2000000u) // 1e12
/// Above one by more than what a quotient and a sum are rounded by.
#define PAIR_A_LITTLE_MORE wideBits(0x3ff00418u, 0x9374bc6au) // 1.001
#define PAIR_ONE wideBits(0x3ff00000u, 0u)
#define PAIR_HALF wideBits(0x3fe00000u, 0u)
#define PAIR_ZERO wideBits(0u, 0u)
#define PAIR_INFINITE_FLOAT 0x7f800000u

/// a * b + c, rounded twice.
EXACT Wide wideMultiplyAdd(Wide a, Wide b, Wide c) {
    return wideAdd(wideMultiply(a, b), c);
}

EXACT Wide wideMost(Wide a, Wide b) {
    return wideLess(a, b) ? b : a;
}

/// The float next above the one of those bits.
EXACT uint floatBitsAbove(uint bits) {
    const uint size = bits & 0x7fffffffu;
    if (size > PAIR_INFINITE_FLOAT || bits == PAIR_INFINITE_FLOAT) {
        return bits;
    }
    if (size == 0u) {
        return 1u;
    }
    return bits == size ? bits + 1u : bits - 1u;
}

/// Element (row, column) of c_from_b * b_from_a.
EXACT Wide wideProductElement(WideMatrix c_from_b, WideMatrix b_from_a, uint row, uint column) {
    Wide sum = wideMultiply(c_from_b.element[row], b_from_a.element[4 * column]);
    ROLLED for (uint k = 1; k < 4; ++k) {
        sum = wideAdd(sum, wideMultiply(c_from_b.element[4 * k + row], b_from_a.element[4 * column + k]));
    }
    return sum;
}

/// What every counting method starts from, but those of the projection `conservative`.
EXACT PairTransform pairTransformOf(WideMatrix clip_from_world, WideMatrix texture_from_world,
                                    WideMatrix world_from_object) {
    PairTransform transform;
    ROLLED for (uint row = 0; row < 4; ++row) {
        ROLLED for (uint column = 0; column < 4; ++column) {
            const Wide clip = wideProductElement(clip_from_world, world_from_object, row, column);
            transform.clip_from_object[row][column] = wideFloatOf(wideToFloatBits(clip));
            if (row < 3) {
                const Wide texture = wideProductElement(texture_from_world, world_from_object, row, column);
                transform.texture_from_object[row][column] = wideFloatOf(wideToFloatBits(texture));
            }
        }
    }
    return transform;
}

/// A grid as `conservative` needs it for each pair.
struct PairGrid {
    WideMatrix texture_from_world;
    Wide size[3]; // voxels
    // Where the grid's axes are those of the world: the sign of the one that each is along, what the origin along it
    // takes away, half the spacing.
    Wide sign[3];
    Wide lessOrigin[3];
    Wide halfSpacing[3];
    // Elsewhere: of the magnitude of a coordinate, by how much a place may be off by the rounding of
    // texture_from_world, in voxels; element 4 * axis + coordinate.
    Wide share[12];
    uint axis[3];
    uint aligned;
};

/// voxel_from_object, and the same product of the elements' magnitudes; the last rows are not used.
struct PairRows {
    WideMatrix value;
    WideMatrix magnitude;
};

EXACT PairRows pairRows(PairGrid grid, WideMatrix world_from_object) {
    PairRows rows;
    ROLLED for (uint column = 0; column < 4; ++column) {
        ROLLED for (uint row = 0; row < 3; ++row) {
            Wide sum = PAIR_ZERO;
            Wide magnitude = PAIR_ZERO;
            ROLLED for (uint k = 0; k < 4; ++k) {
                const Wide term = wideMultiply(grid.texture_from_world.element[4 * k + row],
                                               world_from_object.element[4 * column + k]);
                sum = wideAdd(sum, term);
                magnitude = wideAdd(magnitude, wideAbs(term));
            }
            const Wide centre = column == 3 ? PAIR_HALF : PAIR_ZERO;
            rows.value.element[4 * column + row] = wideSubtract(wideMultiply(sum, grid.size[row]), centre);
            rows.magnitude.element[4 * column + row] = wideMultiplyAdd(magnitude, grid.size[row], centre);
        }
    }
    return rows;
}

EXACT Wide pairMinor(WideMatrix m, uint r, uint c) {
    const uint r1 = (r + 1) % 3;
    const uint r2 = (r + 2) % 3;
    const uint c1 = (c + 1) % 3;
    const uint c2 = (c + 2) % 3;
    return wideSubtract(wideMultiply(m.element[4 * c1 + r1], m.element[4 * c2 + r2]),
                        wideMultiply(m.element[4 * c2 + r1], m.element[4 * c1 + r2]));
}

/// Bits of floats.
struct PairReference {
    uint bits[3];
};

/// The point of object space that comes to the volume's centre, rounded to float: what is near the volume is then near
/// the reference, however far the object's origin is. The origin where there is no such point.
EXACT PairReference pairReference(PairGrid grid, WideMatrix m) {
    const Wide first = wideMultiply(m.element[0], pairMinor(m, 0, 0));
    const Wide second = wideMultiply(m.element[4], pairMinor(m, 0, 1));
    const Wide third = wideMultiply(m.element[8], pairMinor(m, 0, 2));
    const Wide determinant = wideAdd(wideAdd(first, second), third);
    PairReference reference;
    bool near = true;
    ROLLED for (uint axis = 0; axis < 3; ++axis) {
        Wide sum = PAIR_ZERO;
        ROLLED for (uint row = 0; row < 3; ++row) {
            const Wide way = wideSubtract(wideMultiply(PAIR_HALF, grid.size[row]), m.element[12 + row]);
            sum = wideAdd(sum, wideMultiply(pairMinor(m, row, axis), way));
        }
        const Wide place = wideDivide(sum, determinant);
        near = near && wideLess(wideAbs(place), PAIR_FARTHEST_REFERENCE);
        reference.bits[axis] = wideToFloatBits(place);
    }
    ROLLED for (uint axis = 0; axis < 3; ++axis) {
        reference.bits[axis] = near ? reference.bits[axis] : 0u;
    }
    return reference;
}

/// What a + b is rounded by.
EXACT Wide wideLost(Wide a, Wide b, Wide sum) {
    const Wide ofB = wideSubtract(sum, a);
    return wideAdd(wideSubtract(b, ofB), wideSubtract(a, wideSubtract(sum, ofB)));
}

/// A number in parts that a float holds each: their sum is exact where what is left is zero.
struct PairParts {
    float part[3];
    Wide left;
};

/// Of value + low, the second the smaller by far.
EXACT PairParts pairParts(Wide value, Wide low) {
    PairParts parts;
    Wide rest = value;
    Wide lost = PAIR_ZERO;
    ROLLED for (uint i = 0; i < 3; ++i) {
        parts.part[i] = 0.0f;
        if (wideAtLeast(wideAbs(rest), PAIR_LEAST_PART)) {
            const uint bits = wideToFloatBits(rest);
            parts.part[i] = wideFloatOf(bits);
            rest = wideSubtract(rest, wideOfFloatBits(bits)); // exact: they are near each other
        }
        if (i == 0) {
            const Wide sum = wideAdd(rest, low);
            lost = wideLost(rest, low, sum);
            rest = sum;
        }
    }
    parts.left = wideAdd(wideAbs(rest), wideAbs(lost));
    return parts;
}

/// A column of `place` of a CertifiedPair, and by how much it may be off along any axis.
struct PairPlace {
    PairParts row[3];
    Wide error;
};

EXACT PairPlace alignedPlace(PairGrid grid, WideMatrix world_from_object, uint column) {
    PairPlace place;
    place.error = PAIR_ZERO;
    ROLLED for (uint row = 0; row < 3; ++row) {
        const Wide along = wideMultiply(grid.sign[row], world_from_object.element[4 * column + grid.axis[row]]);
        if (column < 3) {
            place.row[row] = pairParts(along, PAIR_ZERO);
            place.error = wideMost(place.error, place.row[row].left);
        } else {
            const Wide from = wideAdd(along, grid.lessOrigin[row]);
            const Wide lost = wideLost(along, grid.lessOrigin[row], from);
            const Wide at = wideAdd(from, grid.halfSpacing[row]);
            const Wide lostToo = wideLost(from, grid.halfSpacing[row], at);
            const Wide low = wideAdd(lostToo, lost);
            const Wide left = wideLost(lostToo, lost, low);
            place.row[row] = pairParts(at, low);
            place.error = wideMost(place.error, wideAdd(place.row[row].left, wideAbs(left)));
        }
    }
    return place;
}

EXACT PairPlace obliquePlace(PairGrid grid, PairRows rows, uint column) {
    const Wide centre = column == 3 ? PAIR_HALF : PAIR_ZERO;
    PairPlace place;
    place.error = PAIR_ZERO;
    ROLLED for (uint row = 0; row < 3; ++row) {
        place.row[row] = pairParts(wideAdd(rows.value.element[4 * column + row], centre), PAIR_ZERO);
        Wide error = wideMultiplyAdd(PAIR_DOUBLE_ERROR, wideAdd(rows.magnitude.element[4 * column + row], centre),
                                     place.row[row].left);
        ROLLED for (uint k = 0; k < 3; ++k) {
            error = wideAdd(error, wideMultiply(grid.share[4 * row + k], rows.magnitude.element[4 * column + k]));
        }
        if (column == 3) {
            error = wideAdd(error, grid.share[4 * row + 3]);
        }
        place.error = wideMost(place.error, error);
    }
    return place;
}

/// What the projection `conservative` starts from.
EXACT CertifiedPair certifiedPairOf(PairGrid grid, WideMatrix world_from_object) {
    const PairRows rows = pairRows(grid, world_from_object);
    const PairReference reference = pairReference(grid, rows.value);
    CertifiedPair pair;
    Wide worst[4];
    ROLLED for (uint column = 0; column < 4; ++column) {
        worst[column] = PAIR_ZERO;
    }
    bool fits = true; // in floats: an element that is infinite or NaN has no relative error
    ROLLED for (uint row = 0; row < 3; ++row) {
        Wide place = rows.value.element[12 + row];
        Wide magnitude = rows.magnitude.element[12 + row];
        Wide lost = PAIR_ZERO;
        ROLLED for (uint column = 0; column < 3; ++column) {
            const Wide element = rows.value.element[4 * column + row];
            const Wide size = rows.magnitude.element[4 * column + row];
            const Wide at = wideOfFloatBits(reference.bits[column]);
            place = wideAdd(place, wideMultiply(element, at));
            magnitude = wideAdd(magnitude, wideMultiply(size, wideAbs(at)));
            lost = wideAdd(lost, wideMultiply(wideMultiply(PAIR_LOST_NORMALS, PAIR_LEAST_NORMAL), wideAbs(element)));
            const uint bits = wideToFloatBits(element);
            fits = fits && (bits & PAIR_INFINITE_FLOAT) != PAIR_INFINITE_FLOAT;
            pair.voxel_from_reference[row][column] = wideFloatOf(bits);
            worst[column] = wideMost(worst[column], wideMultiplyAdd(PAIR_FLOAT_ERROR, wideAbs(element),
                                                                    wideMultiply(PAIR_DOUBLE_ERROR, size)));
        }
        const uint bits = wideToFloatBits(place);
        fits = fits && (bits & PAIR_INFINITE_FLOAT) != PAIR_INFINITE_FLOAT;
        pair.voxel_from_reference[row][3] = wideFloatOf(bits);
        worst[3] = wideMost(worst[3], wideAdd(wideMultiplyAdd(PAIR_FLOAT_ERROR, wideAbs(place),
                                                              wideMultiply(PAIR_DOUBLE_ERROR, magnitude)),
                                              lost));
    }
    // Of the places, and then all of them as a share of the others.
    Wide share = PAIR_ZERO;
    Wide beyond = PAIR_ZERO;
    ROLLED for (uint column = 0; column < 4; ++column) {
        const PairPlace at =
            grid.aligned != 0u ? alignedPlace(grid, world_from_object, column) : obliquePlace(grid, rows, column);
        ROLLED for (uint row = 0; row < 3; ++row) {
            ROLLED for (uint part = 0; part < 3; ++part) {
                pair.place[3 * part + row][column] = at.row[row].part[part];
            }
        }
        uint bits = floatBitsAbove(wideToFloatBits(wideAdd(worst[column], PAIR_LEAST_ERROR)));
        if (column == 3 && !fits) {
            bits = PAIR_INFINITE_FLOAT;
        }
        pair.error[column] = wideFloatOf(bits);
        const Wide error = column == 3 ? wideAdd(at.error, beyond) : at.error;
        if (column < 3) {
            pair.reference[column] = wideFloatOf(reference.bits[column]);
            beyond = wideAdd(beyond, wideMultiply(at.error, wideAbs(wideOfFloatBits(reference.bits[column]))));
        }
        share = wideMost(share, wideDivide(error, wideOfFloatBits(bits)));
    }
    const Wide more = wideMultiplyAdd(PAIR_A_LITTLE_MORE, share, PAIR_LEAST_NORMAL);
    pair.reference[3] = wideLess(PAIR_ZERO, share) ? wideFloatOf(floatBitsAbove(wideToFloatBits(more))) : 0.0f;
    return pair;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif

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
/// The smallest normal float. Devices may flush smaller numbers to zero, on load or in computation.
#define PAIR_LEAST_NORMAL wideBits(0x38100000u, 0u) // 2^-126
/// Four such losses of a coordinate of a vertex relative to the reference: it, the reference, their difference; one
/// more for what that adds to the computed error.
#define PAIR_LOST_NORMALS wideBits(0x38300000u, 0u) // 2^-124
/// Elements below the smallest normal float lose more than their relative error.
#define PAIR_LEAST_ERROR wideBits(0x38700000u, 0u) // 2^-120
/// Parts of a place are not smaller: all their bits are normal floats, and so is every sum of them.
#define PAIR_LEAST_PART wideBits(0x39b00000u, 0u) // 2^-100
/// Object units. A more distant reference is worse than none.
#define PAIR_FARTHEST_REFERENCE wideBits(0x426d1a94u, 0xa2000000u) // 1e12
/// Exceeds one by more than the rounding of a quotient and a sum.
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

/// Returns the next larger float.
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

/// Origin of a mesh's floats: a vertex is the floats plus the offset, within the rounding; object units.
struct PairOrigin {
    Wide offset[3];
    Wide rounding;
};

/// Returns the pose of the floats of a mesh.
EXACT WideMatrix pairWorldFromFloats(WideMatrix world_from_object, PairOrigin origin) {
    WideMatrix moved = world_from_object;
    ROLLED for (uint axis = 0; axis < 3; ++axis) {
        if (wideLess(PAIR_ZERO, wideAbs(origin.offset[axis]))) {
            ROLLED for (uint row = 0; row < 3; ++row) {
                moved.element[12 + row] = wideMultiplyAdd(world_from_object.element[4 * axis + row],
                                                          origin.offset[axis], moved.element[12 + row]);
            }
        }
    }
    return moved;
}

/// Returns the error of world coordinates of vertices, by their rounding and that of pairWorldFromFloats().
struct PairOff {
    Wide world[3];
};

EXACT PairOff pairOff(WideMatrix world_from_object, PairOrigin origin) {
    PairOff off;
    ROLLED for (uint row = 0; row < 3; ++row) {
        Wide ofVertex = PAIR_ZERO;
        Wide moved = PAIR_ZERO;
        ROLLED for (uint axis = 0; axis < 3; ++axis) {
            const Wide element = wideAbs(world_from_object.element[4 * axis + row]);
            ofVertex = wideMultiplyAdd(element, origin.rounding, ofVertex);
            moved = wideMultiplyAdd(element, wideAbs(origin.offset[axis]), moved);
        }
        if (wideLess(PAIR_ZERO, moved)) {
            moved = wideAdd(moved, wideAbs(world_from_object.element[12 + row]));
        }
        off.world[row] = wideMultiplyAdd(PAIR_DOUBLE_ERROR, moved, wideMultiply(ofVertex, PAIR_A_LITTLE_MORE));
    }
    return off;
}

/// Inputs of every counting method except the projection `certified`.
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

/// Constants of a grid for the pairs of `certified`.
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
            // The sum does not start at zero: llvmpipe replaces 0 + a by a, which keeps the sign of a zero.
            Wide sum = wideMultiply(grid.texture_from_world.element[row], world_from_object.element[4 * column]);
            Wide magnitude = wideAbs(sum);
            ROLLED for (uint k = 1; k < 4; ++k) {
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

/// Returns the point of object space at the volume's centre, rounded to float: points near the volume are then near the
/// reference, for any object origin. The origin if there is no such point.
EXACT PairReference pairReference(PairGrid grid, WideMatrix m) {
    // Sums of the determinant and of its dividends.
    Wide sum[4];
    ROLLED for (uint axis = 0; axis < 4; ++axis) {
        ROLLED for (uint i = 0; i < 3; ++i) {
            const uint row = axis == 3 ? 0u : i;
            const uint column = axis == 3 ? i : axis;
            Wide by = m.element[4 * column];
            if (axis < 3) {
                by = wideSubtract(wideMultiply(PAIR_HALF, grid.size[row]), m.element[12 + row]);
            }
            const Wide term = wideMultiply(pairMinor(m, row, column), by);
            if (i == 0) {
                sum[axis] = term;
            } else {
                sum[axis] = wideAdd(sum[axis], term);
            }
        }
    }
    PairReference reference;
    bool near = true;
    ROLLED for (uint axis = 0; axis < 3; ++axis) {
        const Wide place = wideDivide(sum[axis], sum[3]);
        near = near && wideLess(wideAbs(place), PAIR_FARTHEST_REFERENCE);
        reference.bits[axis] = wideToFloatBits(place);
    }
    ROLLED for (uint axis = 0; axis < 3; ++axis) {
        reference.bits[axis] = near ? reference.bits[axis] : 0u;
    }
    return reference;
}

/// A sum and its rounding error: both together are a + b.
struct PairSum {
    Wide sum;
    Wide lost;
};

EXACT PairSum pairSum(Wide a, Wide b) {
    PairSum found;
    found.sum = wideAdd(a, b);
    const Wide ofB = wideSubtract(found.sum, a);
    found.lost = wideAdd(wideSubtract(b, ofB), wideSubtract(a, wideSubtract(found.sum, ofB)));
    return found;
}

/// A number as parts that are floats: their sum is exact if the remainder is zero.
struct PairParts {
    float part[3];
    Wide left;
};

/// Splits value + low into parts; `low` is much smaller.
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
            const PairSum both = pairSum(rest, low);
            lost = both.lost;
            rest = both.sum;
        }
    }
    parts.left = wideAdd(wideAbs(rest), wideAbs(lost));
    return parts;
}

/// An element of `place` of a CertifiedPair: value + low, where `low` is much smaller, and its error.
struct PairPlace {
    Wide value;
    Wide low;
    Wide error;
};

EXACT PairPlace alignedPlace(PairGrid grid, WideMatrix world_from_object, uint row, uint column) {
    Wide parts[2];
    parts[0] = wideMultiply(grid.sign[row], world_from_object.element[4 * column + grid.axis[row]]);
    parts[1] = PAIR_ZERO;
    PairPlace place;
    place.error = PAIR_ZERO;
    if (column == 3) {
        ROLLED for (uint term = 0; term < 2; ++term) {
            Wide more = grid.lessOrigin[row];
            if (term == 1) {
                more = grid.halfSpacing[row];
            }
            ROLLED for (uint i = 0; i < 2; ++i) {
                const PairSum both = pairSum(parts[i], more);
                parts[i] = both.sum;
                more = both.lost;
            }
            place.error = wideAdd(place.error, wideAbs(more));
        }
    }
    place.value = parts[0];
    place.low = parts[1];
    return place;
}

EXACT PairPlace obliquePlace(PairGrid grid, PairRows rows, uint row, uint column) {
    const bool last = column == 3;
    Wide value = rows.value.element[4 * column + row];
    Wide magnitude = rows.magnitude.element[4 * column + row];
    Wide error = PAIR_ZERO;
    if (last) {
        value = wideAdd(value, PAIR_HALF);
        magnitude = wideAdd(magnitude, PAIR_HALF);
        error = grid.share[4 * row + 3];
    }
    error = wideMultiplyAdd(PAIR_DOUBLE_ERROR, magnitude, error);
    ROLLED for (uint k = 0; k < 3; ++k) {
        error = wideMultiplyAdd(grid.share[4 * row + k], rows.magnitude.element[4 * column + k], error);
    }
    PairPlace place;
    place.value = value;
    place.low = PAIR_ZERO;
    place.error = error;
    return place;
}

/// voxel_from_reference of a CertifiedPair, and the error of its coordinates.
struct PairFloats {
    uint bits[12]; // 4 * row + column
    Wide worst[4]; // of any row
    bool fits;     // in floats: an element that is infinite or NaN has no relative error
};

EXACT PairFloats pairFloats(PairRows rows, PairReference reference) {
    PairFloats floats;
    floats.fits = true;
    ROLLED for (uint column = 0; column < 4; ++column) {
        floats.worst[column] = PAIR_ZERO;
    }
    ROLLED for (uint row = 0; row < 3; ++row) {
        // Image of the reference, by the other columns.
        Wide place = rows.value.element[12 + row];
        Wide magnitude = rows.magnitude.element[12 + row];
        Wide lost = PAIR_ZERO;
        ROLLED for (uint column = 0; column < 4; ++column) {
            Wide element = place;
            Wide size = magnitude;
            Wide error = lost;
            if (column < 3) {
                element = rows.value.element[4 * column + row];
                size = rows.magnitude.element[4 * column + row];
                error = PAIR_ZERO;
                const Wide at = wideOfFloatBits(reference.bits[column]);
                place = wideMultiplyAdd(element, at, place);
                magnitude = wideMultiplyAdd(size, wideAbs(at), magnitude);
                lost = wideMultiplyAdd(PAIR_LOST_NORMALS, wideAbs(element), lost);
            }
            const uint bits = wideToFloatBits(element);
            floats.bits[4 * row + column] = bits;
            floats.fits = floats.fits && (bits & PAIR_INFINITE_FLOAT) != PAIR_INFINITE_FLOAT;
            error = wideMultiplyAdd(PAIR_DOUBLE_ERROR, size, error);
            error = wideMultiplyAdd(PAIR_FLOAT_ERROR, wideAbs(element), error);
            floats.worst[column] = wideMost(floats.worst[column], error);
        }
    }
    return floats;
}

/// In voxels.
EXACT Wide pairOffVoxels(PairGrid grid, PairOff off, uint row) {
    Wide sum = PAIR_ZERO;
    ROLLED for (uint k = 0; k < 3; ++k) {
        sum = wideMultiplyAdd(wideAbs(grid.texture_from_world.element[4 * k + row]), off.world[k], sum);
    }
    return wideMultiply(sum, wideMultiply(grid.size[row], PAIR_A_LITTLE_MORE));
}

/// Inputs of the projection `certified`.
EXACT CertifiedPair certifiedPairOf(PairGrid grid, WideMatrix world_from_object, PairOrigin origin) {
    const PairOff given = pairOff(world_from_object, origin);
    const WideMatrix world_from_floats = pairWorldFromFloats(world_from_object, origin);
    const PairRows rows = pairRows(grid, world_from_floats);
    const PairReference reference = pairReference(grid, rows.value);
    const PairFloats floats = pairFloats(rows, reference);
    CertifiedPair pair;
    // Errors of positions, then relative to the coordinates.
    Wide share = PAIR_ZERO;
    Wide beyond = PAIR_ZERO;
    ROLLED for (uint column = 0; column < 4; ++column) {
        Wide off = PAIR_ZERO;
        Wide voxels = PAIR_ZERO;
        ROLLED for (uint row = 0; row < 3; ++row) {
            PairPlace place;
            if (grid.aligned != 0u) {
                place = alignedPlace(grid, world_from_floats, row, column);
            } else {
                place = obliquePlace(grid, rows, row, column);
            }
            if (column == 3) {
                const Wide more = pairOffVoxels(grid, given, row);
                voxels = wideMost(voxels, more);
                place.error = wideAdd(place.error, grid.aligned != 0u ? given.world[grid.axis[row]] : more);
            }
            const PairParts parts = pairParts(place.value, place.low);
            ROLLED for (uint part = 0; part < 3; ++part) {
                pair.place[3 * part + row][column] = parts.part[part];
            }
            off = wideMost(off, wideAdd(place.error, parts.left));
            pair.voxel_from_reference[row][column] = wideFloatOf(floats.bits[4 * row + column]);
        }
        if (column == 3) {
            off = wideAdd(off, beyond);
        }
        // If the grid is oblique, the product of the matrices itself has an error in voxels.
        Wide worst = wideAdd(floats.worst[column], PAIR_LEAST_ERROR);
        worst = wideAdd(worst, grid.aligned == 0u ? off : voxels);
        uint bits = floatBitsAbove(wideToFloatBits(worst));
        if (column == 3 && !floats.fits) {
            bits = PAIR_INFINITE_FLOAT;
        }
        pair.error[column] = wideFloatOf(bits);
        if (column < 3) {
            pair.reference[column] = wideFloatOf(reference.bits[column]);
            beyond = wideMultiplyAdd(off, wideAbs(wideOfFloatBits(reference.bits[column])), beyond);
        }
        share = wideMost(share, wideDivide(off, wideOfFloatBits(bits)));
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

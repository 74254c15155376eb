// SPDX-License-Identifier: MIT
// Where a mesh is on the way from one pose to another (core/geometry/rigid_motion.h), in double precision: for the
// host alone.
//
// What is at x turns about an axis u through the centre c, which goes its own way: at the parameter t it is at
// c(t) + R(t * angle) (x - c(0)). As R(a) y = y + sin(a) (u * y) + (1 - cos(a)) (u (u . y) - y) (Rodrigues), and as the
// way of the centre is straight, an arc, or both, each number of a pose is a sum of constants times few functions of t.
#ifndef VOXTACT_RIGID_POSE_H
#define VOXTACT_RIGID_POSE_H

#include "pair_setup.h"

/// Numbers that are such sums: 3 * column + row of world_from_object; where the centre is; and how fast it goes, mm for
/// the whole parameter.
#define RIGID_CENTRE 12
#define RIGID_SPEED 15
#define RIGID_NUMBERS 18
/// Terms of each: what it is at 0, and what it has of the sine of t * angle, of 1 less its cosine, of t, and of the
/// part of its chord that the centre has gone, along the chord and across it. Of a speed the second and third are those
/// of the cosine and the sine of (t - 1/2) * angle.
#define RIGID_TERMS 6

#include "exact_language.h"

namespace voxtact::shader {

struct RigidWay {
    Wide halfAngle; // radians, 0 to a right angle
    Wide perSine;   // 1 / sin(halfAngle); 0 where that is 0
    Wide term[RIGID_NUMBERS * RIGID_TERMS];
};

#define RIGID_TWO wideBits(0x40000000u, 0u)
/// Terms of the series of sine and cosine: for angles up to a right one, the next term is less than 2^-62.
#define RIGID_SERIES 12
#define RIGID_LAST_OF_SINE wideBits(0x40380000u, 0u)   // 24
#define RIGID_LAST_OF_COSINE wideBits(0x40370000u, 0u) // 23

struct RigidPose {
    Wide number[RIGID_NUMBERS];
};

/// 1 - square / (n (n + 1)) (1 - square / ((n - 2) (n - 1)) ...), from the last n back to the first.
EXACT Wide rigidSeries(Wide square, Wide last) {
    Wide sum = PAIR_ONE;
    Wide n = last;
    ROLLED for (int term = 0; term < RIGID_SERIES; ++term) {
        const Wide product = wideMultiply(n, wideAdd(n, PAIR_ONE));
        sum = wideSubtract(PAIR_ONE, wideDivide(wideMultiply(sum, square), product));
        n = wideSubtract(n, RIGID_TWO);
    }
    return sum;
}

EXACT Wide rigidNegated(Wide a) {
    return wideSubtract(PAIR_ZERO, a);
}

/// `parameter`: 0 to 1.
EXACT RigidPose rigidPose(const RigidWay& way, Wide parameter) {
    const Wide halfAngle = way.halfAngle;
    const Wide done = wideMultiply(parameter, halfAngle);
    // Sine and cosine of half the angle so far, and of half the remaining angle.
    Wide found[4];
    ROLLED for (int i = 0; i < 4; ++i) {
        Wide angle = done;
        if (i >= 2) {
            angle = wideSubtract(halfAngle, done);
        }
        Wide last = RIGID_LAST_OF_COSINE;
        Wide by = PAIR_ONE;
        if (i % 2 == 0) {
            last = RIGID_LAST_OF_SINE;
            by = angle;
        }
        found[i] = wideMultiply(by, rigidSeries(wideMultiply(angle, angle), last));
    }
    Wide share = parameter; // of the chord that the centre has gone
    if (wideLess(PAIR_ZERO, way.perSine)) {
        share = wideMultiply(found[0], way.perSine);
    }
    // Sums of two products each.
    const Wide none = PAIR_ZERO;
    const Wide left[12] = {found[0], found[0], found[0], found[0], share,    none,
                           share,    none,     found[1], found[0], found[0], found[1]};
    const Wide right[12] = {found[1],
                            found[1],
                            found[0],
                            found[0],
                            found[3],
                            none,
                            rigidNegated(found[2]),
                            none,
                            found[3],
                            found[2],
                            found[3],
                            rigidNegated(found[2])};
    Wide sum[6]; // sin(t * angle), 1 - cos(t * angle), along and across the chord, the cosine and sine of a speed
    ROLLED for (int i = 0; i < 6; ++i) {
        sum[i] = wideAdd(wideMultiply(left[2 * i], right[2 * i]), wideMultiply(left[2 * i + 1], right[2 * i + 1]));
    }
    const Wide ofPlace[6] = {PAIR_ONE, sum[0], sum[1], parameter, sum[2], sum[3]};
    const Wide ofSpeed[6] = {PAIR_ONE, sum[4], sum[5], none, none, none};
    RigidPose pose;
    ROLLED for (uint number = 0; number < RIGID_NUMBERS; ++number) {
        Wide all = way.term[RIGID_TERMS * number]; // once
        ROLLED for (uint term = 1; term < RIGID_TERMS; ++term) {
            Wide by = ofPlace[term];
            if (number >= RIGID_SPEED) {
                by = ofSpeed[term];
            }
            all = wideAdd(all, wideMultiply(by, way.term[RIGID_TERMS * number + term]));
        }
        pose.number[number] = all;
    }
    return pose;
}

EXACT WideMatrix rigidMatrix(RigidPose pose) {
    WideMatrix matrix;
    ROLLED for (uint i = 0; i < 16; ++i) {
        matrix.element[i] = PAIR_ZERO;
        if (i % 4 < 3) {
            matrix.element[i] = pose.number[3 * (i / 4) + i % 4];
        }
    }
    matrix.element[15] = PAIR_ONE;
    return matrix;
}

#include "exact_language.h"

} // namespace voxtact::shader

#endif

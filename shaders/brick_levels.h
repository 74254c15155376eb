// SPDX-License-Identifier: MIT
// Where the ranges of a volume's bricks lie, and those of what is above them: level 0 are the bricks, and a node of any
// other level has 2^3 of the one below. One text for GLSL and C++. Expects VOXTACT_BRICK_SHIFT.
#ifndef VOXTACT_BRICK_LEVELS_H
#define VOXTACT_BRICK_LEVELS_H

/// A node is 2^VOXTACT_LEVEL_SHIFT nodes of the level below a side.
#define VOXTACT_LEVEL_SHIFT 1
/// Enough for a highest level of one node: no device has 3D images of 2^17 voxels along an axis.
#define VOXTACT_MOST_LEVELS 15

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

struct BrickLevel {
    int countX, countY, countZ; // nodes along each axis; x is fastest
    int first;                  // of the nodes of all levels, one level after the other
};

/// Of a volume of so many voxels.
EXACT BrickLevel brickLevel(int sizeX, int sizeY, int sizeZ, int level) {
    BrickLevel found;
    found.countX = 0;
    found.countY = 0;
    found.countZ = 0;
    found.first = 0;
    for (int i = 0; i <= level; ++i) {
        found.first += found.countX * found.countY * found.countZ;
        const int shift = VOXTACT_BRICK_SHIFT + VOXTACT_LEVEL_SHIFT * i;
        found.countX = (sizeX >> shift) + 1;
        found.countY = (sizeY >> shift) + 1;
        found.countZ = (sizeZ >> shift) + 1;
    }
    return found;
}

/// How many levels a volume has.
EXACT int brickLevels(int sizeX, int sizeY, int sizeZ) {
    int levels = 1;
    int shift = VOXTACT_BRICK_SHIFT;
    while (levels < VOXTACT_MOST_LEVELS && ((sizeX | sizeY | sizeZ) >> shift) > 0) {
        shift += VOXTACT_LEVEL_SHIFT;
        ++levels;
    }
    return levels;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif

// SPDX-License-Identifier: MIT
// Where clearances are measured: what of a brick is first on a way. Expects certified_clearance_bits.glsl.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_WAY_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_WAY_GLSL

/// Of a row of cells of the brick, the first on a way: its place along the row.
int firstOf(uint row, float along) {
    return along < 0.0 ? findMSB(row) : findLSB(row);
}

/// What of a brick is first on a way, about its middle: the cells, -1 where there is none.
struct First {
    float least; // of all that may be opaque
    int may;
    int has; // of those that certainly have something
};

First firstOnWay(uint z, VoxelPoint pulled) {
    First first = First(3.0e38, -1, -1);
    float leastHas = 3.0e38;
    for (uint word = 0; word < kCellWords; ++word) {
        const uint may = mayBits(z, word);
        const uint has = hasBits(z, word);
        for (uint y = 0; y < 4; ++y) {
            const uint mayRow = may >> 8 * y & 0xffu;
            const uint hasRow = has >> 8 * y & 0xffu;
            const float row = pulled.y * (float(4 * (word & 1u) + y) + 0.5 - MARGIN_BRICK_RADIUS) +
                              pulled.z * (float(word >> 1) + 0.5 - MARGIN_BRICK_RADIUS);
            const int mayX = firstOf(mayRow, pulled.x);
            const float mayHere = row + pulled.x * (float(mayX) + 0.5 - MARGIN_BRICK_RADIUS);
            if (mayRow != 0 && mayHere < first.least) {
                first.least = mayHere;
                first.may = int(32 * word + 8 * y) + mayX;
            }
            const int hasX = firstOf(hasRow, pulled.x);
            const float hasHere = row + pulled.x * (float(hasX) + 0.5 - MARGIN_BRICK_RADIUS);
            if (hasRow != 0 && hasHere < leastHas) {
                leastHas = hasHere;
                first.has = int(32 * word + 8 * y) + hasX;
            }
        }
    }
    first.least += marginBoxShadow(pulled, voxelPoint(0.5, 0.5, 0.5));
    return first;
}

#endif

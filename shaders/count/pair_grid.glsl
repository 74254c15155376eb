// SPDX-License-Identifier: MIT
// What a batch item has for the pass that makes pairs of poses, read from `words`: of each double the low word first.
#ifndef VOXTACT_PAIR_GRID_GLSL
#define VOXTACT_PAIR_GRID_GLSL

#include "exact/exact_language.h"

Wide wideAt(uint word) {
    return wideBits(words[word + 1], words[word]);
}

WideMatrix matrixAt(uint word) {
    WideMatrix matrix;
    ROLLED for (int i = 0; i < 16; ++i) {
        matrix.element[i] = wideAt(word + 2 * i);
    }
    return matrix;
}

/// Reads the grid of an item that begins at a word.
PairOrigin originAt(uint word) {
    PairOrigin origin;
    const uint at = word + VOXTACT_SETUP_ORIGIN;
    ROLLED for (int i = 0; i < 3; ++i) {
        origin.offset[i] = wideAt(at + 2 * i);
    }
    origin.rounding = wideAt(at + 6);
    return origin;
}

PairGrid gridAt(uint word) {
    PairGrid grid;
    grid.texture_from_world = matrixAt(word);
    uint at = word + 32;
    ROLLED for (int i = 0; i < 3; ++i) {
        grid.size[i] = wideAt(at + 2 * i);
        grid.sign[i] = wideAt(at + 6 + 2 * i);
        grid.lessOrigin[i] = wideAt(at + 12 + 2 * i);
        grid.halfSpacing[i] = wideAt(at + 18 + 2 * i);
        grid.axis[i] = words[at + 48 + i];
    }
    ROLLED for (int i = 0; i < 12; ++i) {
        grid.share[i] = wideAt(at + 24 + 2 * i);
    }
    grid.aligned = words[at + 51];
    return grid;
}

#include "exact/exact_language.h"

#endif

// SPDX-License-Identifier: MIT
// Expects `volume`.
#ifndef VOXTACT_STORED_GLSL
#define VOXTACT_STORED_GLSL

/// The integer behind a UNORM or SNORM texel, or the float. `unit` is the integer behind 1.0; 0 for floats.
float storedVoxel(ivec3 voxel, float unit) {
    precise float texel = texelFetch(volume, voxel, 0).r;
    precise float scaled = texel * unit;
    precise float rounded = scaled + 0.5;
    return unit > 0.0 ? floor(rounded) : texel;
}

#endif

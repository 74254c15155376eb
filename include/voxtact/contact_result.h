// SPDX-License-Identifier: MIT
// One definition for C++ and GLSL: include it from a shader to read the contacts on the device.
#ifndef VOXTACT_CONTACT_RESULT_H
#define VOXTACT_CONTACT_RESULT_H

#ifdef __cplusplus
#include <cstdint>
namespace voxtact {
#define VOXTACT_UINT std::uint32_t
#else
#define VOXTACT_UINT uint
#endif

/// A contact on the device, 48 bytes; std430. See Contact in outputs.h for what the members mean.
struct ContactResult {
    float x;               ///< world, mm
    float y;               ///< world, mm
    float z;               ///< world, mm
    float nx;              ///< unit vector, or zero
    float ny;              ///< normal, unit vector or zero
    float nz;              ///< normal, unit vector or zero
    float depth;           ///< mm
    float value;           ///< of the image, in its own units
    float opacity;         ///< of that value, 0..1
    VOXTACT_UINT pair;     ///< number of the pair in its batch
    VOXTACT_UINT triangle; ///< number in the mesh
    VOXTACT_UINT label;    ///< number of the label in LabelData::values; 0 without a label map
};

/// The bits of the float behind a word of Results::bounds().
#define VOXTACT_BOUND_BITS(word) (((word)&0x80000000u) != 0u ? (word) ^ 0x80000000u : ~(word))

#ifdef __cplusplus
#undef VOXTACT_UINT
static_assert(sizeof(ContactResult) == 48);
} // namespace voxtact
#endif

#endif

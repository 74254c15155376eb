// SPDX-License-Identifier: MIT
// The answers in device memory. One definition for C++ and GLSL: include it from a shader to read them there.
#ifndef VOXTACT_DEVICE_RESULTS_H
#define VOXTACT_DEVICE_RESULTS_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace voxtact {
#define VOXTACT_UINT std::uint32_t
#define VOXTACT_TOTAL std::uint64_t
#else
#define VOXTACT_UINT uint
#define VOXTACT_TOTAL uvec2 // low word, high word
#endif

/// The answer for one pair, 24 bytes, the same layout for every counting method. In GLSL declare the buffer with
/// std430. The pair collides when countLow or countHigh is not zero. In the projection `certified` a survivor is a
/// triangle that certainly has an opaque point in a voxel cell, counted once for each of its cells; a pair whose count
/// is zero may still touch when VOXTACT_HOW_UNDECIDED(how) is not zero.
struct PairResult {
    VOXTACT_UINT countLow;  ///< survivors, low 32 bits. With DetectorDesc::stopAtFirst 0 or 1; by `query-any` only
                            ///< whether it is zero means something
    VOXTACT_UINT countHigh; ///< survivors, high 32 bits
    VOXTACT_UINT pair;      ///< number of the pair in its batch
    VOXTACT_UINT item;      ///< number of the BatchItem that the pair came from
    VOXTACT_UINT pose;      ///< number of the pose within that item
    VOXTACT_UINT how;       ///< VOXTACT_HOW_*: counting method, projection and exactness of the count
};

// PairResult.how = method | projection << 8 | exactness << 16, the numbers being those of CountingMethod, Projection
// and Exactness in methods.h.
#define VOXTACT_HOW_METHOD(how) ((how)&0xffu)
#define VOXTACT_HOW_PROJECTION(how) (((how) >> 8) & 0xffu)
#define VOXTACT_HOW_EXACTNESS(how) (((how) >> 16) & 0xffu)
/// Not zero: some fragment of the projection `certified` could be neither proven nor excluded.
#define VOXTACT_HOW_UNDECIDED(how) (((how) >> 24) & 1u)
#define VOXTACT_HOW_UNDECIDED_BIT 0x1000000u
/// VOXTACT_HOW_EXACTNESS() of a pose on the device that cannot be used.
#define VOXTACT_EXACTNESS_REFUSED 2u

/// A contact on the device, 48 bytes; std430. See Contact in results.h for what the members mean.
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

/// What the passes of the projection `certified` by `compute` did for a batch; 152 bytes, std430. They are described
/// in the manual, "The certified engine on a device". Of each peak: in the round that had most.
struct CertifiedCounters {
    VOXTACT_TOTAL clusters;     ///< of 64 triangles, once for each pair, that were examined
    VOXTACT_TOTAL clustersKept; ///< of these, may touch
    VOXTACT_TOTAL runsKept;     ///< of 16 triangles, may touch
    VOXTACT_TOTAL largeParts;   ///< shares of triangles with more than 27 cells
    VOXTACT_TOTAL bricksSeen;   ///< of these triangles, examined
    VOXTACT_TOTAL cellsSeen;    ///< of all triangles in bricks that may be opaque, examined
    VOXTACT_TOTAL cellsListed;  ///< of these, need a decision
    VOXTACT_TOTAL cellsCertain; ///< of cellsSeen, count without one: opaque all over, and a triangle clearly in them
    VOXTACT_TOTAL cellsDecided; ///< by a lane each; the others are of pairs that touch anyway, or had no room
    VOXTACT_TOTAL lanes;        ///< dispatched for them
    VOXTACT_TOTAL cellsOpen;    ///< of these, left undecided by single precision
    VOXTACT_TOTAL left;         ///< what a queue had no room for: shares of work groups
    VOXTACT_TOTAL bricksLeft;   ///< examined for these
    VOXTACT_TOTAL cellsLeft;    ///< examined for these, and decided where they need it
    VOXTACT_UINT rounds;        ///< dispatches of each pass
    VOXTACT_UINT room;          ///< clusters that a round can have: ResultsDesc::clustersAtOnce
    VOXTACT_UINT mostClusters;  ///< peak of clustersKept
    VOXTACT_UINT mostRuns;      ///< peak of runsKept
    VOXTACT_UINT mostParts;     ///< peak of largeParts, those without room among them
    VOXTACT_UINT mostCells;     ///< peak of cellsListed, those without room among them
    VOXTACT_UINT mostOpen;      ///< peak of cellsOpen
    VOXTACT_UINT mostLeft;      ///< peak of left
    VOXTACT_UINT mostLooks;     ///< peak of bricksSeen and cellsSeen together
    VOXTACT_UINT mostLooksLeft; ///< peak of bricksLeft and cellsLeft together
};

/// The bits of the float behind a word of Results::bounds().
#define VOXTACT_BOUND_BITS(word) (((word)&0x80000000u) != 0u ? (word) ^ 0x80000000u : ~(word))

#ifdef __cplusplus
#undef VOXTACT_UINT
#undef VOXTACT_TOTAL
static_assert(sizeof(PairResult) == 24);
static_assert(offsetof(PairResult, countLow) == 0 && offsetof(PairResult, countHigh) == 4,
              "a 64-bit query result is copied over countLow and countHigh");
static_assert(sizeof(ContactResult) == 48);
static_assert(sizeof(CertifiedCounters) == 152);
} // namespace voxtact
#endif

#endif

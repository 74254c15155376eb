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

/// The answer for one pair, 24 bytes, with the same layout for every counting method. In GLSL, declare the buffer with
/// std430. The pair touches if countLow or countHigh is not zero. The projection `certified` counts a triangle once for
/// each voxel cell in which it certainly has an opaque point. A pair whose count is zero may still touch if
/// VOXTACT_HOW_UNDECIDED(how) is not zero.
struct PairResult {
    VOXTACT_UINT countLow;  ///< passing fragments, low 32 bits; by `query-any` or early exit: zero or not
    VOXTACT_UINT countHigh; ///< passing fragments, high 32 bits
    VOXTACT_UINT pair;      ///< index of the pair in its batch
    VOXTACT_UINT item;      ///< index of the BatchItem of the pair
    VOXTACT_UINT pose;      ///< index of the pose in that item
    VOXTACT_UINT how;       ///< VOXTACT_HOW_*: counting method, projection and exactness of the count
};

// PairResult.how = method | projection << 8 | exactness << 16. The numbers are those of CountingMethod, Projection and
// Exactness in methods.h.
#define VOXTACT_HOW_METHOD(how) ((how)&0xffu)
#define VOXTACT_HOW_PROJECTION(how) (((how) >> 8) & 0xffu)
#define VOXTACT_HOW_EXACTNESS(how) (((how) >> 16) & 0xffu)
/// Not zero if some fragment of the projection `certified` is undecided.
#define VOXTACT_HOW_UNDECIDED(how) (((how) >> 24) & 1u)
#define VOXTACT_HOW_UNDECIDED_BIT 0x1000000u
/// VOXTACT_HOW_EXACTNESS() of an unusable pose on the device.
#define VOXTACT_EXACTNESS_REFUSED 2u

/// A contact on the device, 48 bytes; std430. Contact in results.h describes the members.
struct ContactResult {
    float x;               ///< world, mm
    float y;               ///< world, mm
    float z;               ///< world, mm
    float nx;              ///< normal, unit vector or zero
    float ny;              ///< normal, unit vector or zero
    float nz;              ///< normal, unit vector or zero
    float depth;           ///< mm
    float value;           ///< image value, in its own units
    float opacity;         ///< opacity of that value, 0..1
    VOXTACT_UINT pair;     ///< index of the pair in its batch
    VOXTACT_UINT triangle; ///< index of the triangle in the mesh
    VOXTACT_UINT label;    ///< index of the label in LabelData::values; 0 without a label map
};

/// Counters of the passes of the projection `certified` by `compute` for a batch; 152 bytes, std430. The manual
/// describes the passes in "The certified engine on a device". A peak is the maximum over all rounds.
struct CertifiedCounters {
    VOXTACT_TOTAL clusters;     ///< tested clusters of 64 triangles, counted once per pair
    VOXTACT_TOTAL clustersKept; ///< tested clusters that may touch
    VOXTACT_TOTAL runsKept;     ///< runs of 16 triangles that may touch
    VOXTACT_TOTAL largeParts;   ///< shares of triangles with more than 27 cells
    VOXTACT_TOTAL bricksSeen;   ///< tested bricks of these triangles
    VOXTACT_TOTAL cellsSeen;    ///< tested cells of all triangles, in bricks that may be opaque
    VOXTACT_TOTAL cellsListed;  ///< of cellsSeen: cells that need a decision
    VOXTACT_TOTAL cellsCertain; ///< of cellsSeen: opaque, with a triangle clearly inside; counted without a decision
    VOXTACT_TOTAL cellsDecided; ///< of cellsListed: decided by a lane; others: the pair already touches, or no room
    VOXTACT_TOTAL lanes;        ///< lanes dispatched for these cells
    VOXTACT_TOTAL cellsOpen;    ///< of cellsDecided: cells that single precision left undecided
    VOXTACT_TOTAL left;         ///< shares of work groups for which a queue had no room
    VOXTACT_TOTAL bricksLeft;   ///< bricks tested for these shares
    VOXTACT_TOTAL cellsLeft;    ///< cells tested for these shares, and decided if needed
    VOXTACT_UINT rounds;        ///< dispatches of each pass
    VOXTACT_UINT room;          ///< maximum number of clusters in a round: ResultsDesc::clustersAtOnce
    VOXTACT_UINT peakClusters;  ///< peak of clustersKept
    VOXTACT_UINT peakRuns;      ///< peak of runsKept
    VOXTACT_UINT peakParts;     ///< peak of largeParts, including parts without room
    VOXTACT_UINT peakCells;     ///< peak of cellsListed, including cells without room
    VOXTACT_UINT peakOpen;      ///< peak of cellsOpen
    VOXTACT_UINT peakLeft;      ///< peak of left
    VOXTACT_UINT peakTests;     ///< peak of bricksSeen and cellsSeen together
    VOXTACT_UINT peakTestsLeft; ///< peak of bricksLeft and cellsLeft together
};

/// Bits of the float in a word of Results::bounds().
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

// SPDX-License-Identifier: MIT
// Structs shared by GLSL and C++, one definition each.
#ifndef VOXTACT_SHARED_H
#define VOXTACT_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstddef>
#include <cstdint>
namespace voxtact::shader {
using uint = std::uint32_t;
using vec4 = std::array<float, 4>;
#endif

/// Inputs of the vertex shader for one pair; element `pair` of a std430 buffer. A projection with several views has one
/// element per view, consecutive for each pair.
struct PairTransform {
    vec4 clip_from_object[4];    // rows
    vec4 texture_from_object[3]; // its first three rows: affine
};

/// Inputs of the fragment program for one batch item.
struct ItemConstants {
    float scalarScale; // normalised scalar = scalarScale * sample + scalarBias; a sample is a texel (hardware filter)
    float scalarBias;  // or the stored value behind it (exact filter)
    float threshold;
    float storedUnit; // the integer behind 1.0 of a normalised texel; 0 for float texels
};

/// The fragment program's push constants.
struct RasterConstants {
    ItemConstants item;
    uint firstTriangle; // of the draw
};

/// Layout of a mesh in its storage buffers.
struct MeshConstants {
    uint vertexOffset; // of the first position, in floats
    uint vertexStride; // in floats
    uint indexOffset;  // in bytes
    uint indexBytes;   // 2, 4, or 0: not indexed
};

/// The pixel grid of the projection `dominant-axis`.
struct DominantGrid {
    float sizeX; // voxels
    float sizeY;
    float sizeZ;
    float clipScale; // clip = clipScale * voxels - 1
};

/// Inputs of the vertex shader of `dominant-axis` for one batch item: push constants after the fragment program's.
struct DominantConstants {
    DominantGrid grid;
    MeshConstants mesh;
};

/// Push constants of the compute path.
struct ComputeConstants {
    ItemConstants item;
    float guardX; // EXACT_GUARD_PIXELS in units of half the viewport
    float guardY;
    int width; // of the viewport
    int height;
    uint firstTransform;
    uint firstTriangle; // of the dispatch
    uint triangleCount; // of the mesh
    MeshConstants mesh;
    DominantGrid grid; // of the projection `dominant-axis`
    uint rangeTest;    // 0: clamp
};

/// Push constants of the pass that sums the counters: shaders/touch/certified_tally.comp.
struct TallyConstants {
    uint queueWord; // as in CertifiedConstants
    uint queueRoom;
    uint rounds; // whose headers it is to count
};

/// Push constants of the pass that turns poses into pairs: shaders/count/pair_setup.comp.
struct PairSetupConstants {
    uint firstPair; // of the dispatch
    uint pairs;
    uint item;
    uint firstPose; // of the dispatch, in the item
    uint how;       // of the results: VOXTACT_HOW_*
    uint refused;   // the same for unusable poses
    uint poseWord;  // of the words of the poses, where the first is
    uint poseWords; // from one to the next
    uint setupWord; // offset of the item's constants
    uint views;     // that a pair has; 0 by the projection `certified`
};

/// Push constants of the brick pass.
struct BrickConstants {
    int firstX, firstY, firstZ; // the brick of work group (0, 0, 0)
    float storedUnit;           // as in ItemConstants
};

/// Push constants of the pass that edits voxels.
struct EditConstants {
    uint rowTexels; // of each row
    uint rows;
    uint texelBytes; // 1, 2 or 4
    uint value;      // the texel, as often as it fits
};

/// Push constants of the pass that fits a mesh's clusters: shaders/scene/mesh_refit.comp.
struct RefitConstants {
    MeshConstants mesh;
    uint triangleCount;
    uint clusterWord;   // as in CertifiedConstants, of the buffer that the pass writes
    uint copiesIndices; // not 0: to the beginning of that buffer, 32 bits each
};

/// One passing fragment of a pair.
struct TracedFragment {
    uint triangle;
    uint x;
    uint y;
};

/// Inputs of the projection `certified` for one pair; element `pair` of a std430 buffer.
struct CertifiedPair {
    vec4 reference;               // a point of object space near the volume; w: see `place`
    vec4 voxel_from_reference[3]; // rows: voxel space from object space less the reference. Voxel i's centre is at i
    vec4 error;                   // of a transformed vertex, (x, y, z) from the reference, in voxels along each axis:
                                  // error * (|x|, |y|, |z|, 1)
    vec4 place[9]; // rows: from object space to `scale` of CertifiedItem times the place along an axis, from the near
                   // face of the domain; of each the sum of three, [axis], [3 + axis] and [6 + axis]. It is off by at
                   // most reference.w of what `error` says
};

/// Inputs for one batch item. The entry of a stored value is entryScale * (stored - storedReference): a coordinate in
/// which single precision does not overflow, and is most exact near an end of the opaque values.
struct CertifiedItem {
    float entryScale;      // a power of two; 1 for integers
    float storedReference; // an end of the opaque values, for integers up to 1/2
    float storedUnit;      // the integer behind 1.0 of a normalised texel; 0 for float texels
    float threshold;
    float resolution; // voxels
    int outer;        // those of OpaqueValues (opaque_values.h)
    int inner;
    int points;
    int sizeX; // voxels
    int sizeY;
    int sizeZ;
    float scale[9]; // of the places that `place` of CertifiedPair gives: in units per voxel; three parts, as there
};

/// Push constants of the projection `certified`, of all its passes.
struct CertifiedConstants {
    CertifiedItem item;
    MeshConstants mesh;
    uint triangleCount;
    uint clusterWord; // of the words of the index buffer, where the clusters are: the box of each, lo and hi, those of
                      // the runs, and then the triangles, run by run; VOXTACT_NO_CLUSTERS where the mesh has none there
    uint firstPair;   // of the round
    uint firstCluster;
    uint endCluster;
    uint queueWord;  // of the words of the transforms' buffer, where the queues begin
    uint headerWord; // where the round's queue headers are
    uint queueRoom;  // clusters; that of the other queues follows from it
};

#define VOXTACT_NO_CLUSTERS 0xffffffffu
/// Triangles of a cluster, and of each of its runs: src/core/geometry/clusters.h.
#define VOXTACT_CLUSTER_TRIANGLES 64
#define VOXTACT_RUN_TRIANGLES 16
#define VOXTACT_CLUSTER_RUNS (VOXTACT_CLUSTER_TRIANGLES / VOXTACT_RUN_TRIANGLES)

/// Maximum numbers of OpaqueValues (opaque_values.h) of an item, stored before the queues.
#define VOXTACT_OPAQUE_WORDS 16384
// The queues of the projection `certified` lie behind the transforms, in the same buffer: headers for some rounds, and
// then the queues, which each round uses again. A header has for each queue the VkDispatchIndirectCommand of the pass
// that empties it, and its number of entries.
#define VOXTACT_QUEUE_CLUSTERS 0 // pair, cluster: for certified_refine
#define VOXTACT_QUEUE_RUNS 1     // pair, run: for certified_expand
#define VOXTACT_QUEUE_LARGE 2    // pair, triangle, part, parts: for certified_large
#define VOXTACT_QUEUE_CELLS 3    // pair, triangle, place: for certified_decide
#define VOXTACT_QUEUE_OPEN 4     // numbers of cells: for certified_finish
#define VOXTACT_QUEUE_LEFT 5     // VOXTACT_LEFT_* and number, brick, work groups, 0: the same
#define VOXTACT_QUEUES 6
#define VOXTACT_HEADER_WORDS 32 // of a round
#define VOXTACT_HEADERS 64
// After the queues of a header: the counters (CertifiedCounters), if enabled.
#define VOXTACT_WORK_CLUSTERS 24    // examined
#define VOXTACT_WORK_BRICKS 25      // of large triangles, examined
#define VOXTACT_WORK_CELLS 26       // examined
#define VOXTACT_WORK_DECIDED 27     // lanes in use
#define VOXTACT_WORK_BRICKS_LEFT 28 // examined by certified_finish, where a queue had no room
#define VOXTACT_WORK_CELLS_LEFT 29  // the same
#define VOXTACT_GROUPS_LEFT 30      // work groups of certified_finish that the entries of VOXTACT_QUEUE_LEFT ask for
#define VOXTACT_WORK_CERTAIN 31     // cells that count without a decision
// The CertifiedCounters of a batch, behind the headers.
#define VOXTACT_WORD_COUNTERS (VOXTACT_HEADERS * VOXTACT_HEADER_WORDS)
#define VOXTACT_COUNTER_WORDS 38
// Entries of each.
#define VOXTACT_ROOM_RUNS(room) ((room)*VOXTACT_CLUSTER_RUNS)
#define VOXTACT_ROOM_LARGE(room) ((room) / 4)
#define VOXTACT_ROOM_CELLS(room) ((room)*32)
#define VOXTACT_ROOM_LEFT(room) ((room)*2 + VOXTACT_ROOM_LARGE(room))
// Offset of each, in words after the first header. `room` is a multiple of 16.
#define VOXTACT_WORD_CELLS ((VOXTACT_WORD_COUNTERS + VOXTACT_COUNTER_WORDS + 3) / 4 * 4)
#define VOXTACT_WORD_LARGE(room) (VOXTACT_WORD_CELLS + 4 * VOXTACT_ROOM_CELLS(room))
#define VOXTACT_WORD_OPEN(room) (VOXTACT_WORD_LARGE(room) + 4 * VOXTACT_ROOM_LARGE(room))
#define VOXTACT_WORD_CLUSTERS(room) (VOXTACT_WORD_OPEN(room) + VOXTACT_ROOM_CELLS(room))
#define VOXTACT_WORD_RUNS(room) (VOXTACT_WORD_CLUSTERS(room) + 2 * (room))
#define VOXTACT_WORD_LEFT(room) (VOXTACT_WORD_RUNS(room) + 2 * VOXTACT_ROOM_RUNS(room))
// After all queues: blocks of overflow entries, with the sum of their work groups.
#define VOXTACT_LEFT_BLOCK VOXTACT_COMPUTE_GROUP
#define VOXTACT_WORD_LEFT_BLOCKS(room) (VOXTACT_WORD_LEFT(room) + 4 * VOXTACT_ROOM_LEFT(room))
#define VOXTACT_ROOM_LEFT_BLOCKS(room) ((room) / 16)
#define VOXTACT_QUEUE_WORDS(room) (VOXTACT_WORD_LEFT_BLOCKS(room) + VOXTACT_ROOM_LEFT_BLOCKS(room))
// Overflow entry of certified_finish, if the queue of cells or of large triangles was full: a number and its kind.
#define VOXTACT_LEFT_SMALL 0  // the small triangles of a work group of certified_expand
#define VOXTACT_LEFT_GROUP 1  // its large ones
#define VOXTACT_LEFT_LARGE 2  // an entry of the queue of large triangles, from a brick on
#define VOXTACT_LEFT_SHIFT 28 // these are above so many bits of a number
// The command of certified_finish for what is left has as many layers as it takes, each of VOXTACT_LEFT_COLUMNS times
// VOXTACT_LEFT_ROWS work groups. The other one has one row: so it knows which it is. No work group has two turns: a
// loop over these could be cut (certified_scene.glsl), and what it had not come to would be missed.
#define VOXTACT_LEFT_COLUMNS 1024
#define VOXTACT_LEFT_ROWS 2
#define VOXTACT_LEFT_LAYER (VOXTACT_LEFT_COLUMNS * VOXTACT_LEFT_ROWS)
#define VOXTACT_LEFT_MOST_LAYERS 65535u // Vulkan's least maxComputeWorkGroupCount
// Looks of a round at bricks and cells, at most: where triangles are known, and for each cluster of a search's room.
// With those at small triangles, counters of a round have 32 bits.
#define VOXTACT_MOST_LOOKS 3500000000.0
#define VOXTACT_LOOKS_OF_CLUSTER 65536
// Maximum work groups of certified_finish for overflow, per cluster of the capacity, if triangles are unknown to the
// host.
#define VOXTACT_GROUPS_OF_CLUSTER 4096

// Descriptor sets.
#define VOXTACT_SET_VOLUME 0
#define VOXTACT_SET_TRANSFER_FUNCTION 1
#define VOXTACT_SET_PAIRS 2
#define VOXTACT_SET_MESH 3
#define VOXTACT_SET_LABELS 4 // with outputs in addition to the counts
// Bindings of VOXTACT_SET_VOLUME, beside the image at 0.
#define VOXTACT_BINDING_BRICKS 1
// Bindings of VOXTACT_SET_PAIRS.
#define VOXTACT_BINDING_TRANSFORMS 0
#define VOXTACT_BINDING_RESULTS 1
#define VOXTACT_BINDING_OUTPUT_PAIRS 2 // with outputs in addition to the counts
#define VOXTACT_BINDING_OUTPUTS 3
// Bindings of VOXTACT_SET_MESH.
#define VOXTACT_BINDING_VERTICES 0
#define VOXTACT_BINDING_INDICES 1
// Additional binding of the pass that fits the clusters: its output words.
#define VOXTACT_BINDING_CLUSTERS 2
// Sets of the pass that turns poses into pairs, and the bindings of the first.
#define VOXTACT_SET_SETUP 0
#define VOXTACT_SET_SETUP_POSES 1
#define VOXTACT_BINDING_SETUP_TRANSFORMS 0
#define VOXTACT_BINDING_SETUP_RESULTS 1
#define VOXTACT_BINDING_SETUP_ITEMS 2
/// Words of an item's constants, and items at once.
#define VOXTACT_SETUP_WORDS 128
/// Offset of the PairOrigin of the item's mesh in these words.
#define VOXTACT_SETUP_ORIGIN 96
#define VOXTACT_SETUP_ITEMS 16
/// A pose of the host's: 16 doubles.
#define VOXTACT_HOST_POSE_WORDS 32
// Bindings of the pass that edits voxels.
#define VOXTACT_BINDING_EDIT_ROWS 0
#define VOXTACT_BINDING_EDIT_TEXELS 1
// The list of passing fragments, after VOXTACT_SET_PAIRS.
#define VOXTACT_SET_TRACE 3
// Specialization constants.
#define VOXTACT_CONSTANT_RANGE_TEST 0
#define VOXTACT_CONSTANT_CARRY 1
#define VOXTACT_CONSTANT_EXACT_FILTER 2
#define VOXTACT_CONSTANT_VIEWS 3
#define VOXTACT_CONSTANT_DOMINANT_AXIS 4
#define VOXTACT_CONSTANT_STOP_AT_FIRST 5
#define VOXTACT_CONSTANT_COUNTERS 6
#define VOXTACT_CONSTANT_OUTPUTS 16
// Offset of the push constants of dominant.vert, after those of the fragment program.
#define VOXTACT_OFFSET_DOMINANT 96
// Lanes of a work group of the compute path.
#define VOXTACT_COMPUTE_GROUP 64
// Lanes of a work group of the brick pass.
#define VOXTACT_BRICK_GROUP 64
// A brick is 2^VOXTACT_BRICK_SHIFT cells per side: src/core/volume/bricks.h.
#define VOXTACT_BRICK_SHIFT 3

#ifdef __cplusplus
static_assert(sizeof(PairTransform) == 112 && offsetof(PairTransform, texture_from_object) == 64);
static_assert(sizeof(ItemConstants) == 16);
static_assert(sizeof(MeshConstants) == 16 && sizeof(DominantGrid) == 16);
static_assert(sizeof(RasterConstants) == 20 && sizeof(RasterConstants) <= VOXTACT_OFFSET_DOMINANT);
static_assert(VOXTACT_OFFSET_DOMINANT + sizeof(DominantConstants) <= 128, "Vulkan's least maxPushConstantsSize");
static_assert(sizeof(ComputeConstants) == 80);
static_assert(sizeof(CertifiedPair) == 224);
static_assert(sizeof(CertifiedItem) == 80);
static_assert(sizeof(CertifiedConstants) == 128, "Vulkan's least maxPushConstantsSize");
static_assert(4 * VOXTACT_QUEUES <= VOXTACT_WORK_CLUSTERS && VOXTACT_WORK_CERTAIN < VOXTACT_HEADER_WORDS);
static_assert(VOXTACT_WORD_CELLS % 4 == 0 && VOXTACT_WORD_LEFT(16) % 4 == 0);
static_assert(VOXTACT_ROOM_LEFT(16) <= VOXTACT_LEFT_BLOCK * VOXTACT_ROOM_LEFT_BLOCKS(16));
static_assert(sizeof(BrickConstants) == 16);
static_assert(sizeof(RefitConstants) == 28);
} // namespace voxtact::shader
#endif

#endif

// SPDX-License-Identifier: MIT
// What the passes of the projection `certified` read, and how they find a triangle's cells. Expects
// VOXTACT_COMPUTE_GROUP lanes, and shared.h before it.
#ifndef VOXTACT_CERTIFIED_SCENE_GLSL
#define VOXTACT_CERTIFIED_SCENE_GLSL

layout(constant_id = VOXTACT_CONSTANT_STOP_AT_FIRST) const bool kStopAtFirst = false;
layout(constant_id = VOXTACT_CONSTANT_COUNTERS) const bool kCounters = false;

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_VOLUME, binding = VOXTACT_BINDING_BRICKS, std430) readonly buffer Bricks {
    vec4 bricks[]; // lo, hi, wideLo, wideHi
};
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = 0) uniform sampler1D transferFunction;
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    CertifiedPair transforms[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) buffer Results { PairResult results[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_VERTICES, std430) readonly buffer Vertices { float vertices[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_INDICES, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Item { CertifiedConstants constants; };

// One addition per work group: an unneeded carry costs nothing.
const bool kCarry = true;
const bool kYesNo = kStopAtFirst;

/// Bricks of the volume, along each axis.
ivec3 brickCounts() {
    return (ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) >> VOXTACT_BRICK_SHIFT) + 1;
}

#include "count/stored.glsl"
#include "exact/certified_overlap.h"
#include "count/count.glsl"
#include "certified_queues.glsl"
#include "scene/mesh.glsl"
#ifdef OUTPUTS
#include "count/survives.glsl"
#include "count/outputs.glsl"
#endif

/// A lane handles a triangle of at most this many cells; work groups share a larger one.
#define VOXTACT_CELLS_OF_A_LANE 27
const int kMostCellsOfALane = VOXTACT_CELLS_OF_A_LANE;
const int kBrickSide = 1 << VOXTACT_BRICK_SHIFT;

/// A box of cells, both ends inclusive, numbered from -1; or of bricks, from 0.
struct CellBox {
    ivec3 lo;
    ivec3 hi;
};

OpaqueValues opacities() {
    return OpaqueValues(constants.item.outer, constants.item.inner, constants.item.points, constants.item.threshold);
}

float opaqueNumber(OpaqueValues values, int index) {
    return uintBitsToFloat(queues[constants.queueWord - VOXTACT_OPAQUE_WORDS + uint(index)]);
}

CellBox cellsOf(CertifiedBounds bounds) {
    return CellBox(ivec3(bounds.firstX, bounds.firstY, bounds.firstZ), ivec3(bounds.lastX, bounds.lastY, bounds.lastZ));
}

bool isEmpty(CellBox box) {
    return any(lessThan(box.hi, box.lo));
}

CellBox bricksOf(CellBox cells) {
    return CellBox((cells.lo + 1) >> VOXTACT_BRICK_SHIFT, (cells.hi + 1) >> VOXTACT_BRICK_SHIFT);
}

int volumeOf(CellBox box) {
    const ivec3 size = box.hi - box.lo + 1;
    return size.x * size.y * size.z;
}

ivec3 placeIn(CellBox box, int number) {
    const ivec3 size = box.hi - box.lo + 1;
    const int row = number / size.x;
    return box.lo + ivec3(number % size.x, row % size.y, row / size.y);
}

/// Returns the number of a brick in the volume.
int numberOf(ivec3 brick) {
    const ivec3 count = brickCounts();
    return brick.x + count.x * (brick.y + count.y * brick.z);
}

vec4 brickAt(ivec3 brick) {
    return bricks[numberOf(brick)];
}

bool brickMayBeOpaque(vec4 range) {
    return certifiedRangeMayBeOpaque(opacities(), constants.item, range.x, range.y);
}

float storedAt(ivec3 voxel) {
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    return storedVoxel(clamp(voxel, ivec3(0), last), constants.item.storedUnit);
}

#include "exact/exact_language.h"

/// Returns the corners of a cell, with the range of only the voxels around it.
CertifiedCorners cornersAround(CertifiedCorners corners, ivec3 cell) {
    CertifiedCorners around = corners;
    around.wideLo = corners.wideHi;
    around.wideHi = corners.wideLo;
    ROLLED for (int i = 0; i < 64; ++i) {
        const float stored = storedAt(cell - 1 + ivec3(i & 3, (i >> 2) & 3, i >> 4));
        around.wideLo = certifiedMin(around.wideLo, stored);
        around.wideHi = certifiedMax(around.wideHi, stored);
    }
    if (!(around.wideLo <= around.wideHi)) {
        return corners; // none of them is a number
    }
    return around;
}

/// `range`: of the cell's brick.
CertifiedCorners cornersOf(ivec3 cell, vec4 range) {
    float stored[8];
    ROLLED for (int i = 0; i < 8; ++i) {
        stored[i] = storedAt(cell + ivec3(i & 1, (i >> 1) & 1, i >> 2));
    }
    return CertifiedCorners(stored[0], stored[1], stored[2], stored[3], stored[4], stored[5], stored[6], stored[7],
                            range.z, range.w);
}

#include "exact/exact_language.h"

/// The vertices of a triangle, in object space and in voxel space.
struct TriangleVertices {
    VoxelPoint object[3];
    CertifiedVertex voxel[3];
};

#include "exact/exact_language.h"

TriangleVertices verticesOf(CertifiedPair transform, uint triangle) {
    TriangleVertices at;
    ROLLED for (uint i = 0; i < 3; ++i) {
        const vec3 position = positionOf(constants.mesh, 3 * triangle + i);
        at.object[i] = voxelPoint(position.x, position.y, position.z);
        at.voxel[i] = certifiedVertex(transform, position.x, position.y, position.z);
    }
    return at;
}

#include "exact/exact_language.h"

CertifiedTriangle triangleOf(TriangleVertices at, float delta) {
    return certifiedTriangle(at.voxel[0].point, at.voxel[1].point, at.voxel[2].point, delta);
}

CertifiedBounds boundsOf(TriangleVertices at) {
    return certifiedBounds(constants.item, at.voxel[0], at.voxel[1], at.voxel[2]);
}

/// Also if the number of cells overflows.
bool isLarge(CellBox cells) {
    const ivec3 sides = cells.hi - cells.lo + 1;
    return any(greaterThan(sides, ivec3(kMostCellsOfALane))) || volumeOf(cells) > kMostCellsOfALane;
}

vec3 brickCentre(ivec3 brick) {
    return vec3((brick << VOXTACT_BRICK_SHIFT) - 1) + float(kBrickSide / 2);
}

/// Returns a box that contains all bricks of a box between two numbers.
CellBox bricksFrom(CellBox box, int first, int last) {
    CellBox found = CellBox(placeIn(box, first), placeIn(box, last));
    if (any(notEqual(found.lo.yz, found.hi.yz))) {
        found.lo.x = box.lo.x;
        found.hi.x = box.hi.x;
    }
    if (found.lo.z != found.hi.z) {
        found.lo.y = box.lo.y;
        found.hi.y = box.hi.y;
    }
    return found;
}

/// Returns the middle and half the sides of a box of bricks, in voxel space.
VoxelPoint middleOf(CellBox bricks) {
    const vec3 middle = 0.5 * (brickCentre(bricks.lo) + brickCentre(bricks.hi));
    return voxelPoint(middle.x, middle.y, middle.z);
}

VoxelPoint radiusOf(CellBox bricks) {
    const vec3 radius = vec3(bricks.hi - bricks.lo + 1) * float(kBrickSide / 2);
    return voxelPoint(radius.x, radius.y, radius.z);
}

CellBox within(CellBox cells, ivec3 brick) {
    const ivec3 corner = (brick << VOXTACT_BRICK_SHIFT) - 1;
    return CellBox(max(cells.lo, corner), min(cells.hi, corner + kBrickSide - 1));
}

/// Returns true if the triangle is probably too far away for any precision: certified_finish then needs only one test
/// of a brick that may be opaque.
bool isLost(CertifiedPair transform, CertifiedBounds bounds) {
    return !bounds.usable && !(bounds.delta * transform.reference.w <= CERTIFIED_MOST_DELTA);
}

/// Returns the number of work groups of certified_finish for an overflowed large triangle.
uint groupsOfTriangle(CertifiedPair transform, CertifiedBounds bounds, CellBox cells) {
    return isLost(transform, bounds) ? 1 : groupsOfBricks(uint(volumeOf(bricksOf(cells))));
}

/// Returns true if loops were cut: after 65,535 rounds of all loops of an invocation together, llvmpipe leaves every
/// loop after its first round (seen in Mesa 22.3). Later results are then invalid. The bound is 2, which compilers
/// cannot know.
bool isCut() {
    uint rounds = 0;
    while (rounds < 2u + (uint(constants.item.points) >> 30)) {
        ++rounds;
    }
    return rounds < 2u;
}

/// With stopAtFirst, further results of a pair with a passing fragment are useless.
bool isDone(uint pair) {
    return kStopAtFirst && results[pair].countLow > 0;
}

/// The triangle of that place in the mesh's runs.
uint triangleAt(uint place) {
    if (constants.clusterWord == VOXTACT_NO_CLUSTERS) {
        return place;
    }
    const uint clusters = (constants.triangleCount + VOXTACT_CLUSTER_TRIANGLES - 1) / VOXTACT_CLUSTER_TRIANGLES;
    const uint runs = (constants.triangleCount + VOXTACT_RUN_TRIANGLES - 1) / VOXTACT_RUN_TRIANGLES;
    return indices[constants.clusterWord + 6 * (clusters + runs) + place];
}

CertifiedBox boxAt(uint word) {
    return CertifiedBox(uintBitsToFloat(indices[word]), uintBitsToFloat(indices[word + 1]),
                        uintBitsToFloat(indices[word + 2]), uintBitsToFloat(indices[word + 3]),
                        uintBitsToFloat(indices[word + 4]), uintBitsToFloat(indices[word + 5]));
}

/// Returns the box of a cluster. Expects a mesh with clusters.
CertifiedBox boxOfCluster(uint number) {
    return boxAt(constants.clusterWord + 6 * number);
}

CertifiedBox boxOfRun(uint number) {
    return boxOfCluster((constants.triangleCount + VOXTACT_CLUSTER_TRIANGLES - 1) / VOXTACT_CLUSTER_TRIANGLES + number);
}

/// Returns the triangle of a lane in the passes with a lane per triangle: work group `group` has four entries of the
/// queue of runs. Includes pairs that are done.
struct TriangleLane {
    bool some; // false: there is none
    uint pair;
    uint run;
    uint number; // of the triangle
};

TriangleLane triangleLane(uint group, uint lane) {
    const uint entry = group * VOXTACT_CLUSTER_RUNS + lane / VOXTACT_RUN_TRIANGLES;
    TriangleLane own = TriangleLane(false, 0, 0, 0);
    if (entry < queueCount(VOXTACT_QUEUE_RUNS)) {
        const uint word = constants.queueWord + VOXTACT_WORD_RUNS(constants.queueRoom) + 2 * entry;
        own.run = queues[word + 1];
        const uint place = own.run * VOXTACT_RUN_TRIANGLES + lane % VOXTACT_RUN_TRIANGLES;
        own.pair = queues[word];
        own.some = place < constants.triangleCount;
        own.number = own.some ? triangleAt(place) : 0;
    }
    return own;
}

#include "exact/exact_language.h"

/// Returns true if a cell extends beyond the voxel centres: the domain ends in it.
bool isAtBorder(ivec3 cell) {
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    return any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, last));
}

/// Returns the verdict of the cheap tests of a fragment: CERTIFIED_NONE, CERTIFIED_UNDECIDED if it needs a decision, or
/// CERTIFIED_CERTAIN, only if no witness point is needed.
int fragmentVerdict(CertifiedTriangle triangle, ivec3 cell, vec4 range, bool single, bool witness) {
    const vec3 centre = vec3(cell) + 0.5;
    if (!single && certifiedPlaneMisses(triangle, voxelPoint(centre.x, centre.y, centre.z), 0.5)) {
        return CERTIFIED_NONE;
    }
    const CertifiedCell known =
        certifiedCell(constants.item, cornersOf(cell, range), cell.x, cell.y, cell.z, triangle.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return CERTIFIED_NONE;
    }
    if (certifiedCellAllOpaque(opacities(), known)) {
        return witness || isAtBorder(cell) ? CERTIFIED_UNDECIDED
                                           : certifiedOverlap(triangle, cell.x, cell.y, cell.z);
    }
    return certifiedPartMayBeOpaque(opacities(), triangle, known,
                                    voxelPoint(float(cell.x), float(cell.y), float(cell.z)))
               ? CERTIFIED_UNDECIDED
               : CERTIFIED_NONE;
}

#include "exact/exact_language.h"

#ifdef OUTPUTS
/// `number` is that of the triangle.
void emitWitness(uint pair, uint number, CertifiedCorners corners, CertifiedWitness witness, ivec3 cell) {
    const CertifiedProof proof =
        certifiedProof(opacities(), constants.item, corners, witness, cell.x, cell.y, cell.z);
    emitSurvivor(pair, number, contactVector(proof.texture.x, proof.texture.y, proof.texture.z),
                 contactSample(proof.stored, proof.opacity));
}
#endif

#endif

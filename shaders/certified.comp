// SPDX-License-Identifier: MIT
// The projection `conservative`: a work group decides the fragments of VOXTACT_COMPUTE_GROUP triangles of a pair, of a
// cluster where the mesh has them. What is skipped (clusters, triangles, bricks) provably has no opaque point. A
// triangle with few cells is one lane's; one with many is queued and shared by the whole group.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#include "shared.h"
#include "voxtact/pair_result.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
layout(constant_id = VOXTACT_CONSTANT_STOP_AT_FIRST) const bool kStopAtFirst = false;

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_VOLUME, binding = VOXTACT_BINDING_BRICKS, std430) readonly buffer Bricks {
    vec4 bricks[]; // lo, hi, wideLo, wideHi
};
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = 0) uniform sampler1D transferFunction;
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = VOXTACT_BINDING_EXTREMES, std430) readonly buffer Extremes {
    float extremes[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    CertifiedPair transforms[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) buffer Results { PairResult results[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_VERTICES, std430) readonly buffer Vertices { float vertices[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_INDICES, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Item { CertifiedConstants constants; };

// One addition a subgroup: a carry that is not needed costs nothing.
const bool kCarry = true;

#include "stored.glsl"
#include "certified.h"
#include "count.glsl"
#include "mesh.glsl"
#ifdef OUTPUTS
#include "survives.glsl"
#include "outputs.glsl"
#endif

const int kMostCellsOfALane = 27;
const int kBrickSide = 1 << VOXTACT_BRICK_SHIFT;

/// A box of cells, both ends inclusive, numbered from -1; or of bricks, from 0.
struct CellBox {
    ivec3 lo;
    ivec3 hi;
};

shared uint queue[VOXTACT_COMPUTE_GROUP];
shared uint queued;
shared uint wanted;

uint pair;
uint survivors = 0;
bool undecided = false;

OpacityTable opacities() {
    return OpacityTable(constants.item.tableSize, constants.item.tableLevels, constants.item.threshold);
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

vec4 brickAt(ivec3 brick) {
    const ivec3 count = (ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) >> VOXTACT_BRICK_SHIFT) + 1;
    return bricks[brick.x + count.x * (brick.y + count.y * brick.z)];
}

bool brickMayBeOpaque(vec4 range) {
    return certifiedRangeMayBeOpaque(opacities(), constants.item, range.x, range.y);
}

CertifiedVertex certifiedVertexOf(CertifiedPair transform, uint corner) {
    const vec3 position = positionOf(constants.mesh, corner);
    return certifiedVertex(transform, position.x, position.y, position.z);
}

float storedAt(ivec3 voxel) {
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    return storedVoxel(clamp(voxel, ivec3(0), last), constants.item.storedUnit);
}

CertifiedCorners cornersOf(ivec3 cell, vec4 range) {
    return CertifiedCorners(storedAt(cell), storedAt(cell + ivec3(1, 0, 0)), storedAt(cell + ivec3(0, 1, 0)),
                            storedAt(cell + ivec3(1, 1, 0)), storedAt(cell + ivec3(0, 0, 1)),
                            storedAt(cell + ivec3(1, 0, 1)), storedAt(cell + ivec3(0, 1, 1)),
                            storedAt(cell + ivec3(1, 1, 1)), range.z, range.w);
}

VoxelPoint vertexOf(uint corner) {
    const vec3 position = positionOf(constants.mesh, corner);
    return voxelPoint(position.x, position.y, position.z);
}

/// Of which triangle `placed` is.
uint placedOf = 0xffffffffu;
PreciseTriangle placed;

void placeAgain(CertifiedPair transform, uint number) {
    if (placedOf != number) {
        placed = preciseTriangle(transform, constants.item, vertexOf(3 * number), vertexOf(3 * number + 1),
                                  vertexOf(3 * number + 2));
        placedOf = number;
    }
}

/// Whether a certain fragment is known, and no more are asked for.
bool isDone() {
    return kStopAtFirst && (survivors > 0 || results[pair].countLow > 0);
}

/// `plane`: of a triangle that is not usable in single precision.
bool planeMisses(CertifiedTriangle triangle, PrecisePlane plane, bool usable, vec3 centre, float radius) {
    const VoxelPoint at = voxelPoint(centre.x, centre.y, centre.z);
    return usable ? certifiedPlaneMisses(triangle, at, radius) : precisePlaneMisses(plane, at, radius);
}

/// `number` is that of the triangle. What single precision leaves undecided is placed again, precisely.
void decideCell(CertifiedPair transform, uint number, CertifiedTriangle triangle, bool usable, ivec3 cell, vec4 range) {
    const CertifiedCorners corners = cornersOf(cell, range);
    CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return;
    }
    VoxelPoint witness;
    int verdict = CERTIFIED_UNDECIDED;
    for (int attempt = usable ? 0 : 1; attempt < 3 && verdict == CERTIFIED_UNDECIDED && !isDone(); ++attempt) {
        const bool within = attempt == 2;
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        int count;
        if (attempt == 0) {
            count = certifiedBegin(opacities(), triangle, known, cell.x, cell.y, cell.z, polygon);
        } else {
            if (within) {
                if (!preciseCrosses(known)) {
                    break;
                }
                known = preciseWithin(known);
            } else {
                placeAgain(transform, number);
                known = preciseCell(constants.item, placed, corners, cell.x, cell.y, cell.z);
            }
            count = certifiedBeginAgain(placed, known, cell.x, cell.y, cell.z, within, polygon);
        }
        const float resolution = attempt == 0 ? constants.item.resolution : certifiedFinest(constants.item);
        verdict =
            certifiedSettle(opacities(), resolution, known, cell.x, cell.y, cell.z, polygon, count, witness);
        // What is within has no opaque point, but there is more.
        verdict = within && verdict == CERTIFIED_NONE ? CERTIFIED_UNDECIDED : verdict;
    }
    if (verdict == CERTIFIED_CERTAIN) {
        ++survivors;
#ifdef OUTPUTS
        const VoxelPoint at = certifiedTexture(constants.item, witness);
        emitSurvivor(pair, number, vec3(at.x, at.y, at.z));
#endif
    } else if (verdict == CERTIFIED_UNDECIDED) {
        undecided = true;
    }
}

/// Every step-th of a triangle's cells in each brick, from `first` on.
void decideCells(CertifiedPair transform, uint number, CertifiedTriangle triangle, CertifiedBounds bounds, int first,
                 int step) {
    const CellBox cells = cellsOf(bounds);
    const CellBox box = bricksOf(cells);
    const bool single = cells.lo == cells.hi;
    const int count = volumeOf(box);
    bool hasPlane = false;
    PrecisePlane plane;
    for (int i = 0; i < count; ++i) {
        const ivec3 brick = placeIn(box, i);
        const vec4 range = brickAt(brick);
        if (!brickMayBeOpaque(range)) {
            continue;
        }
        if (!bounds.usable && !hasPlane) {
            placeAgain(transform, number);
            hasPlane = true;
            plane = precisePlane(constants.item, placed);
        }
        if (!bounds.usable && (!preciseKnown(placed) || placed.outside)) {
            undecided = undecided || !preciseKnown(placed);
            return;
        }
        const ivec3 corner = (brick << VOXTACT_BRICK_SHIFT) - 1;
        const vec3 centre = vec3(corner) + float(kBrickSide / 2);
        if (count > 1 && planeMisses(triangle, plane, bounds.usable, centre, float(kBrickSide / 2))) {
            continue;
        }
        const CellBox within = CellBox(max(cells.lo, corner), min(cells.hi, corner + kBrickSide - 1));
        const int most = volumeOf(within);
        for (int place = first; place < most; place += step) {
            const ivec3 cell = placeIn(within, place);
            if (single || !planeMisses(triangle, plane, bounds.usable, vec3(cell) + 0.5, 0.5)) {
                decideCell(transform, number, triangle, bounds.usable, cell, range);
            }
        }
    }
}

void decideTriangle(CertifiedPair transform, uint triangle, int first, int step) {
    const CertifiedVertex a = certifiedVertexOf(transform, 3 * triangle);
    const CertifiedVertex b = certifiedVertexOf(transform, 3 * triangle + 1);
    const CertifiedVertex c = certifiedVertexOf(transform, 3 * triangle + 2);
    const CertifiedBounds bounds = certifiedBounds(constants.item, a, b, c);
    const CellBox cells = cellsOf(bounds);
    if (isEmpty(cells)) {
        return;
    }
    // Also where the number of cells overflows.
    const ivec3 sides = cells.hi - cells.lo + 1;
    const bool few = all(lessThanEqual(sides, ivec3(kMostCellsOfALane))) && volumeOf(cells) <= kMostCellsOfALane;
    if (step == 1 && !few) {
        queue[atomicAdd(queued, 1u)] = triangle;
        return;
    }
    decideCells(transform, triangle, certifiedTriangle(a.point, b.point, c.point, bounds.delta), bounds, first, step);
}

/// Whether the group's cluster may touch a brick that may have an opaque point: asked by all lanes together.
bool clusterMayTouch(CertifiedPair transform, uint cluster) {
    const uint at = constants.clusterWord + 6 * cluster;
    const CertifiedBox box =
        CertifiedBox(uintBitsToFloat(indices[at]), uintBitsToFloat(indices[at + 1]), uintBitsToFloat(indices[at + 2]),
                     uintBitsToFloat(indices[at + 3]), uintBitsToFloat(indices[at + 4]), uintBitsToFloat(indices[at + 5]));
    const CellBox cells = cellsOf(certifiedBoxBounds(constants.item, transform, box));
    if (isEmpty(cells)) {
        return false;
    }
    const CellBox near = bricksOf(cells);
    const int count = volumeOf(near);
    for (int i = int(gl_LocalInvocationIndex); i < count && wanted == 0; i += VOXTACT_COMPUTE_GROUP) {
        if (brickMayBeOpaque(brickAt(placeIn(near, i)))) {
            atomicOr(wanted, 1u);
        }
    }
    barrier();
    return wanted != 0;
}

void main() {
    pair = constants.firstPair + gl_WorkGroupID.y;
    const uint group = gl_WorkGroupID.x;
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0) {
        queued = 0;
        wanted = kStopAtFirst && results[pair].countLow > 0 ? 2u : 0u;
    }
    barrier();
    if (wanted == 2) {
        return;
    }
    const CertifiedPair transform = transforms[pair];
    uint triangle = group * VOXTACT_COMPUTE_GROUP + lane;
    const bool within = triangle < constants.triangleCount;
    if (constants.clusterCount > 0) {
        if (!clusterMayTouch(transform, group)) {
            return;
        }
        triangle = within ? indices[constants.clusterWord + 6 * constants.clusterCount + triangle] : 0;
    }
    // The lane's own triangle first, then the queue, which is complete by then. One call: what it stands for is most of
    // the program, and some compilers take time by the square of it.
    uint turns = 1;
    for (uint turn = 0; turn < turns; ++turn) {
        const bool own = turn == 0;
        if (within || !own) {
            decideTriangle(transform, own ? triangle : queue[turn - 1], own ? 0 : int(lane),
                           own ? 1 : VOXTACT_COMPUTE_GROUP);
        }
        if (own) {
            barrier();
            turns += queued;
        }
    }
    const uint total = subgroupAdd(survivors);
    const bool open = subgroupOr(undecided ? 1u : 0u) != 0;
    if (subgroupElect()) {
        if (total > 0) {
            addSurvivors(pair, total);
        }
        if (open) {
            atomicOr(results[pair].how, VOXTACT_HOW_UNDECIDED_BIT);
        }
    }
}

// SPDX-License-Identifier: MIT
// The projection `conservative`, what of a mesh may touch: a lane per cluster of a pair, or, with RUNS, a run of a
// cluster that was kept. Those whose boxes meet a brick that may be opaque go on to the next pass. Where stopAtFirst is
// wanted, a vertex of what is kept is looked at, too: in opaque matter it proves the touch, and ends the work on its
// pair. With MARGIN the boxes are grown by it, with TURN by how far a turn brings them, too, and what is as far from
// the vertex along the grid's axes is looked at as well. With MOVE they are grown by how far a piece of the way brings
// them, and what long pieces bring near something ends the work on its pair: those are halved. With CLEARANCE those go
// on that may be nearer to something opaque than what is known of their pair; SCOUT is the first step, which ends here.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
layout(constant_id = VOXTACT_CONSTANT_OUTPUTS) const uint kOutputsWanted = 0;
layout(constant_id = VOXTACT_CONSTANT_LISTED) const bool kListed = false;
#include "certified_scene.glsl"
#ifdef CLEARANCE
#include "certified_clearance_near.glsl"
#endif

/// A box of more bricks is kept without a look: its triangles are looked at anyway.
const int kMostBricksOfABox = 512;

#ifdef RUNS
const uint kNodeTriangles = VOXTACT_RUN_TRIANGLES;
#else
const uint kNodeTriangles = VOXTACT_CLUSTER_TRIANGLES;
#endif

shared uint kept;
shared uint firstKept;
shared uint proven;

struct Node {
    bool some; // false: there is none
    uint pair;
    uint number;
};

Node nodeOfLane() {
    Node node;
#ifdef RUNS
    const uint lane = gl_GlobalInvocationID.x;
    const uint entry = lane / VOXTACT_CLUSTER_RUNS;
    node.some = entry < queueCount(VOXTACT_QUEUE_CLUSTERS);
    const uint word = constants.queueWord + VOXTACT_WORD_CLUSTERS(constants.queueRoom) + (node.some ? 2 * entry : 0);
    node.pair = queues[word];
    node.number = queues[word + 1] * VOXTACT_CLUSTER_RUNS + lane % VOXTACT_CLUSTER_RUNS;
    node.some = node.some && node.number * VOXTACT_RUN_TRIANGLES < constants.triangleCount;
#else
    node.pair = constants.firstPair + gl_WorkGroupID.y;
    if (kListed) {
        node.pair = queues[node.pair];
    }
    node.number = constants.firstCluster + gl_GlobalInvocationID.x;
    node.some = node.number < constants.endCluster;
#endif
    node.some = node.some && !isDone(node.pair);
#ifdef MOVE
    node.some = node.some && motionLook(node.pair) != VOXTACT_MOTION_NONE;
#endif
    return node;
}

CertifiedBox boxOf(uint number) {
#ifdef RUNS
    return boxOfRun(number);
#else
    return boxOfCluster(number);
#endif
}

#ifdef CLEARANCE
#ifdef SCOUT
const bool kAnyBrick = false; // the nearest of all
#else
const bool kAnyBrick = true;
#endif

/// Whether all of the volume is looked at, and something may be in it, but from where a node begins it may be farther
/// than a search goes.
bool isAstray(Node node) {
    if (clearanceAsked(node.pair) < VOXTACT_CLEARANCE_FAR) {
        return false;
    }
    const vec3 position = positionOf(constants.mesh, 3 * triangleAt(node.number * kNodeTriangles));
    const VoxelPoint at = certifiedVertex(transforms[node.pair], position.x, position.y, position.z).point;
    const bool nearby = all(lessThanEqual(abs(vec3(at.x, at.y, at.z)), vec3(VOXTACT_CLEARANCE_NEARBY)));
    return !nearby && mayHaveAnything();
}

/// Says whether a node is astray; in the first step also that something is no nearer to it than `distance`, which is 0
/// where that is not known.
void leaveBegun(Node node, float distance) {
    if (isAstray(node)) {
        atomicMin(queues[clearanceWord(node.pair) + VOXTACT_CLEARANCE_OPEN], VOXTACT_CLEARANCE_ASTRAY);
    }
#ifdef SCOUT
    else if (distance < VOXTACT_CLEARANCE_FAR) {
        leaveOpen(node.pair, distance);
    }
#endif
}

/// Whether something nearer than what is known may be near a node. What certainly is, is made known.
bool isNear(Node node) {
    const CertifiedPair transform = transforms[node.pair];
    const CertifiedReach reach = certifiedBoxReach(transform, boxOf(node.number));
    ClearanceFound found = nothingFound();
    if (reach.delta <= CERTIFIED_MOST_DELTA) {
        const vec3 position = positionOf(constants.mesh, 3 * triangleAt(node.number * kNodeTriangles));
        found = lookAround(clearanceSpace(node.pair), reach,
                           certifiedVertex(transform, position.x, position.y, position.z).point, kAnyBrick);
    } else {
        found.open = mayHaveAnything() ? 0.0 : found.open;
    }
    if (isCut()) {
        found = nothingFound();
        found.open = 0.0;
    }
    if (found.hi < clearanceHi(node.pair)) {
        foundAt(node.pair, triangleAt(node.number * kNodeTriangles), found.hi, found.place);
    }
    leaveBegun(node, found.open);
    return found.open < clearanceSpace(node.pair).margin;
}
#else
/// Whether a box of cells has a brick that may have an opaque point.
bool mayTouch(CellBox cells) {
    if (isEmpty(cells)) {
        return false;
    }
    const CellBox near = bricksOf(cells);
    const int count = volumeOf(near);
    if (any(greaterThan(near.hi - near.lo, ivec3(kMostBricksOfABox))) || count > kMostBricksOfABox) {
        return true;
    }
    bool found = false;
    for (int i = 0; i < count && !found; ++i) {
        found = brickMayBeOpaque(brickAt(placeIn(near, i)));
    }
    return found;
}

/// Whether the place `at` is opaque, and so proves a touch: it is the vertex, or, with a margin, within that of it.
/// `delta`: by what the vertex may be off.
bool placeProves(uint pair, VoxelPoint vertex, VoxelPoint at, float delta) {
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    const vec3 place = vec3(at.x, at.y, at.z);
    if (!(all(greaterThanEqual(place, vec3(-0.5))) && all(lessThanEqual(place, vec3(last) + 0.5)))) {
        return false;
    }
    const ivec3 cell = min(ivec3(floor(place)), last);
    const vec4 range = brickAt((cell + 1) >> VOXTACT_BRICK_SHIFT);
    if (!brickMayBeOpaque(range)) {
        return false;
    }
    const CertifiedCell known = certifiedCell(constants.item, cornersOf(cell, range), cell.x, cell.y, cell.z, delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return false;
    }
#if defined(MARGIN) && !defined(MOVE)
    return marginProbeProves(opacities(), MARGIN_SPACE(pair), known, vertex, at,
                             voxelPoint(float(cell.x), float(cell.y), float(cell.z)), delta);
#else
    CertifiedWitness witness;
    return certifiedVertexProves(opacities(), known, at, cell.x, cell.y, cell.z, witness);
#endif
}

#if defined(MARGIN) && !defined(MOVE)
/// Whether a brick that is within the margin of a vertex, all of it, has something opaque.
bool bricksProve(uint pair, VoxelPoint vertex, float delta) {
    const MarginSpace by = MARGIN_SPACE(pair);
    const CellBox box = bricksOf(cellsOf(marginBounds(constants.item, by, CertifiedReach(vertex, vertex, delta))));
    const float least = min(by.grow.x, min(by.grow.y, by.grow.z));
#ifdef TURN
    const bool wide = least * by.margin >= MARGIN_BRICK_RADIUS;
#else
    const bool wide = least >= MARGIN_BRICK_RADIUS;
#endif
    const bool sensible = constants.item.storedUnit > 0.0 && // whole numbers: none is NaN
                          wide && !isEmpty(box) && all(lessThan(box.hi - box.lo, ivec3(kMostBricksOfABox)));
    const int count = sensible ? volumeOf(box) : 0;
    bool found = false;
    for (int i = 0; i < min(count, kMostBricksOfABox) && !found; ++i) {
        const ivec3 brick = placeIn(box, i);
        const vec3 middle = brickCentre(brick);
        const vec4 range = brickAt(brick);
        found = marginBrickProves(opacities(), constants.item, by, vertex, delta,
                                  voxelPoint(middle.x, middle.y, middle.z), range.x, range.y);
    }
    return found;
}
#endif

/// Whether the first vertex of a node proves a touch; `delta` is no less than that of the node's triangles.
bool vertexProves(Node node, float delta) {
    const vec3 position = positionOf(constants.mesh, 3 * triangleAt(node.number * kNodeTriangles));
    const VoxelPoint at = certifiedVertex(transforms[node.pair], position.x, position.y, position.z).point;
#if defined(MOVE)
    const MarginSpace by = MARGIN_SPACE(node.pair);
    const VoxelPoint move = moveOf(by.move, voxelDifference(at, by.pivot));
    return placeProves(node.pair, at, voxelStep(at, move, 1.0), delta) ||
           placeProves(node.pair, at, voxelStep(at, move, -1.0), delta);
#elif defined(MARGIN)
    bool found = bricksProve(node.pair, at, delta);
    for (int probe = 0; probe < MARGIN_PROBES && !found; ++probe) {
        found = placeProves(node.pair, at, marginProbe(MARGIN_SPACE(node.pair), at, probe), delta);
    }
    return found;
#else
    return placeProves(node.pair, at, at, delta);
#endif
}

#ifdef TOUCHES
/// Keeps where the first vertex of a node touches.
void keepVertex(Node node) {
    const uint triangle = triangleAt(node.number * kNodeTriangles);
    const vec3 position = positionOf(constants.mesh, 3 * triangle);
    const VoxelPoint at = certifiedVertex(transforms[node.pair], position.x, position.y, position.z).point;
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    const ivec3 cell = min(ivec3(floor(vec3(at.x, at.y, at.z))), last);
    keepTouch(node.pair, triangle, cell, voxelDifference(at, voxelPoint(float(cell.x), float(cell.y), float(cell.z))));
}

const bool kVertexSays = true;
#else
void keepVertex(Node node) {}

const bool kVertexSays = kOutputsWanted == 0; // outputs want to know more than that
#endif
#endif

void main() {
    if (gl_LocalInvocationIndex == 0) {
        kept = 0;
        proven = 0;
    }
#ifndef RUNS
    const uvec2 all = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy;
    emptyLeftBlocks(gl_GlobalInvocationID.x + all.x * gl_GlobalInvocationID.y, all.x * all.y);
#endif
    barrier();
    const Node node = nodeOfLane();
    bool keep = node.some;
#ifndef RUNS
    countWork(VOXTACT_WORK_CLUSTERS, node.some ? 1 : 0);
#endif
#ifdef CLEARANCE
    if (keep && constants.clusterWord != VOXTACT_NO_CLUSTERS) {
        keep = isNear(node);
    }
    else if (keep) {
        leaveBegun(node, mayHaveAnything() ? 0.0 : VOXTACT_CLEARANCE_FAR);
    }
#else
    if (keep && constants.clusterWord != VOXTACT_NO_CLUSTERS) {
        const CertifiedPair transform = transforms[node.pair];
#ifdef MARGIN
        const CertifiedBounds bounds = marginBounds(constants.item, MARGIN_SPACE(node.pair),
                                                    certifiedBoxReach(transform, boxOf(node.number)));
#else
        const CertifiedBounds bounds = certifiedBoxBounds(constants.item, transform, boxOf(node.number));
#endif
        keep = mayTouch(cellsOf(bounds));
        if (kStopAtFirst && kVertexSays && keep && bounds.usable && vertexProves(node, bounds.delta)) {
            keepVertex(node);
#ifdef MARGIN
            markWithin(node.pair);
#else
            atomicOr(results[node.pair].countLow, 1u);
#endif
            atomicOr(proven, 1u);
            keep = false;
        }
    }
#if defined(MOVE) && defined(RUNS)
    if (keep && motionLook(node.pair) == VOXTACT_MOTION_BOXES) {
        markWithin(node.pair);
        keep = false;
    }
#endif
#endif
    uint slot = 0;
    if (keep) {
        slot = atomicAdd(kept, 1u);
    }
    barrier();
#ifdef RUNS
    const uint queue = VOXTACT_QUEUE_RUNS;
    const uint room = VOXTACT_ROOM_RUNS(constants.queueRoom);
    const uint lanes = VOXTACT_CLUSTER_RUNS;
    const uint first = VOXTACT_WORD_RUNS(constants.queueRoom);
    const bool wanted = kept > 0;
#else
    const uint queue = VOXTACT_QUEUE_CLUSTERS;
    const uint room = constants.queueRoom;
    const uint lanes = VOXTACT_COMPUTE_GROUP / VOXTACT_CLUSTER_RUNS;
    const uint first = VOXTACT_WORD_CLUSTERS(constants.queueRoom);
    const bool wanted = kept > 0 && proven == 0; // all are of one pair
#endif
    if (gl_LocalInvocationIndex == 0 && wanted) {
        firstKept = reserve(queue, kept, room, lanes);
    }
    barrier();
    if (keep && wanted) {
        const uint word = constants.queueWord + first + 2 * (firstKept + slot);
        queues[word] = node.pair;
        queues[word + 1] = node.number;
    }
}

// SPDX-License-Identifier: MIT
// The projection `certified`, what of a mesh may touch: a lane per cluster of a pair, or, with RUNS, a run of a
// cluster that was kept. Those whose boxes meet a brick that may be opaque go on to the next pass. Where stopAtFirst is
// wanted, a vertex of what is kept is examined, too: in opaque matter it proves the touch, and ends the work on its
// pair.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
layout(constant_id = VOXTACT_CONSTANT_OUTPUTS) const uint kOutputsWanted = 0;
#include "certified_scene.glsl"

/// Larger boxes are kept untested: later passes test their triangles.
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
    node.number = constants.firstCluster + gl_GlobalInvocationID.x;
    node.some = node.number < constants.endCluster;
#endif
    node.some = node.some && !isDone(node.pair);
    return node;
}

CertifiedBox boxOf(uint number) {
#ifdef RUNS
    return boxOfRun(number);
#else
    return boxOfCluster(number);
#endif
}

/// Returns true if a box of cells has a brick that may contain an opaque point.
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

/// Returns true if the first vertex of a node is opaque, which proves a touch; `delta` is an upper bound for the node's
/// triangles.
bool vertexProves(Node node, float delta) {
    const vec3 position = positionOf(constants.mesh, 3 * triangleAt(node.number * kNodeTriangles));
    const VoxelPoint at = certifiedVertex(transforms[node.pair], position.x, position.y, position.z).point;
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
    CertifiedWitness witness;
    return certifiedVertexProves(opacities(), known, at, cell.x, cell.y, cell.z, witness);
}

const bool kVertexSays = kOutputsWanted == 0; // outputs need more than a touch

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
    if (keep && constants.clusterWord != VOXTACT_NO_CLUSTERS) {
        const CertifiedPair transform = transforms[node.pair];
        const CertifiedBounds bounds = certifiedBoxBounds(constants.item, transform, boxOf(node.number));
        keep = mayTouch(cellsOf(bounds));
        if (kStopAtFirst && kVertexSays && keep && bounds.usable && vertexProves(node, bounds.delta)) {
            atomicOr(results[node.pair].countLow, 1u);
            atomicOr(proven, 1u);
            keep = false;
        }
    }
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

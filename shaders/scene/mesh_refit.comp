// SPDX-License-Identifier: MIT
// Fits the boxes of a mesh's clusters, and of their runs, to its vertices: a work group per cluster, a lane per
// triangle. Floats are compared as words: no device flushes or rounds these, so that the boxes are the host's, and one
// that holds a NaN has it as its end, which meets all cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_CLUSTER_TRIANGLES) in;

layout(set = 0, binding = VOXTACT_BINDING_VERTICES, std430) readonly buffer Vertices { float vertices[]; };
layout(set = 0, binding = VOXTACT_BINDING_INDICES, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = VOXTACT_BINDING_CLUSTERS, std430) buffer Clusters { uint words[]; };
layout(push_constant) uniform Refit { RefitConstants constants; };

#include "mesh.glsl"
#include "count/ordered.glsl"

#define VOXTACT_BOX_WORDS 6 // lo and hi

shared uint runs[VOXTACT_CLUSTER_RUNS * VOXTACT_BOX_WORDS];

bool isLo(uint word) {
    return word % VOXTACT_BOX_WORDS < 3;
}

void growRun(uint run, vec3 position) {
    for (uint axis = 0; axis < 3; ++axis) {
        const uint word = orderedWord(position[axis]);
        atomicMin(runs[VOXTACT_BOX_WORDS * run + axis], word);
        atomicMax(runs[VOXTACT_BOX_WORDS * run + 3 + axis], word);
    }
}

/// A word of the box of the whole cluster, in the order of floats.
uint wordOfCluster(uint word) {
    uint found = runs[word];
    for (uint run = 1; run < VOXTACT_CLUSTER_RUNS; ++run) {
        const uint other = runs[VOXTACT_BOX_WORDS * run + word];
        found = isLo(word) ? min(found, other) : max(found, other);
    }
    return found;
}

void main() {
    const uint clusters = (constants.triangleCount + VOXTACT_CLUSTER_TRIANGLES - 1) / VOXTACT_CLUSTER_TRIANGLES;
    const uint allRuns = (constants.triangleCount + VOXTACT_RUN_TRIANGLES - 1) / VOXTACT_RUN_TRIANGLES;
    const uint cluster = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
    if (cluster >= clusters) {
        return;
    }
    const uint lane = gl_LocalInvocationIndex;
    if (lane < VOXTACT_CLUSTER_RUNS * VOXTACT_BOX_WORDS) {
        runs[lane] = isLo(lane) ? 0xffffffffu : 0u;
    }
    barrier();
    const uint firstRunWord = constants.clusterWord + VOXTACT_BOX_WORDS * clusters;
    const uint firstTriangleWord = firstRunWord + VOXTACT_BOX_WORDS * allRuns;
    const uint place = cluster * VOXTACT_CLUSTER_TRIANGLES + lane;
    if (place < constants.triangleCount) {
        const uint triangle = words[firstTriangleWord + place];
        for (uint corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
            growRun(lane / VOXTACT_RUN_TRIANGLES, positionOf(constants.mesh, corner));
            if (constants.copiesIndices != 0) {
                words[corner] = vertexOf(constants.mesh, corner);
            }
        }
    }
    barrier();
    if (lane < VOXTACT_BOX_WORDS) {
        words[constants.clusterWord + VOXTACT_BOX_WORDS * cluster + lane] = VOXTACT_BOUND_BITS(wordOfCluster(lane));
    }
    const uint word = cluster * VOXTACT_CLUSTER_RUNS * VOXTACT_BOX_WORDS + lane;
    if (lane < VOXTACT_CLUSTER_RUNS * VOXTACT_BOX_WORDS && word < VOXTACT_BOX_WORDS * allRuns) {
        words[firstRunWord + word] = VOXTACT_BOUND_BITS(runs[lane]);
    }
}

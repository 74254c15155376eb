// SPDX-License-Identifier: MIT
// The projection `conservative`: a work group decides the fragments of VOXTACT_COMPUTE_GROUP triangles of a pair, of a
// cluster where the mesh has them. What is skipped (clusters, triangles, bricks) provably has no opaque point. A
// triangle with few cells is one lane's; one with many is queued and shared by the whole group. Triangles that are
// undecided in some cell, and those with very many cells, are listed for certified_again.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

shared uint queue[VOXTACT_COMPUTE_GROUP];
shared uint queued;
shared uint queueOpen[VOXTACT_COMPUTE_GROUP / 32]; // a bit for each in the queue: it is listed
shared uint wanted;

bool open = false; // the triangle at hand is undecided in some cell

/// `number` is that of the triangle.
void decideCell(uint number, CertifiedTriangle triangle, ivec3 cell, vec4 range, bool single) {
    const vec3 centre = vec3(cell) + 0.5;
    if (!single && certifiedPlaneMisses(triangle, voxelPoint(centre.x, centre.y, centre.z), 0.5)) {
        return;
    }
    const CertifiedCorners corners = cornersOf(cell, range);
    const CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return;
    }
    VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
    const int count = certifiedBegin(opacities(), triangle, known, cell.x, cell.y, cell.z, polygon);
    CertifiedWitness witness;
    const int verdict = certifiedSettle(opacities(), constants.item.resolution, known, polygon, count, witness);
    if (verdict == CERTIFIED_CERTAIN && !isCut()) {
        ++survivors;
#ifdef OUTPUTS
        emitWitness(number, corners, witness, cell);
#endif
    } else if (verdict == CERTIFIED_UNDECIDED) {
        open = true;
    }
}

/// Every step-th of a triangle's cells in each brick, from `first` on.
void decideTriangle(CertifiedPair transform, uint number, int first, int step) {
    const TriangleVertices at = verticesOf(transform, number);
    const CertifiedBounds bounds = boundsOf(at);
    const CertifiedTriangle triangle = triangleOf(at, bounds.delta);
    const CellBox cells = cellsOf(bounds);
    const CellBox box = bricksOf(cells);
    const bool single = cells.lo == cells.hi;
    const int count = volumeOf(box);
    for (int i = 0; i < count; ++i) {
        const ivec3 brick = placeIn(box, i);
        const vec4 range = brickAt(brick);
        if (!brickMayBeOpaque(range)) {
            continue;
        }
        if (!bounds.usable) {
            open = true;
            return;
        }
        const vec3 centre = brickCentre(brick);
        if (count > 1 &&
            certifiedPlaneMisses(triangle, voxelPoint(centre.x, centre.y, centre.z), float(kBrickSide / 2))) {
            continue;
        }
        const CellBox inside = within(cells, brick);
        const int most = volumeOf(inside);
        for (int cell = first; cell < most; cell += step) {
            decideCell(number, triangle, placeIn(inside, cell), range, single);
        }
    }
}

/// Lists a triangle of the pair for the second pass, which has for each pair as many work groups as it has such triangles, and
/// more where a triangle is large.
void addOpen(uint number, bool large) {
    const uint before = atomicAdd(opens[constants.firstOpen + pair].count, 1u);
    const bool listed = before < VOXTACT_OPEN_TRIANGLES;
    if (listed) {
        opens[constants.firstOpen + pair].triangles[before] = number;
    }
    const uint first = constants.firstOpen + constants.firstPair;
    if (before == 0) {
        opens[first + atomicAdd(opens[first].groupsY, 1u)].pair = pair;
    }
    atomicMax(opens[first].groupsX, listed ? max(before + 1, large ? VOXTACT_OPEN_GROUPS : 1u) : gl_NumWorkGroups.x);
    atomicMax(opens[first].groupsZ, 1u);
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
        queueOpen[0] = 0;
        queueOpen[1] = 0;
        wanted = kStopAtFirst && results[pair].countLow > 0 ? 2u : 0u;
    }
    barrier();
    if (wanted == 2) {
        return;
    }
    const CertifiedPair transform = transforms[pair];
    uint triangle = group * VOXTACT_COMPUTE_GROUP + lane;
    const bool inMesh = triangle < constants.triangleCount;
    if (constants.clusterCount > 0) {
        if (!clusterMayTouch(transform, group)) {
            return;
        }
        triangle = inMesh ? indices[constants.clusterWord + 6 * constants.clusterCount + triangle] : 0;
    }
    bool few = false;
    if (inMesh) {
        const CellBox cells = cellsOf(boundsOf(verticesOf(transform, triangle)));
        const bool large = !isEmpty(cells) && isLarge(cells);
        few = !isEmpty(cells) && !large;
        if (large && isHuge(cells)) {
            addOpen(triangle, true);
        } else if (large) {
            queue[atomicAdd(queued, 1u)] = triangle;
        }
    }
    barrier();
    // The lane's own triangle, then those in the queue. One call: what it stands for is most of the program, and
    // compilers take longer than twice as long for two.
    const uint turns = queued + 1;
    for (uint turn = 0; turn < turns; ++turn) {
        const bool own = turn == 0;
        const uint number = own ? triangle : queue[turn - 1];
        open = false;
        if (!own || few) {
            decideTriangle(transform, number, own ? 0 : int(lane), own ? 1 : VOXTACT_COMPUTE_GROUP);
        }
        if (open) {
            const uint bit = 1u << ((turn - 1) & 31);
            if (own || (atomicOr(queueOpen[(turn - 1) >> 5], bit) & bit) == 0) {
                addOpen(number, !own);
            }
        }
    }
    const uint total = subgroupAdd(survivors);
    const bool cut = subgroupOr(isCut() ? 1u : 0u) != 0;
    if (subgroupElect()) {
        if (total > 0) {
            addSurvivors(pair, total);
        }
        if (cut) {
            atomicOr(results[pair].how, VOXTACT_HOW_UNDECIDED_BIT);
        }
    }
}

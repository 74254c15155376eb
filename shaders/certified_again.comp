// SPDX-License-Identifier: MIT
// The projection `conservative`, what single precision leaves undecided: the triangles that certified.comp has listed
// are placed again, precisely, and their open cells decided. Cells that the first pass has decided are found by
// deciding them as it did. A pair with more open triangles than its list holds is gone through whole: the answer does
// not depend on the order in which the list was filled, nor on its length. No barriers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#extension GL_EXT_control_flow_attributes : require
#define SMALL_PROGRAM
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

bool undecided = false;

/// A triangle, as the first pass and as this one places it.
struct Placed {
    uint number;
    CertifiedTriangle rounded;
    bool usable; // `rounded` is
    bool huge;   // the first pass has decided nothing of it
    PreciseTriangle again;
};

/// The attempts at a cell: as the first pass; precisely; the part of it that is certainly in the domain.
void decideCell(Placed triangle, ivec3 cell, vec4 range) {
    const CertifiedCorners corners = cornersOf(cell, range);
    CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.rounded.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return;
    }
    int verdict = CERTIFIED_UNDECIDED;
    int attempt = triangle.usable ? -1 : 0;
    CertifiedWitness witness;
    while (verdict == CERTIFIED_UNDECIDED && attempt < 2) {
        ++attempt;
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        int count;
        if (attempt == 0) {
            count = certifiedBegin(opacities(), triangle.rounded, known, cell.x, cell.y, cell.z, polygon);
        } else {
            if (attempt == 1) {
                known = preciseCell(constants.item, triangle.again, corners, cell.x, cell.y, cell.z);
            } else if (preciseCrosses(known)) {
                known = preciseWithin(known);
            } else {
                break;
            }
            count = certifiedBeginAgain(triangle.again, known, cell.x, cell.y, cell.z, attempt == 2, polygon);
        }
        const float resolution = attempt == 0 ? constants.item.resolution : certifiedFinest(constants.item);
        verdict = certifiedSettle(opacities(), resolution, known, polygon, count, witness);
        // What is certainly in the domain has no opaque point, but there is more.
        verdict = attempt == 2 && verdict == CERTIFIED_NONE ? CERTIFIED_UNDECIDED : verdict;
    }
    if (verdict == CERTIFIED_UNDECIDED) {
        undecided = true;
    }
    if (verdict == CERTIFIED_CERTAIN && (attempt > 0 || triangle.huge) && !isCut()) {
        ++survivors;
#ifdef OUTPUTS
        emitWitness(triangle.number, corners, witness, cell);
#endif
    }
}

bool planeMisses(Placed triangle, PrecisePlane plane, vec3 centre, float radius) {
    const VoxelPoint at = voxelPoint(centre.x, centre.y, centre.z);
    return triangle.usable ? certifiedPlaneMisses(triangle.rounded, at, radius) : precisePlaneMisses(plane, at, radius);
}

/// Every parts-th of a triangle's bricks, from `part` on, and every step-th of the cells of each, from `first` on.
void decideTriangle(CertifiedPair transform, uint number, int part, int parts, int first, int step) {
    const TriangleVertices at = verticesOf(transform, number);
    const CertifiedBounds bounds = boundsOf(at);
    const Placed triangle =
        Placed(number, triangleOf(at, bounds.delta), bounds.usable, isHuge(cellsOf(bounds)),
               preciseTriangle(transform, constants.item, at.object[0], at.object[1], at.object[2]));
    const PrecisePlane plane = precisePlane(constants.item, triangle.again);
    const bool isKnown = triangle.usable || preciseKnown(triangle.again);
    const CellBox cells = cellsOf(bounds);
    const CellBox box = bricksOf(cells);
    const bool single = cells.lo == cells.hi;
    const int count = volumeOf(box);
    for (int i = part; i < count; i += parts) {
        const ivec3 brick = placeIn(box, i);
        const vec4 range = brickAt(brick);
        if (!brickMayBeOpaque(range)) {
            continue;
        }
        if (!isKnown) {
            undecided = true;
            return;
        }
        if (count > 1 && planeMisses(triangle, plane, brickCentre(brick), float(kBrickSide / 2))) {
            continue;
        }
        const CellBox inside = within(cells, brick);
        const int most = volumeOf(inside);
        for (int place = first; place < most; place += step) {
            const ivec3 cell = placeIn(inside, place);
            if (single || !planeMisses(triangle, plane, vec3(cell) + 0.5, 0.5)) {
                decideCell(triangle, cell, range);
            }
        }
    }
}

/// Whether the cells of a triangle of the mesh are shared by the lanes; false where it has none.
bool isShared(CertifiedPair transform, uint number) {
    const CellBox cells = cellsOf(boundsOf(verticesOf(transform, number)));
    return !isEmpty(cells) && isLarge(cells);
}

void main() {
    pair = opens[constants.firstOpen + constants.firstPair + gl_WorkGroupID.y].pair;
    if (kStopAtFirst && results[pair].countLow > 0) {
        return;
    }
    const CertifiedPair transform = transforms[pair];
    const uint groups = gl_NumWorkGroups.x;
    const uint group = gl_WorkGroupID.x;
    const uint lane = gl_LocalInvocationIndex;
    const uint open = opens[constants.firstOpen + pair].count;
    // The groups share the triangles of a list, and those that have the same triangle its bricks; or all of the mesh,
    // each as many of it as there are lanes: first a lane its own unless it is large, then all lanes each large one.
    const bool listed = open <= VOXTACT_OPEN_TRIANGLES;
    const uint first = listed ? group % open : group * VOXTACT_COMPUTE_GROUP;
    const uint end = listed ? first + 1 : min(first + VOXTACT_COMPUTE_GROUP, constants.triangleCount);
    const uint part = listed ? group / open : 0;
    const uint parts = listed ? (groups - first + open - 1) / open : 1;
    bool own = !listed;
    uint at = own ? first + lane : first;
    while (own || at < end) {
        const uint number = listed ? opens[constants.firstOpen + pair].triangles[at] : at;
        if (at < end && !(own && isShared(transform, number))) {
            decideTriangle(transform, number, int(part), int(parts), own ? 0 : int(lane),
                           own ? 1 : VOXTACT_COMPUTE_GROUP);
        }
        at = own ? first : at + 1;
        own = false;
        while (at < end && !isShared(transform, at)) {
            ++at;
        }
    }
    const uint total = subgroupAdd(survivors);
    const bool some = subgroupOr(undecided || isCut() ? 1u : 0u) != 0;
    if (subgroupElect()) {
        if (total > 0) {
            addSurvivors(pair, total);
        }
        if (some) {
            atomicOr(results[pair].how, VOXTACT_HOW_UNDECIDED_BIT);
        }
    }
}

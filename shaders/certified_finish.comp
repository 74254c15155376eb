// SPDX-License-Identifier: MIT
// The projection `conservative`, what is left: cells that single precision leaves undecided, decided again with more of
// it, a lane each; and what the queue of cells or of large triangles had no room for, found and decided here, a work
// group for each entry. No barriers: the lanes have loops of many lengths.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#extension GL_EXT_control_flow_attributes : require
#define SMALL_PROGRAM
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

/// A triangle, as the first passes and as this one places it.
struct Placed {
    uint pair;
    uint number;
    CertifiedTriangle rounded;
    bool usable; // `rounded` is
    bool again;  // what is decided with it was left undecided
    PreciseTriangle precisely;
};

/// Which of a triangle's bricks and cells a lane decides.
struct Share {
    bool some;
    uint pair;
    uint number; // of the triangle
    bool single; // one cell, that was left undecided
    ivec3 cell;
    bool large;     // the triangle must be; else it must not, unless it is a single cell
    int firstBrick; // of the triangle's
    int skip;       // bricks after every 64th
    int first;      // of each brick's cells
    int step;
};

uint survivors = 0;
bool undecided = false;

/// The attempts at a cell: as the first pass; precisely; the part of it that is certainly in the domain.
void decideCell(Placed triangle, ivec3 cell, vec4 range) {
    const CertifiedCorners corners = cornersOf(cell, range);
    CertifiedCell known = certifiedCell(constants.item, corners, cell.x, cell.y, cell.z, triangle.rounded.delta);
    if (!certifiedCellMayBeOpaque(opacities(), known)) {
        return;
    }
    int verdict = CERTIFIED_UNDECIDED;
    int attempt = triangle.usable && !triangle.again ? -1 : 0;
    CertifiedWitness witness;
    while (verdict == CERTIFIED_UNDECIDED && attempt < 2) {
        ++attempt;
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        int count;
        if (attempt == 0) {
            count = certifiedBegin(opacities(), triangle.rounded, known, cell.x, cell.y, cell.z, polygon);
        } else {
            if (attempt == 1) {
                known = preciseCell(constants.item, triangle.precisely, corners, cell.x, cell.y, cell.z);
            } else if (preciseCrosses(known)) {
                known = preciseWithin(known);
            } else {
                break;
            }
            count = certifiedBeginAgain(triangle.precisely, known, cell.x, cell.y, cell.z, attempt == 2, polygon);
        }
        const float resolution = attempt == 0 ? constants.item.resolution : certifiedFinest(constants.item);
        verdict = certifiedSettle(opacities(), resolution, known, polygon, count, witness);
        // What is certainly in the domain has no opaque point, but there is more.
        verdict = attempt == 2 && verdict == CERTIFIED_NONE ? CERTIFIED_UNDECIDED : verdict;
    }
    if (verdict == CERTIFIED_UNDECIDED) {
        undecided = true;
    }
    if (verdict == CERTIFIED_CERTAIN && !isCut()) {
        ++survivors;
#ifdef OUTPUTS
        emitWitness(triangle.pair, triangle.number, corners, witness, cell);
#endif
    }
}

bool planeMisses(Placed triangle, PrecisePlane plane, vec3 centre, float radius) {
    const VoxelPoint at = voxelPoint(centre.x, centre.y, centre.z);
    return triangle.usable ? certifiedPlaneMisses(triangle.rounded, at, radius) : precisePlaneMisses(plane, at, radius);
}

void decideShare(Share share) {
    const CertifiedPair transform = transforms[share.pair];
    const TriangleVertices at = verticesOf(transform, share.number);
    const CertifiedBounds bounds = boundsOf(at);
    const CellBox cells = share.single ? CellBox(share.cell, share.cell) : cellsOf(bounds);
    if (isEmpty(cells) || (!share.single && share.large != (isLarge(cells) || !bounds.usable))) {
        return;
    }
    const Placed triangle =
        Placed(share.pair, share.number, triangleOf(at, bounds.delta), bounds.usable, share.single,
               preciseTriangle(transform, constants.item, at.object[0], at.object[1], at.object[2]));
    const PrecisePlane plane = precisePlane(constants.item, triangle.precisely);
    const bool isKnown = triangle.usable || preciseKnown(triangle.precisely);
    const CellBox box = bricksOf(cells);
    const bool single = cells.lo == cells.hi;
    const int count = volumeOf(box);
    const bool byOthers = share.large && gl_LocalInvocationIndex > 0; // all lanes look at the same bricks
    uint bricksSeen = 0;
    uint cellsSeen = 0;
    for (int i = share.firstBrick; i < count; i += (i & 63) == 63 ? 1 + share.skip : 1) {
        const ivec3 brick = placeIn(box, i);
        const vec4 range = brickAt(brick);
        ++bricksSeen;
        if (!brickMayBeOpaque(range)) {
            continue;
        }
        if (!isKnown) {
            undecided = true;
            break;
        }
        if (count > 1 && planeMisses(triangle, plane, brickCentre(brick), float(kBrickSide / 2))) {
            continue;
        }
        const CellBox inside = within(cells, brick);
        const int most = volumeOf(inside);
        for (int place = share.first; place < most; place += share.step) {
            ++cellsSeen;
            const ivec3 cell = placeIn(inside, place);
            if (single || !planeMisses(triangle, plane, vec3(cell) + 0.5, 0.5)) {
                decideCell(triangle, cell, range);
            }
        }
    }
    if (!share.single) {
        countWork(VOXTACT_WORK_BRICKS_LEFT, byOthers ? 0 : bricksSeen);
        countWork(VOXTACT_WORK_CELLS_LEFT, cellsSeen);
    }
}

Share shareOf(TriangleLane own, bool large) {
    return large ? Share(own.some, own.pair, own.number, false, ivec3(0), true, 0, 0, int(gl_LocalInvocationIndex),
                         VOXTACT_COMPUTE_GROUP)
                 : Share(own.some, own.pair, own.number, false, ivec3(0), false, 0, 0, 0, 1);
}

/// `turn` counts the triangles of what is left of a work group's large ones.
Share shareOfEntry(uint what, uint number, uint brick, uint turn) {
    if (what == VOXTACT_LEFT_SMALL) {
        return shareOf(triangleLane(number, gl_LocalInvocationIndex), false);
    }
    if (what == VOXTACT_LEFT_GROUP) {
        return shareOf(triangleLane(number, turn), true);
    }
    const uvec4 entry = quads[quadOf(VOXTACT_WORD_LARGE(constants.queueRoom), number)];
    return Share(!isDone(entry.x), entry.x, entry.y, false, ivec3(0), true, int(brick),
                 int(entry.w - 1) * VOXTACT_COMPUTE_GROUP, int(gl_LocalInvocationIndex), VOXTACT_COMPUTE_GROUP);
}

void main() {
    const uint opens = queueCount(VOXTACT_QUEUE_OPEN);
    const uint groupsOfCells = (opens + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
    const bool ofCells = gl_WorkGroupID.x < groupsOfCells;
    const uint left = constants.queueWord + VOXTACT_WORD_LEFT(constants.queueRoom) +
                      (ofCells ? 0 : 2 * (gl_WorkGroupID.x - groupsOfCells));
    const uint what = queues[left] >> VOXTACT_LEFT_SHIFT;
    const uint number = queues[left] & ((1u << VOXTACT_LEFT_SHIFT) - 1);
    const uint turns = !ofCells && what == VOXTACT_LEFT_GROUP ? VOXTACT_COMPUTE_GROUP : 1;
    for (uint turn = 0; turn < turns; ++turn) {
        Share share;
        if (ofCells) {
            const bool some = gl_GlobalInvocationID.x < opens;
            const uint open = constants.queueWord + VOXTACT_WORD_OPEN(constants.queueRoom) + gl_GlobalInvocationID.x;
            const uvec4 entry = some ? quads[quadOf(VOXTACT_WORD_CELLS, queues[open])] : uvec4(0);
            share = Share(some && !isDone(entry.x), entry.x, entry.y, true, unpackCell(entry.zw), false, 0, 0, 0, 1);
        } else {
            share = shareOfEntry(what, number, queues[left + 1], turn);
        }
        survivors = 0;
        undecided = false;
        if (share.some) {
            decideShare(share);
            if (survivors > 0) {
                addSurvivors(share.pair, survivors);
            }
            if (undecided || isCut()) {
                atomicOr(results[share.pair].how, VOXTACT_HOW_UNDECIDED_BIT);
            }
        }
    }
}

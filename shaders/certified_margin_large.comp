// SPDX-License-Identifier: MIT
// The projection `conservative` with a margin, the cells near triangles: a work group has a brick, and a run or some
// triangles of one. First it finds the cells that are not beyond the margin of the triangles' common box, then those of
// them that may have something opaque, then the triangles that are not beyond the margin of the box of these; and at
// last it looks at each such cell of each such triangle. A cell that certainly is opaque within the margin ends the work
// on the pair; those that need a decision go into the queue of cells. A triangle that is near very many bricks is left
// to certified_margin_finish, whose work groups share it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_MARGIN_GROUP) in;
#include "certified_scene.glsl"
#ifdef CLEARANCE
#include "certified_clearance_cell.glsl"
#include "certified_clearance_along.glsl"
#include "certified_clearance_bits.glsl"
#define ALONG(direction) , AlongBrick direction
#define WITH_ALONG(direction) , direction
#else
#define ALONG(direction)
#define WITH_ALONG(direction)
#endif

const int kBrickCells = kBrickSide * kBrickSide * kBrickSide;
/// What a listed cell has is above so many bits of its number in the brick.
const uint kHasShift = 3 * VOXTACT_BRICK_SHIFT;

shared uint passedOver; // the pair is done
shared uint full;       // the queue of cells is
shared uint cut;        // a loop was left before its end
// Of the run: those that the entry has.
shared CertifiedTriangle triangles[VOXTACT_RUN_TRIANGLES];
shared CertifiedReach reaches[VOXTACT_RUN_TRIANGLES];
// The reaches once more, as numbers for a lane each, and the greatest of each: what is lowest has the other sign.
const uint kNumbers = 7;
shared float numbers[kNumbers * VOXTACT_RUN_TRIANGLES];
shared float most[kNumbers];
// Of the brick: numbers of cells, in any order.
shared uint nearCells[kBrickCells];
shared uint nearCount;
shared uint opaqueCells[kBrickCells];
shared uint opaqueCount;
shared ivec3 opaqueLo;
shared ivec3 opaqueHi;
// Triangles of the run that are near these.
shared uint nearTriangles[VOXTACT_RUN_TRIANGLES];
shared uint nearTriangleCount;

ivec3 cellOf(ivec3 corner, uint number) {
    return corner + ivec3(number & (kBrickSide - 1), (number >> VOXTACT_BRICK_SHIFT) & (kBrickSide - 1),
                          (number >> (2 * VOXTACT_BRICK_SHIFT)) & (kBrickSide - 1));
}

uint numberIn(ivec3 corner, ivec3 cell) {
    const uvec3 at = uvec3(cell - corner);
    return at.x | at.y << VOXTACT_BRICK_SHIFT | at.z << (2 * VOXTACT_BRICK_SHIFT);
}

uint triangleOfRun(uvec4 entry, uint i) {
    return triangleAt(entry.y * VOXTACT_RUN_TRIANGLES + i);
}

bool isOfEntry(uvec4 entry, uint i) {
    return (entry.w >> i & 1u) != 0;
}

/// What the entry's triangles are in, all of them.
CertifiedReach reachOfAll() {
    return CertifiedReach(voxelPoint(-most[0], -most[1], -most[2]), voxelPoint(most[3], most[4], most[5]), most[6]);
}

void findReach(uvec4 entry) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane < kNumbers) {
        float found = -CERTIFIED_FARTHEST;
        for (uint i = 0; i < VOXTACT_RUN_TRIANGLES; ++i) {
            found = isOfEntry(entry, i) ? max(found, numbers[kNumbers * i + lane]) : found;
        }
        most[lane] = found;
    }
}

void findTriangles(uvec4 entry) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane < VOXTACT_RUN_TRIANGLES && isOfEntry(entry, lane)) {
        const TriangleVertices at = verticesOf(transforms[entry.x], triangleOfRun(entry, lane));
        const CertifiedReach reach = certifiedReach(at.voxel[0], at.voxel[1], at.voxel[2]);
        numbers[kNumbers * lane] = -reach.lo.x;
        numbers[kNumbers * lane + 1] = -reach.lo.y;
        numbers[kNumbers * lane + 2] = -reach.lo.z;
        numbers[kNumbers * lane + 3] = reach.hi.x;
        numbers[kNumbers * lane + 4] = reach.hi.y;
        numbers[kNumbers * lane + 5] = reach.hi.z;
        numbers[kNumbers * lane + 6] = reach.delta;
        reaches[lane] = reach;
        triangles[lane] = triangleOf(at, reach.delta);
    }
}

#ifdef CLEARANCE
/// Of the cells that may have something opaque.
void findNearCells(uvec4 entry, ivec3 brick, ivec3 corner, AlongBrick direction) {
    const MarginSpace by = clearanceSpace(entry.x);
    uint seen = 0;
    for (uint word = 0; word < kCellWords; ++word) {
        if ((mayBits(entry.z, word) >> gl_LocalInvocationIndex & 1u) != 0) {
            const uint number = 32 * word + gl_LocalInvocationIndex;
            ++seen;
            if (cellAlong(direction, vec3(cellOf(corner, number)) + 0.5 - brickCentre(brick)) < by.margin) {
                nearCells[atomicAdd(nearCount, 1u)] = number;
            }
        }
    }
    countWork(VOXTACT_WORK_CELLS, seen);
}
#else
void findNearCells(uvec4 entry, ivec3 brick, ivec3 corner) {
    const MarginSpace by = MARGIN_SPACE(entry.x);
    const CertifiedReach reach = reachOfAll();
    const CellBox inside = within(cellsOf(marginBounds(constants.item, by, reach)), brick);
    const int cells = isEmpty(inside) ? 0 : volumeOf(inside);
    countWork(VOXTACT_WORK_CELLS, gl_LocalInvocationIndex == 0 ? uint(cells) : 0);
    for (int i = int(gl_LocalInvocationIndex); i < cells; i += VOXTACT_MARGIN_GROUP) {
        const ivec3 cell = placeIn(inside, i);
        const vec3 middle = vec3(cell) + 0.5;
        if (!marginReachFarther(by, reach, voxelPoint(middle.x, middle.y, middle.z), voxelPoint(0.5, 0.5, 0.5))) {
            nearCells[atomicAdd(nearCount, 1u)] = numberIn(corner, cell);
        }
    }
}
#endif

void findOpaqueCells(uvec4 entry, ivec3 brick, ivec3 corner ALONG(direction)) {
    const vec4 range = brickAt(brick);
#ifdef CLEARANCE
    const MarginSpace by = clearanceSpace(entry.x);
#endif
    for (uint i = gl_LocalInvocationIndex; i < nearCount; i += VOXTACT_MARGIN_GROUP) {
        const ivec3 cell = cellOf(corner, nearCells[i]);
        CertifiedCell known = certifiedCell(constants.item, cornersOf(cell, range), cell.x, cell.y, cell.z, 0.0);
#ifdef OF_LABEL
        const uint octants = octantsOf(cell).own;
        if (octants == 0) {
            continue;
        }
        known = partOfCell(known, octants);
#endif
        if (marginCellMay(opacities(), known)) {
            uint listed = nearCells[i];
#ifdef CLEARANCE
            // Once for all triangles: what is opaque of most cells is farther than the cell.
            if (partAlong(by, direction, known, vec3(cell) - brickCentre(brick)) >= by.margin) {
                continue;
            }
#else
            listed |= uint(marginCellHas(opacities(), known)) << kHasShift;
#endif
            opaqueCells[atomicAdd(opaqueCount, 1u)] = listed;
            atomicMin(opaqueLo.x, cell.x);
            atomicMin(opaqueLo.y, cell.y);
            atomicMin(opaqueLo.z, cell.z);
            atomicMax(opaqueHi.x, cell.x);
            atomicMax(opaqueHi.y, cell.y);
            atomicMax(opaqueHi.z, cell.z);
        }
    }
}

void findNearTriangles(uvec4 entry) {
    const uint lane = gl_LocalInvocationIndex;
    if (opaqueCount > 0 && lane < VOXTACT_RUN_TRIANGLES && isOfEntry(entry, lane)) {
        const vec3 middle = vec3(opaqueLo + opaqueHi + 1) * 0.5;
        const vec3 radius = vec3(opaqueHi - opaqueLo + 1) * 0.5;
        if (!marginBoxFarther(MARGIN_SPACE(entry.x), triangles[lane], voxelPoint(middle.x, middle.y, middle.z),
                              voxelPoint(radius.x, radius.y, radius.z))) {
            nearTriangles[atomicAdd(nearTriangleCount, 1u)] = lane;
        }
    }
}

/// Whether a cell is in the box of those that are within the margin of a triangle, along each axis.
bool isInBox(ivec3 cell, CellBox box) {
    return all(greaterThanEqual(cell, box.lo)) && all(lessThanEqual(cell, box.hi));
}

/// Puts a cell that needs a decision into the queue.
void putCell(uvec4 entry, uint i, ivec3 cell) {
    const uint room = VOXTACT_ROOM_CELLS(constants.queueRoom);
    const uint place = reserve(VOXTACT_QUEUE_CELLS, 1, room, VOXTACT_COMPUTE_GROUP);
    if (place < room) {
        quads[quadOf(VOXTACT_WORD_CELLS, place)] = uvec4(entry.x, triangleOfRun(entry, i), packCell(cell));
    } else {
        atomicOr(full, 1u);
    }
}

#ifdef CLEARANCE
/// Looks at each cell of each near triangle: those go on that may be nearer than what is known.
void lookAtAll(uvec4 entry, ivec3 corner) {
    const MarginSpace by = MARGIN_SPACE(entry.x);
    const uint count = opaqueCount * nearTriangleCount;
    uint seen = 0;
    for (uint place = gl_LocalInvocationIndex; place < count; place += VOXTACT_MARGIN_GROUP) {
        const uint number = opaqueCells[place % opaqueCount];
        const uint i = nearTriangles[place / opaqueCount];
        const ivec3 cell = cellOf(corner, number);
        if (!isInBox(cell, cellsOf(marginBounds(constants.item, by, reaches[i])))) {
            continue;
        }
        ++seen;
        if (cellClearance(by, triangles[i], 0, cell).below < clearanceLimit(by, by.margin, clearanceHi(entry.x))) {
            putCell(entry, i, cell);
        }
    }
    countWork(VOXTACT_WORK_CELLS, seen);
}
#else
void lookAtAll(uvec4 entry, ivec3 corner) {
    const MarginSpace by = MARGIN_SPACE(entry.x);
    const uint count = opaqueCount * nearTriangleCount;
    uint seen = 0;
    for (uint place = gl_LocalInvocationIndex; place < count; place += VOXTACT_MARGIN_GROUP) {
        const uint listed = opaqueCells[place % opaqueCount];
        const uint i = nearTriangles[place / opaqueCount];
        const ivec3 cell = cellOf(corner, listed);
        if (!isInBox(cell, cellsOf(marginBounds(constants.item, by, reaches[i])))) {
            continue;
        }
        ++seen;
        const int verdict = marginCellLook(by, constants.item, triangles[i], int(listed >> kHasShift), cell.x, cell.y,
                                           cell.z);
        if (verdict == CERTIFIED_CERTAIN) {
            markWithin(entry.x);
        } else if (verdict == CERTIFIED_UNDECIDED) {
            putCell(entry, i, cell);
        }
    }
    countWork(VOXTACT_WORK_CELLS, seen);
}
#endif

/// Leaves the work group's entry, of that number, to certified_margin_finish.
void leaveOrRefuse(uint number, uint pair, uint brick, uint groups) {
    if (!leave(VOXTACT_LEFT_LARGE, number, brick, groups)) {
#ifdef CLEARANCE
        refuse(pair);
#else
        markUndecided(pair);
#endif
    }
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
#ifdef CLEARANCE
    const uint number = queues[constants.queueWord + VOXTACT_WORD_NEAREST(constants.queueRoom) + gl_WorkGroupID.x];
#else
    const uint number = gl_WorkGroupID.x;
#endif
    const uvec4 entry = quads[quadOf(LARGE_WORD, number)];
    if (lane == 0) {
        passedOver = isDone(entry.x) ? 1 : 0;
        full = 0;
        cut = 0;
        nearCount = 0;
        opaqueCount = 0;
        nearTriangleCount = 0;
        opaqueLo = ivec3(0x7fffffff);
        opaqueHi = ivec3(-0x7fffffff);
    }
    barrier();
    if (passedOver != 0) {
        return;
    }
    if ((entry.w & VOXTACT_MARGIN_ALL) != 0) {
        if (lane == 0) {
            const CertifiedPair transform = transforms[entry.x];
            const CertifiedBounds bounds = boundsOf(entry.x, verticesOf(transform, entry.y));
            leaveOrRefuse(number, entry.x, 0, groupsOfTriangle(transform, bounds, cellsOf(bounds)));
        }
        return;
    }
#ifdef CLEARANCE
    const uint brickNumber = brickOfEntry(entry.z);
#else
    const uint brickNumber = entry.z;
#endif
    const ivec3 brick = brickOf(int(brickNumber));
    const ivec3 corner = (brick << VOXTACT_BRICK_SHIFT) - 1;
    findTriangles(entry);
    barrier();
    findReach(entry);
    barrier();
#ifdef CLEARANCE
    const bool some = lane < VOXTACT_RUN_TRIANGLES && isOfEntry(entry, lane);
    const AlongBrick direction =
        findAlong(MARGIN_SPACE(entry.x), some, triangles[some ? lane : 0], reachOfAll(), brickCentre(brick));
#endif
    findNearCells(entry, brick, corner WITH_ALONG(direction));
    barrier();
    findOpaqueCells(entry, brick, corner WITH_ALONG(direction));
    barrier();
    findNearTriangles(entry);
    barrier();
    lookAtAll(entry, corner);
    if (isCut()) {
        atomicOr(cut, 1u);
    }
    barrier();
    // What is decided twice does no harm.
    if (lane == 0 && (full != 0 || cut != 0)) {
        leaveOrRefuse(number, entry.x, brickNumber, VOXTACT_RUN_TRIANGLES);
    }
}

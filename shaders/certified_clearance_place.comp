// SPDX-License-Identifier: MIT
// Where the closest points of pairs are wanted, after the search: a lane per pair makes one point of what proves its
// distance. Something is opaque in a brick or a cell, or between two points of one, as the interpolant takes all values
// in between; so halving leads there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#define CLEARANCE
#define SMALL_PROGRAM
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"

/// Halvings of a way: as far as single precision goes.
const int kHalvings = 30;
/// Voxels of a brick along an axis, those at both ends among them.
const int kBrickVoxels = kBrickSide + 1;

/// Cells of a volume, so many along each axis.
struct Block {
    ivec3 first;
    int side;
    float error; // of an entry coordinate in them
};

CertifiedCell cellOf(ivec3 cell) {
    return certifiedCell(constants.item, cornersInBrick(cell, vec4(0.0)), cell.x, cell.y, cell.z, 0.0);
}

/// The interpolant at a point about the first cell's corner.
float entryAt(Block block, VoxelPoint at) {
    const ivec3 cell = clamp(ivec3(floor(vec3(at.x, at.y, at.z))), ivec3(0), ivec3(block.side - 1));
    return certifiedInterpolate(cellOf(block.first + cell), at.x - float(cell.x), at.y - float(cell.y),
                                at.z - float(cell.z));
}

/// From the least value of a cell to the greatest.
ClosestPlace acrossCell(ClosestPlace place) {
    const CertifiedCell cell = cellOf(place.cell);
    float least = CERTIFIED_FARTHEST;
    float greatest = -CERTIFIED_FARTHEST;
    for (int i = 0; i < 8; ++i) {
        const VoxelPoint at = voxelPoint((i & 1) == 0 ? cell.lo.x : cell.hi.x, (i & 2) == 0 ? cell.lo.y : cell.hi.y,
                                         (i & 4) == 0 ? cell.lo.z : cell.hi.z);
        const float entry = certifiedInterpolate(cell, at.x, at.y, at.z);
        if (entry < least) {
            least = entry;
            place.from = at;
        }
        if (entry > greatest) {
            greatest = entry;
            place.to = at;
        }
    }
    return place;
}

/// The same of a brick's voxels: its range is that of these.
ClosestPlace acrossBrick(ClosestPlace place) {
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    float least = CERTIFIED_FARTHEST;
    float greatest = -CERTIFIED_FARTHEST;
    for (int i = 0; i < kBrickVoxels * kBrickVoxels * kBrickVoxels; ++i) {
        const int row = i / kBrickVoxels;
        const ivec3 voxel =
            clamp(place.cell + ivec3(i % kBrickVoxels, row % kBrickVoxels, row / kBrickVoxels), ivec3(0), last);
        const vec3 at = vec3(voxel - place.cell);
        const float entry = certifiedEntry(constants.item, storedAt(voxel));
        if (entry < least) {
            least = entry;
            place.from = voxelPoint(at.x, at.y, at.z);
        }
        if (entry > greatest) {
            greatest = entry;
            place.to = voxelPoint(at.x, at.y, at.z);
        }
    }
    return place;
}

bool isOpaque(Block block, float entry) {
    return certainlyAllOpaque(opacities(), entry - block.error, entry + block.error);
}

/// An opaque point of the straight way from `from` to `to`, up to rounding.
VoxelPoint opaqueOn(Block block, VoxelPoint from, VoxelPoint to) {
    const float atFrom = entryAt(block, from);
    const float atTo = entryAt(block, to);
    if (isOpaque(block, atFrom)) {
        return from;
    }
    if (isOpaque(block, atTo)) {
        return to;
    }
    const float wanted = opaqueBetween(opacities(), min(atFrom, atTo) + block.error, max(atFrom, atTo) - block.error);
    VoxelPoint below = atFrom <= atTo ? from : to;
    VoxelPoint above = atFrom <= atTo ? to : from;
    for (int i = 0; i < kHalvings; ++i) {
        const VoxelPoint middle = certifiedMiddle(below, above);
        if (entryAt(block, middle) <= wanted) {
            below = middle;
        } else {
            above = middle;
        }
    }
    return isOpaque(block, entryAt(block, above)) ? above : below;
}

/// What a value may be off by, as what proved the place had it.
float errorOf(ClosestPlace place) {
    const vec4 range = brickAt((place.cell + 1) >> VOXTACT_BRICK_SHIFT);
    if (place.kind == VOXTACT_CLOSEST_IN_BRICK) {
        return certifiedPointError(constants.item, range.x, range.y);
    }
    const CertifiedCorners corners = cornersOf(place.cell, range);
    return certifiedPointError(constants.item, corners.wideLo, corners.wideHi);
}

VoxelPoint pointAt(uint word) {
    return voxelPoint(uintBitsToFloat(queues[word]), uintBitsToFloat(queues[word + 1]),
                      uintBitsToFloat(queues[word + 2]));
}

void main() {
    if (gl_GlobalInvocationID.x >= constants.endCluster) {
        return;
    }
    const uint word = closestWord(constants.firstPair + gl_GlobalInvocationID.x);
    const uint cell = word + VOXTACT_CLOSEST_CELL;
    ClosestPlace place = ClosestPlace(queues[word + VOXTACT_CLOSEST_KIND],
                                      ivec3(queues[cell], queues[cell + 1], queues[cell + 2]),
                                      pointAt(word + VOXTACT_CLOSEST_FROM), pointAt(word + VOXTACT_CLOSEST_TO));
    if (place.kind == VOXTACT_CLOSEST_ON_WAY && place.from == place.to) {
        return;
    }
    const bool ofBrick = place.kind == VOXTACT_CLOSEST_IN_BRICK;
    const float error = errorOf(place);
    if (ofBrick) {
        place = acrossBrick(place);
    } else if (place.kind == VOXTACT_CLOSEST_IN_CELL) {
        place = acrossCell(place);
    }
    writePoint(word + VOXTACT_CLOSEST_FROM,
               opaqueOn(Block(place.cell, ofBrick ? kBrickSide : 1, error), place.from, place.to));
}

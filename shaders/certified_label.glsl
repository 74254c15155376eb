// SPDX-License-Identifier: MIT
// Where clearances to labels are measured: what of the volume has the label that the search is about. A label fills the
// closed boxes around its voxels' centres; in a cell these are octants, each of which one corner's voxel has. Which nodes
// of brick_levels.h may have a label is known of its number modulo VOXTACT_LABEL_BITS. Expects certified_queues.glsl.
#ifndef VOXTACT_CERTIFIED_LABEL_GLSL
#define VOXTACT_CERTIFIED_LABEL_GLSL

layout(set = VOXTACT_SET_LABELS, binding = 0) uniform usampler3D labelMap;
layout(set = VOXTACT_SET_LABELS, binding = VOXTACT_BINDING_LABEL_NODES, std430) readonly buffer LabelNodes {
    uvec4 labelNodes[];
};

// VOXTACT_LABEL_* of the search.
uvec4 labelSearch = quads[quadOf(VOXTACT_WORD_LABEL(constants.queueRoom), 0)];

bool nodeMayHaveLabel(int node) {
    const uint number = labelSearch[VOXTACT_LABEL_NUMBER] % VOXTACT_LABEL_BITS;
    return (labelNodes[node][number / 32u] >> number % 32u & 1u) != 0;
}

/// Whether a brick that may have the label has it: no other label of the map has its bit.
bool areLabelNodesCertain() {
    return labelSearch[VOXTACT_LABEL_CERTAIN] != 0;
}

/// Octants of a cell, a bit each, by the corner that they are at: x has the lowest bit.
struct LabelOctants {
    uint inVolume;
    uint own; // have the label
};

LabelOctants octantsOf(ivec3 cell) {
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    LabelOctants found = LabelOctants(0, 0);
    for (int i = 0; i < 8; ++i) {
        const ivec3 voxel = cell + ivec3(i & 1, i >> 1 & 1, i >> 2);
        if (all(greaterThanEqual(voxel, ivec3(0))) && all(lessThanEqual(voxel, last))) {
            found.inVolume |= 1u << i;
            found.own |= texelFetch(labelMap, voxel, 0).r == labelSearch[VOXTACT_LABEL_NUMBER] ? 1u << i : 0u;
        }
    }
    return found;
}

// The octants on either side of a cell's middle.
const uvec3 kLowOctants = uvec3(0x55u, 0x33u, 0x0fu);
const uvec3 kHighOctants = uvec3(0xaau, 0xccu, 0xf0u);

/// The box around some octants of a cell, in place of all of it. What is said of its values holds of the cell.
CertifiedCell partOfCell(CertifiedCell cell, uint octants) {
    const bvec3 low = notEqual(kLowOctants & octants, uvec3(0));
    const bvec3 high = notEqual(kHighOctants & octants, uvec3(0));
    CertifiedCell part = cell;
    part.lo = voxelPoint(low.x ? cell.lo.x : max(cell.lo.x, 0.5), low.y ? cell.lo.y : max(cell.lo.y, 0.5),
                         low.z ? cell.lo.z : max(cell.lo.z, 0.5));
    part.hi = voxelPoint(high.x ? cell.hi.x : min(cell.hi.x, 0.5), high.y ? cell.hi.y : min(cell.hi.y, 0.5),
                         high.z ? cell.hi.z : min(cell.hi.z, 0.5));
    return part;
}

/// Some of the octants that are left, as many as fill a box: all, or one.
uint nextPart(uint octants) {
    const uvec3 sides = uvec3(notEqual(kLowOctants & octants, uvec3(0))) +
                        uvec3(notEqual(kHighOctants & octants, uvec3(0)));
    return uint(bitCount(octants)) == sides.x * sides.y * sides.z ? octants : octants & (~octants + 1u);
}

/// Whether a cell certainly has something opaque that has the label.
bool labelledCellHas(LabelOctants octants, int has) {
    return octants.own == octants.inVolume ? has != 0 : octants.own != 0 && has >= MARGIN_HAS_ALL;
}

/// Whether a brick of stored values from `lo` to `hi`, none of which is NaN, is opaque all over.
bool brickIsAllOpaque(float lo, float hi) {
    const float first = certifiedEntry(constants.item, lo);
    const float second = certifiedEntry(constants.item, hi);
    const float error = certifiedPointError(constants.item, lo, hi);
    precise float below = min(first, second) - error;
    precise float above = max(first, second) + error;
    return certainlyAllOpaque(OpacityTable(constants.item.tableSize, constants.item.tableLevels,
                                           constants.item.threshold), below, above);
}

#endif

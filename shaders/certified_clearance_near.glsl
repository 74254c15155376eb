// SPDX-License-Identifier: MIT
// Where clearances are measured: which bricks are near a box of triangles. Expects certified_scene.glsl, and
// certified_clearance_blocks.glsl.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_NEAR_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_NEAR_GLSL

/// What a box of triangles is no nearer than to a cube, given by its middle and half its side.
float cubeBelow(MarginSpace by, CertifiedReach reach, vec3 middle, float radius) {
    const MarginApart apart = marginReachApart(by, reach, voxelPoint(middle.x, middle.y, middle.z),
                                               voxelPoint(radius, radius, radius));
    return clearanceBelow(apart.gap, apart.square, apart.slack);
}

/// No point of the brick is farther from a vertex, which may be off by `delta`.
float brickAbove(MarginSpace by, VoxelPoint vertex, float delta, vec3 middle) {
    const VoxelPoint from = voxelDifference(vertex, voxelPoint(middle.x, middle.y, middle.z));
    const float slack = marginSlack(by, delta, voxelLength(from) + MARGIN_BRICK_RADIUS);
    return clearanceAbove(by, slack + 2.0 * MARGIN_BRICK_RADIUS * marginCellRadius(by), from,
                          voxelPoint(0.0, 0.0, 0.0));
}

/// Of the bricks that may have something opaque, what the box of triangles is no nearer than (`open`); and, where they
/// certainly have, what it is no farther than: `vertex` is of the mesh.
ClearanceFound lookAround(MarginSpace given, CertifiedReach reach, VoxelPoint vertex) {
    MarginSpace by = given;
    ClearanceFound found = nothingFound();
    const Blocks blocks = blocksOfVolume();
    const int count = numberOfBlocks(blocks);
    const float radius = MARGIN_BRICK_RADIUS * float(1 << blocks.shift);
    for (int number = 0; number < count; ++number) {
        const CellBox bricks = bricksOfBlock(blocks, number);
        if (!blockMayBeOpaque(number) ||
            cubeBelow(by, reach, vec3((bricks.lo << VOXTACT_BRICK_SHIFT) - 1) + radius, radius) >= by.margin) {
            continue;
        }
        const int most = volumeOf(bricks);
        for (int i = 0; i < most; ++i) {
            const ivec3 brick = placeIn(bricks, i);
            const vec3 middle = brickCentre(brick);
            const float below = cubeBelow(by, reach, middle, MARGIN_BRICK_RADIUS);
            if (below >= by.margin) {
                continue;
            }
            const vec4 range = brickAt(brick);
            if (!brickMayBeOpaque(range)) {
                continue;
            }
            found.open = min(found.open, below);
            const float above = brickAbove(by, vertex, reach.delta, middle);
            if (above < found.hi && constants.item.storedUnit > 0.0 && // whole numbers: none is NaN
                marginRangeHas(opacities(), constants.item, range.x, range.y)) {
                found.hi = above;
                by.margin = clearanceLimit(by, by.margin, above);
            }
        }
    }
    return found;
}

#endif

// SPDX-License-Identifier: MIT
// Where clearances are measured: which bricks are near a box of triangles. Expects certified_scene.glsl.
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

// What a lane has yet to look into: nodes of the levels of brick_levels.h, and what each is no nearer than.
const int kWaiting = 7 * VOXTACT_MOST_LEVELS + 8;
/// Nodes that a lane looks at; what it does not come to is as near as the box of what waits then.
const int kMostNodes = 4096;

struct LevelNode {
    int level;
    ivec3 place;
};

int numberOf(LevelNode node) {
    const BrickLevel level = brickLevel(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ, node.level);
    return level.first + node.place.x + level.countX * (node.place.y + level.countY * node.place.z);
}

/// Whether a brick of stored values as `range` says certainly has something that is looked for.
bool brickHas(vec4 range) {
    if (constants.item.storedUnit == 0.0) { // whole numbers: none is NaN
        return false;
    }
#ifdef OF_LABEL
    return areLabelNodesCertain() && brickIsAllOpaque(range.x, range.y);
#else
    return marginRangeHas(opacities(), constants.item, range.x, range.y);
#endif
}

bool isInVolume(LevelNode node) {
    const int shift = VOXTACT_BRICK_SHIFT + VOXTACT_LEVEL_SHIFT * node.level;
    return all(lessThanEqual(node.place << shift,
                             ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ)));
}

/// Half its side, in voxels.
float radiusOf(int level) {
    return MARGIN_BRICK_RADIUS * float(1 << VOXTACT_LEVEL_SHIFT * level);
}

vec3 middleOf(LevelNode node) {
    const float radius = radiusOf(node.level);
    return vec3(node.place) * (2.0 * radius) + (radius - 1.0);
}

/// A brick that may have what is looked for, no nearer than `below`: takes it into account.
void lookAtBrick(inout MarginSpace by, CertifiedReach reach, VoxelPoint vertex, LevelNode node, vec4 range, float below,
                 inout ClearanceFound found) {
    found.open = min(found.open, below);
    const float above = brickAbove(by, vertex, reach.delta, middleOf(node));
    if (above < found.hi && brickHas(range)) {
        found.hi = above;
        found.place = closestIn(VOXTACT_CLOSEST_IN_BRICK, (node.place << VOXTACT_BRICK_SHIFT) - 1);
        by.margin = clearanceLimit(by, by.margin, above);
    }
}

/// Of the bricks that may have something opaque, what the box of triangles is no nearer than (`open`), or, where `any`,
/// one that is near enough; and, where they certainly have, what it is no farther than: `vertex` is of the mesh. Goes
/// down from all of the volume, to what is nearest first.
ClearanceFound lookAround(MarginSpace given, CertifiedReach reach, VoxelPoint vertex, bool any) {
    MarginSpace by = given;
    ClearanceFound found = nothingFound();
    LevelNode waiting[kWaiting];
    float below[kWaiting];
    const ivec3 size = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ);
    const int top = brickLevels(size.x, size.y, size.z) - 1;
    waiting[0] = LevelNode(top, ivec3(0));
    below[0] = 0.0;
    int count = nodeMay(numberOf(waiting[0])) ? 1 : 0;
    int looks = 0;
    while (count > 0 && looks + 8 <= kMostNodes && !(any && found.open < by.margin)) {
        --count;
        const LevelNode node = waiting[count];
        const float least = below[count];
#ifdef OF_LABEL
        // Of most bricks with a label it is not certain that they have something: the nearest is looked for.
        const bool farther = least >= found.open;
#else
        // Of floats no brick is certain to have something: there is nothing to look for but the nearest.
        const bool farther = least >= found.open &&
                             (found.hi < VOXTACT_CLEARANCE_FAR || constants.item.storedUnit == 0.0);
#endif
        if (least >= by.margin || farther) {
            continue;
        }
        if (node.level == 0) {
            lookAtBrick(by, reach, vertex, node, bricks[numberOf(node)], least, found);
            continue;
        }
        // Of its eight parts the nearest is the last.
        const ivec3 near = ivec3(lessThan(middleOf(node), vec3(vertex.x, vertex.y, vertex.z)));
        for (int i = 7; i >= 0; --i) {
            const ivec3 part = ivec3(i & 1, i >> 1 & 1, i >> 2) ^ near;
            const LevelNode child = LevelNode(node.level - 1, (node.place << VOXTACT_LEVEL_SHIFT) + part);
            ++looks;
            if (!isInVolume(child)) {
                continue;
            }
            const float own = max(least, cubeBelow(by, reach, middleOf(child), radiusOf(child.level)));
            if (own < by.margin && nodeMay(numberOf(child))) {
                waiting[count] = child;
                below[count++] = own;
            }
        }
    }
    countWork(VOXTACT_WORK_BRICKS, uint(looks));
    while (count > 0) {
        found.open = min(found.open, below[--count]);
    }
    return found;
}

#endif

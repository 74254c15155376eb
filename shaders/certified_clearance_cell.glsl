// SPDX-License-Identifier: MIT
// Where clearances are measured: how near what is opaque in a cell is to a triangle. Expects certified_scene.glsl.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_CELL_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_CELL_GLSL

/// What a box of a cell, seen from the triangle, is no nearer than.
float boxBelow(MarginSpace by, MarginTriangle about, MarginNear near, VoxelPoint radius) {
    return clearanceBelow(marginBoxShadow(marginPulled(by, near.along), radius) - near.shadow,
                          voxelDot(near.along, near.along), about.slack);
}

/// A cell of a triangle as a whole: what it is no nearer than, and, where it `has` something opaque (marginCellHas()),
/// what that is no farther than, and where it is.
struct CellClearance {
    float below;
    float above;
    ClosestPlace place;
};

CellClearance cellClearance(MarginSpace by, CertifiedTriangle triangle, int has, ivec3 cell) {
    const vec3 middle = vec3(cell) + 0.5;
    const MarginTriangle about = marginTriangle(by, triangle, voxelPoint(middle.x, middle.y, middle.z), 0.5);
    const VoxelPoint none = voxelPoint(0.0, 0.0, 0.0);
    const MarginNear near = marginNear(by, about, none);
    CellClearance found;
    found.below = boxBelow(by, about, near, voxelPoint(0.5, 0.5, 0.5));
    found.above = VOXTACT_CLEARANCE_FAR;
    found.place = closestIn(VOXTACT_CLOSEST_IN_CELL, cell);
    if (has != 0) {
        found.above = clearanceAbove(by, about.slack + marginCellRadius(by), near.at, none);
    }
    if (has >= MARGIN_HAS_ALL) {
        const VoxelPoint nearest = voxelPoint(marginInCell(near.at.x, cell.x, constants.item.sizeX),
                                              marginInCell(near.at.y, cell.y, constants.item.sizeY),
                                              marginInCell(near.at.z, cell.z, constants.item.sizeZ));
        const float above = clearanceAbove(by, about.slack, near.at, nearest);
        if (above < found.above) {
            found.above = above;
            const VoxelPoint at = voxelStep(nearest, voxelPoint(0.5, 0.5, 0.5), 1.0); // about the corner
            found.place = closestWay(cell, at, at);
        }
    }
    return found;
}

/// Boxes of a cell that are looked at: more than a margin needs, as far away all of a cell's surface is about as near.
#ifdef OF_LABEL
const int kMostBoxes = 512; // of a part of it, of which there may be eight
#else
const int kMostBoxes = 2048;
#endif
/// Of a hopeless cell.
const int kFewBoxes = 64;
/// Halvings that suffice to see of most cells that they are too far.
const int kFewSteps = 5;

/// What may be opaque in a cell is no nearer to a triangle, both about the cell's corner.
float partBelow(MarginSpace by, CertifiedCell cell, MarginTriangle about) {
    const MarginBox box = marginCellBox(cell);
    const VoxelPoint middle = marginMiddle(box);
    const VoxelPoint radius = marginRadius(box);
    const MarginNear near = marginNear(by, about, middle);
    const MarginValues values = marginCellValues(opacities(), cell, kFewSteps);
    return clearanceBelow(marginPartGap(by, cell, values, near, marginLinear(cell, box), radius),
                          voxelDot(near.along, near.along), about.slack);
}

/// Whether values of a cell are known so badly that each may be any of the table's: no point of it proves anything, and
/// most of its boxes are as open as the whole.
bool isHopeless(CertifiedCell cell) {
    return !(cell.pointError < float(constants.item.tableSize)) &&
           !certainlyAllOpaque(opacities(), cell.least - cell.pointError, cell.greatest + cell.pointError);
}

/// Values at points of a cell, none farther from the triangle than `farthest`.
struct ClearanceSamples {
    MarginSamples values;
    float farthest;
    VoxelPoint atLo; // where the least of them is
    VoxelPoint atHi;
};

ClearanceSamples noSamples() {
    const VoxelPoint none = voxelPoint(0.0, 0.0, 0.0);
    return ClearanceSamples(marginNoSamples(), 0.0, none, none);
}

/// Takes a point into account that is so far from the triangle, nearer than `found.hi`: opaque, or opaque between it
/// and another one, as in marginPointProves(). `number`: the cell.
void tryPoint(CertifiedCell cell, ivec3 number, VoxelPoint at, float distance, inout ClearanceSamples samples,
              inout ClearanceFound found) {
    if (samples.farthest >= found.hi) {
        samples = noSamples();
    }
    MarginSamples alone = marginNoSamples();
    if (marginPointProves(opacities(), cell, at, alone)) {
        found.hi = distance;
        found.place = closestWay(number, at, at);
        return;
    }
    samples.farthest = max(samples.farthest, distance);
    if (!samples.values.some || alone.lo < samples.values.lo) {
        samples.atLo = at;
    }
    if (!samples.values.some || alone.hi > samples.values.hi) {
        samples.atHi = at;
    }
    if (marginPointProves(opacities(), cell, at, samples.values)) {
        found.hi = samples.farthest;
        found.place = closestWay(number, samples.atLo, samples.atHi);
    }
}

/// Halvings that suffice for a point that is opaque, most likely.
const int kPointSteps = 10;

/// One look at a cell, `number`, about whose corner the triangle is: returns what it is no nearer than, what may be opaque
/// in it, and tries one point.
float firstLook(MarginSpace by, CertifiedCell cell, ivec3 number, MarginTriangle about, inout ClearanceFound found) {
    const MarginBox box = marginCellBox(cell);
    const VoxelPoint middle = marginMiddle(box);
    const VoxelPoint radius = marginRadius(box);
    const MarginNear near = marginNear(by, about, middle);
    const MarginValues values = marginCellValues(opacities(), cell, kPointSteps);
    const MarginLinear linear = marginLinear(cell, box);
    const VoxelPoint at = marginClamped(box, marginFoot(by, cell, values, linear, middle, radius, near.at));
    const float distance = clearanceAbove(by, about.slack, near.at, at);
    if (distance < found.hi) {
        ClearanceSamples samples = noSamples();
        tryPoint(cell, number, at, distance, samples, found);
    }
    return clearanceBelow(marginPartGap(by, cell, values, near, linear, radius), voxelDot(near.along, near.along),
                          about.slack);
}

/// Looks for the nearest opaque point of a cell, as marginDecide() does: boxes that are nearer than what is known are
/// halved until what may be opaque in them is not.
void measureBoxes(uint pair, MarginSpace by, CertifiedTriangle triangle, CertifiedCell cell, ivec3 number,
                  inout ClearanceFound found) {
    const VoxelPoint corner = voxelPoint(float(number.x), float(number.y), float(number.z));
    const MarginTriangle about = marginTriangle(by, triangle, corner, 1.0);
    const float asked = clearanceAsked(pair);
    const float whole = partBelow(by, cell, about);
    found.hi = min(found.hi, clearanceHi(pair));
    if (whole >= clearanceLimit(by, asked, found.hi)) {
        return;
    }
    const MarginValues known = marginCellValues(opacities(), cell, MARGIN_VALUE_STEPS);
    const int most = isHopeless(cell) ? kFewBoxes : kMostBoxes;
    ClearanceSamples samples = noSamples();
    MarginBox stack[MARGIN_STACK];
    float below[MARGIN_STACK];
    stack[0] = marginCellBox(cell);
    below[0] = whole;
    int waiting = 1;
    int boxes = 0;
    while (waiting > 0) {
        --waiting;
        const MarginBox box = stack[waiting];
        float least = below[waiting];
        found.hi = min(found.hi, clearanceHi(pair));
        if (least >= clearanceLimit(by, asked, found.hi)) {
            continue;
        }
        if (boxes == most) {
            found.open = min(found.open, max(least, kNoDistance));
            continue;
        }
        ++boxes;
        const VoxelPoint middle = marginMiddle(box);
        const VoxelPoint radius = marginRadius(box);
        const MarginLinear linear = marginLinear(cell, box);
        if (!certifiedMayBeOpaque(opacities(), linear.lo, linear.hi, cell.pointError)) {
            continue;
        }
        const MarginValues values =
            marginValues(opacities(), linear.lo - cell.pointError, linear.hi + cell.pointError, known,
                         MARGIN_VALUE_STEPS);
        const MarginNear near = marginNear(by, about, middle);
        least = max(least, clearanceBelow(marginPartGap(by, cell, values, near, linear, radius),
                                          voxelDot(near.along, near.along), about.slack));
        if (least >= clearanceLimit(by, asked, found.hi)) {
            continue;
        }
        const VoxelPoint points[3] = {middle, near.at,
                                      marginFoot(by, cell, values, linear, middle, radius, near.at)};
        for (int i = 0; i < 3; ++i) {
            const VoxelPoint at = marginClamped(box, points[i]);
            const float distance = clearanceAbove(by, about.slack, near.at, at);
            if (distance < found.hi) {
                tryPoint(cell, number, at, distance, samples, found);
            }
        }
        if (least >= clearanceLimit(by, asked, found.hi)) {
            continue;
        }
        const int axis = marginLongest(by, box);
        if (axis < 0 || waiting + 2 > MARGIN_STACK) {
            found.open = min(found.open, max(least, kNoDistance));
            continue;
        }
        const float at = (voxelAlong(box.lo, axis) + voxelAlong(box.hi, axis)) * 0.5;
        const bool upperFirst = voxelAlong(marginPulled(by, near.along), axis) < 0.0;
        below[waiting] = least;
        stack[waiting++] = marginHalf(box, axis, at, !upperFirst);
        below[waiting] = least;
        stack[waiting++] = marginHalf(box, axis, at, upperFirst);
    }
}

/// A cell of a triangle, in a brick of stored values as `range` says. Returns what it is no nearer than.
float measureCell(uint pair, CertifiedTriangle triangle, ivec3 at, vec4 range, inout ClearanceFound found) {
    const MarginSpace by = clearanceSpace(pair);
    const float below = cellClearance(by, triangle, 0, at).below;
    if (below >= clearanceLimit(by, by.margin, found.hi)) {
        return below;
    }
    const CertifiedCell cell =
        certifiedCell(constants.item, cornersOf(at, range), at.x, at.y, at.z, triangle.delta);
    if (!marginCellMay(opacities(), cell)) {
        return below;
    }
#ifdef OF_LABEL
    uint left = octantsOf(at).own;
    while (left != 0) {
        const uint part = nextPart(left);
        left &= ~part;
        measureBoxes(pair, by, triangle, partOfCell(cell, part), at, found);
    }
#else
    measureBoxes(pair, by, triangle, cell, at, found);
#endif
    return below;
}

/// Adds what a lane has found of a pair to what is known, with that triangle. `least`: nothing that it looked at is
/// nearer, whatever became of its loops.
void tellFound(uint pair, uint triangle, ClearanceFound found, float least) {
    if (isCut()) {
        leaveOpen(pair, least);
        return;
    }
    if (found.hi < clearanceHi(pair)) {
        foundAt(pair, triangle, found.hi, found.place);
    }
    if (found.open < VOXTACT_CLEARANCE_FAR) {
        leaveOpen(pair, found.open);
    }
}

#endif

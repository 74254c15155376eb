// SPDX-License-Identifier: MIT
// The `exact` arithmetic: one text for GLSL and C++, so that the compute shader and the host count the same, bit for
// bit. Coverage is integer arithmetic; everything else is fp32 addition, multiplication and floor in the order that is
// written here, without contraction (`precise` in GLSL, -ffp-contract=off in C++). There is no division and no square
// root, whose precision Vulkan leaves to the device. Rounding is to nearest even.
#ifndef VOXTACT_EXACT_H
#define VOXTACT_EXACT_H

#include "shared.h"

/// Sub-pixel steps in a pixel: 8 fraction bits, as every rasteriser at hand has.
#define EXACT_SUBPIXEL 256
/// Clipping keeps coordinates within this many pixels of the viewport's centre, so that longToFloat() can convert edge
/// functions, at most 2^49. It is also the largest viewport.
#define EXACT_GUARD_PIXELS 16384.0f
/// Sub-pixels of a corner lie within this. The guard band keeps to 3/4 of it; a cut whose rounding was bad may not.
#define EXACT_FARTHEST_SUBPIXEL 8388608.0f
/// Maximum corners of a triangle after clipping by six planes.
#define EXACT_MAX_CORNERS 9
/// Texture coordinates of a triangle that is not far larger than the image are interpolated with errors below this.
#define EXACT_BEYOND 1e-3f

#include "long.h"

#include "exact_language.h"

#ifdef __cplusplus
#include <bit>
#include <cmath>
namespace voxtact::shader {
/// EXACT_GUARD_PIXELS in units of half a viewport of `pixels`.
inline float exactGuard(uint pixels) {
    return 2.0f * EXACT_GUARD_PIXELS / static_cast<float>(pixels);
}
inline int floatBitsToInt(float value) {
    return std::bit_cast<int>(value);
}
inline float intBitsToFloat(int bits) {
    return std::bit_cast<float>(bits);
}
inline float floor(float value) {
    return std::floor(value);
}
#endif

/// A corner in clip space, with its texture coordinate.
struct ExactCorner {
    float x, y, z, w;
    float tx, ty, tz;
};

/// A triangle on the grid of sub-pixels, counter-clockwise, with what interpolation needs.
struct ExactTriangle {
    int x0, y0, x1, y1, x2, y2; // sub-pixels
    int minX, minY, maxX, maxY; // pixels whose centre may be covered, inclusive, within the viewport; empty: max < min
    bool affine;                // all w are 1: no perspective
    float rcpArea;              // of the doubled area in square sub-pixels
    float q0, q1q0, q2q0;       // 1/w of corner 0, and the differences of the others
    float tx, ty, tz;           // texture coordinate of corner 0, times q0 when not affine
    float ux, uy, uz;           // that of corner 1 less that of corner 0
    float vx, vy, vz;           // that of corner 2 less that of corner 0
};

/// 1/value for a normal, positive or negative value: a first guess from the bits, and four Newton steps. The same bits
/// everywhere; within 2 units in the last place.
EXACT float exactReciprocal(float value) {
    const int sign = floatBitsToInt(value) & int(0x80000000u);
    PRECISE float magnitude = intBitsToFloat(floatBitsToInt(value) & 0x7fffffff);
    PRECISE float guess = intBitsToFloat(0x7ef311c7 - floatBitsToInt(magnitude));
    for (int step = 0; step < 4; ++step) {
        PRECISE float product = magnitude * guess;
        PRECISE float correction = 2.0f - product;
        guess = guess * correction;
    }
    return intBitsToFloat(floatBitsToInt(guess) | sign);
}

EXACT float exactDot(vec4 row, float x, float y, float z) {
    PRECISE float a = row[0] * x;
    PRECISE float b = row[1] * y;
    PRECISE float c = row[2] * z;
    PRECISE float ab = a + b;
    PRECISE float abc = ab + c;
    PRECISE float sum = abc + row[3];
    return sum;
}

/// The vertex shader.
EXACT ExactCorner exactVertex(PairTransform transform, float x, float y, float z) {
    ExactCorner corner;
    corner.x = exactDot(transform.clip_from_object[0], x, y, z);
    corner.y = exactDot(transform.clip_from_object[1], x, y, z);
    corner.z = exactDot(transform.clip_from_object[2], x, y, z);
    corner.w = exactDot(transform.clip_from_object[3], x, y, z);
    corner.tx = exactDot(transform.texture_from_object[0], x, y, z);
    corner.ty = exactDot(transform.texture_from_object[1], x, y, z);
    corner.tz = exactDot(transform.texture_from_object[2], x, y, z);
    return corner;
}

EXACT bool exactBeyondAxis(float a, float b, float c) {
    return (a < -EXACT_BEYOND && b < -EXACT_BEYOND && c < -EXACT_BEYOND) ||
           (a > 1.0f + EXACT_BEYOND && b > 1.0f + EXACT_BEYOND && c > 1.0f + EXACT_BEYOND);
}

/// Returns true if all corners of a triangle, before clipping, are beyond one side of the image. With a range test it
/// has no passing fragment, even if a corner is too far away for interpolation.
EXACT bool exactBeyond(ExactCorner a, ExactCorner b, ExactCorner c) {
    return exactBeyondAxis(a.tx, b.tx, c.tx) || exactBeyondAxis(a.ty, b.ty, c.ty) || exactBeyondAxis(a.tz, b.tz, c.tz);
}

/// Signed distance to one of the six clipping planes: near, far, left, right, top, bottom; inside when not negative.
/// `guardX` and `guardY` are EXACT_GUARD_PIXELS in units of half the viewport.
EXACT float exactPlane(ExactCorner corner, int plane, float guardX, float guardY) {
    PRECISE float edgeX = guardX * corner.w;
    PRECISE float edgeY = guardY * corner.w;
    PRECISE float distance = corner.z;
    if (plane == 1) {
        distance = corner.w - corner.z;
    } else if (plane == 2) {
        distance = edgeX + corner.x;
    } else if (plane == 3) {
        distance = edgeX - corner.x;
    } else if (plane == 4) {
        distance = edgeY + corner.y;
    } else if (plane == 5) {
        distance = edgeY - corner.y;
    }
    return distance;
}

EXACT float exactLerp(float a, float b, float weight) {
    PRECISE float difference = b - a;
    PRECISE float part = weight * difference;
    PRECISE float sum = a + part;
    return sum;
}

/// Returns the intersection of a plane and the edge from a corner inside to one outside. It starts at the nearer of the
/// two, which keeps precision, and two triangles that share an edge cut it at the same bits.
EXACT ExactCorner exactCut(ExactCorner inside, ExactCorner outside, float distanceInside, float distanceOutside) {
    PRECISE float span = distanceInside - distanceOutside;
    float nearest = distanceInside;
    ExactCorner from = inside;
    ExactCorner to = outside;
    if (-distanceOutside < distanceInside) {
        nearest = -distanceOutside;
        from = outside;
        to = inside;
    }
    PRECISE float weight = nearest * exactReciprocal(span);
    ExactCorner corner;
    corner.x = exactLerp(from.x, to.x, weight);
    corner.y = exactLerp(from.y, to.y, weight);
    corner.z = exactLerp(from.z, to.z, weight);
    corner.w = exactLerp(from.w, to.w, weight);
    corner.tx = exactLerp(from.tx, to.tx, weight);
    corner.ty = exactLerp(from.ty, to.ty, weight);
    corner.tz = exactLerp(from.tz, to.tz, weight);
    return corner;
}

#ifndef __cplusplus
ExactCorner exactPolygon[EXACT_MAX_CORNERS]; // as HANDED says
#endif

/// Clips a polygon of `count` corners by all six planes, in place; returns the number of corners that are left
/// (Sutherland and Hodgman, "Reentrant polygon clipping", 1974). Input and output are the halves of one array, like in
/// certifiedClipPlane().
EXACT int exactClip(int count HANDED(ExactCorner, exactPolygon, EXACT_MAX_CORNERS), float guardX, float guardY) {
    ExactCorner both[2 * EXACT_MAX_CORNERS];
    UNKNOWN_ROUNDS for (int i = 0; i < count; ++i) {
        both[i] = exactPolygon[i];
    }
    int first = 0;
    for (int plane = 0; plane < 6; ++plane) {
        const int left = EXACT_MAX_CORNERS - first;
        int kept = 0;
        ExactCorner here = both[first];
        float distanceHere = 0.0f;
        // The first round only computes the distance of the first corner, so that one loop body serves all.
        for (int i = -1; i < count; ++i) {
            ExactCorner next = both[first + (i + 1 < count ? i + 1 : 0)];
            float distanceNext = exactPlane(next, plane, guardX, guardY);
            bool insideHere = distanceHere >= 0.0f;
            bool insideNext = distanceNext >= 0.0f;
            if (i >= 0 && insideHere && kept < EXACT_MAX_CORNERS) {
                both[left + kept++] = here;
            }
            if (i >= 0 && insideHere != insideNext && kept < EXACT_MAX_CORNERS) {
                both[left + kept++] =
                    exactCut(insideHere ? here : next, insideHere ? next : here,
                             insideHere ? distanceHere : distanceNext, insideHere ? distanceNext : distanceHere);
            }
            here = next;
            distanceHere = distanceNext;
        }
        first = left;
        count = kept;
        if (count < 3) {
            return 0;
        }
    }
    UNKNOWN_ROUNDS for (int i = 0; i < count; ++i) {
        exactPolygon[i] = both[first + i];
    }
    return count;
}

/// Returns true if a corner needs no clipping.
EXACT bool exactInside(ExactCorner corner, float guardX, float guardY) {
    bool inside = true;
    for (int plane = 0; plane < 6; ++plane) {
        inside = inside && exactPlane(corner, plane, guardX, guardY) >= 0.0f;
    }
    return inside;
}

/// Clip space to sub-pixels, not yet an integer; `scale` is half the viewport in sub-pixels.
EXACT float exactSubpixel(float clip, float reciprocalW, float scale) {
    PRECISE float projected = clip * reciprocalW;
    PRECISE float scaled = projected * scale;
    PRECISE float placed = scaled + scale;
    PRECISE float rounded = placed + 0.5f;
    return floor(rounded);
}

/// Returns true if sub-pixels fit into integers; NaN does not.
EXACT bool exactFits(float subpixel) {
    return subpixel >= -EXACT_FARTHEST_SUBPIXEL && subpixel <= EXACT_FARTHEST_SUBPIXEL;
}

/// Returns true if exactReciprocal() is valid for a w: not for NaN or negative numbers.
EXACT bool exactUsableW(float w) {
    return w >= 1e-30f && w <= 1e30f;
}

/// Returns 1/w, exactly 1 for 1 in every triangle: neighbours share the corner's position.
EXACT float exactReciprocalW(float w) {
    return w == 1.0f ? 1.0f : exactReciprocal(w);
}

/// Twice the signed area of (a, b, p); positive where p is inside of the edge from a to b.
EXACT Long exactEdge(int ax, int ay, int bx, int by, int px, int py) {
    return longDifference(longProduct(bx - ax, py - ay), longProduct(by - ay, px - ax));
}

/// Top-left rule, y down: an edge function of zero covers only on a top or a left edge. Covered: edge + bias >= 0.
EXACT int exactBias(int ax, int ay, int bx, int by) {
    return (by < ay || (by == ay && bx > ax)) ? 0 : -1;
}

/// Sets up a triangle. Expects corners that exactInside() accepts. Returns false for a triangle that covers nothing.
EXACT bool exactSetUp(ExactCorner c0, ExactCorner c1, ExactCorner c2, int width, int height,
                      OUT(ExactTriangle) triangle) {
    if (!exactUsableW(c0.w) || !exactUsableW(c1.w) || !exactUsableW(c2.w)) {
        return false;
    }
    triangle.affine = c0.w == 1.0f && c1.w == 1.0f && c2.w == 1.0f;
    float q0 = exactReciprocalW(c0.w);
    float q1 = exactReciprocalW(c1.w);
    float q2 = exactReciprocalW(c2.w);
    float scaleX = float(width * (EXACT_SUBPIXEL / 2));
    float scaleY = float(height * (EXACT_SUBPIXEL / 2));
    float x0 = exactSubpixel(c0.x, q0, scaleX);
    float y0 = exactSubpixel(c0.y, q0, scaleY);
    float x1 = exactSubpixel(c1.x, q1, scaleX);
    float y1 = exactSubpixel(c1.y, q1, scaleY);
    float x2 = exactSubpixel(c2.x, q2, scaleX);
    float y2 = exactSubpixel(c2.y, q2, scaleY);
    if (!exactFits(x0) || !exactFits(y0) || !exactFits(x1) || !exactFits(y1) || !exactFits(x2) || !exactFits(y2)) {
        return false;
    }
    triangle.x0 = int(x0);
    triangle.y0 = int(y0);
    triangle.x1 = int(x1);
    triangle.y1 = int(y1);
    triangle.x2 = int(x2);
    triangle.y2 = int(y2);
    PRECISE float area =
        longToFloat(exactEdge(triangle.x0, triangle.y0, triangle.x1, triangle.y1, triangle.x2, triangle.y2));
    if (area == 0.0f) {
        return false;
    }
    if (area < 0.0f) {
        int x = triangle.x1;
        int y = triangle.y1;
        triangle.x1 = triangle.x2;
        triangle.y1 = triangle.y2;
        triangle.x2 = x;
        triangle.y2 = y;
        ExactCorner swapped = c1;
        c1 = c2;
        c2 = swapped;
        float q = q1;
        q1 = q2;
        q2 = q;
        area = -area;
    }
    int left = triangle.x0 < triangle.x1 ? triangle.x0 : triangle.x1;
    int right = triangle.x0 < triangle.x1 ? triangle.x1 : triangle.x0;
    int top = triangle.y0 < triangle.y1 ? triangle.y0 : triangle.y1;
    int bottom = triangle.y0 < triangle.y1 ? triangle.y1 : triangle.y0;
    left = left < triangle.x2 ? left : triangle.x2;
    right = right < triangle.x2 ? triangle.x2 : right;
    top = top < triangle.y2 ? top : triangle.y2;
    bottom = bottom < triangle.y2 ? triangle.y2 : bottom;
    // A pixel's centre is half a pixel from its corner; shifts round down, also below zero.
    triangle.minX = (left + (EXACT_SUBPIXEL / 2 - 1)) >> 8;
    triangle.maxX = (right - EXACT_SUBPIXEL / 2) >> 8;
    triangle.minY = (top + (EXACT_SUBPIXEL / 2 - 1)) >> 8;
    triangle.maxY = (bottom - EXACT_SUBPIXEL / 2) >> 8;
    triangle.minX = triangle.minX < 0 ? 0 : triangle.minX;
    triangle.minY = triangle.minY < 0 ? 0 : triangle.minY;
    triangle.maxX = triangle.maxX < width ? triangle.maxX : width - 1;
    triangle.maxY = triangle.maxY < height ? triangle.maxY : height - 1;
    if (triangle.maxX < triangle.minX || triangle.maxY < triangle.minY) {
        return false;
    }
    triangle.rcpArea = exactReciprocal(area);
    PRECISE float t0x = c0.tx * q0;
    PRECISE float t0y = c0.ty * q0;
    PRECISE float t0z = c0.tz * q0;
    PRECISE float t1x = c1.tx * q1;
    PRECISE float t1y = c1.ty * q1;
    PRECISE float t1z = c1.tz * q1;
    PRECISE float t2x = c2.tx * q2;
    PRECISE float t2y = c2.ty * q2;
    PRECISE float t2z = c2.tz * q2;
    PRECISE float q1q0 = q1 - q0;
    PRECISE float q2q0 = q2 - q0;
    PRECISE float ux = t1x - t0x;
    PRECISE float uy = t1y - t0y;
    PRECISE float uz = t1z - t0z;
    PRECISE float vx = t2x - t0x;
    PRECISE float vy = t2y - t0y;
    PRECISE float vz = t2z - t0z;
    triangle.q0 = q0;
    triangle.q1q0 = q1q0;
    triangle.q2q0 = q2q0;
    triangle.tx = t0x;
    triangle.ty = t0y;
    triangle.tz = t0z;
    triangle.ux = ux;
    triangle.uy = uy;
    triangle.uz = uz;
    triangle.vx = vx;
    triangle.vy = vy;
    triangle.vz = vz;
    return true;
}

/// base + weight1 * u + weight2 * v, from left to right.
EXACT float exactPlaneAt(float base, float u, float v, float weight1, float weight2) {
    PRECISE float part1 = weight1 * u;
    PRECISE float part2 = weight2 * v;
    PRECISE float first = base + part1;
    PRECISE float sum = first + part2;
    return sum;
}

/// The fragment of a pixel: coverage and texture coordinate.
EXACT bool exactFragment(ExactTriangle triangle, int pixelX, int pixelY, OUT(float) tx, OUT(float) ty, OUT(float) tz) {
    int px = pixelX * EXACT_SUBPIXEL + EXACT_SUBPIXEL / 2;
    int py = pixelY * EXACT_SUBPIXEL + EXACT_SUBPIXEL / 2;
    Long edge0 = exactEdge(triangle.x1, triangle.y1, triangle.x2, triangle.y2, px, py);
    Long edge1 = exactEdge(triangle.x2, triangle.y2, triangle.x0, triangle.y0, px, py);
    Long edge2 = exactEdge(triangle.x0, triangle.y0, triangle.x1, triangle.y1, px, py);
    bool covered = !longIsNegative(longSum(edge0, exactBias(triangle.x1, triangle.y1, triangle.x2, triangle.y2))) &&
                   !longIsNegative(longSum(edge1, exactBias(triangle.x2, triangle.y2, triangle.x0, triangle.y0))) &&
                   !longIsNegative(longSum(edge2, exactBias(triangle.x0, triangle.y0, triangle.x1, triangle.y1)));
    PRECISE float weight1 = longToFloat(edge1) * triangle.rcpArea;
    PRECISE float weight2 = longToFloat(edge2) * triangle.rcpArea;
    PRECISE float x = exactPlaneAt(triangle.tx, triangle.ux, triangle.vx, weight1, weight2);
    PRECISE float y = exactPlaneAt(triangle.ty, triangle.uy, triangle.vy, weight1, weight2);
    PRECISE float z = exactPlaneAt(triangle.tz, triangle.uz, triangle.vz, weight1, weight2);
    if (!triangle.affine) {
        PRECISE float w = exactReciprocal(exactPlaneAt(triangle.q0, triangle.q1q0, triangle.q2q0, weight1, weight2));
        x = x * w;
        y = y * w;
        z = z * w;
    }
    tx = x;
    ty = y;
    tz = z;
    return covered;
}

/// Returns true if a coordinate is within the image; NaN is not.
EXACT bool exactInDomain(float coordinate) {
    return coordinate >= 0.0f && coordinate <= 1.0f;
}

/// The nearest coordinate within the image; 0 for NaN.
EXACT float exactClamp(float coordinate) {
    return coordinate >= 0.0f ? (coordinate <= 1.0f ? coordinate : 1.0f) : 0.0f;
}

/// The two voxels around a coordinate along one axis, and the coordinate's fraction between them.
struct ExactCell {
    int below, above;
    float weight;
};

/// `coordinate` in [0,1]; `size` voxels, at most 2^23.
EXACT ExactCell exactCell(float coordinate, int size) {
    PRECISE float scaled = coordinate * float(size);
    PRECISE float shifted = scaled - 0.5f;
    PRECISE float whole = floor(shifted);
    PRECISE float rest = shifted - whole;
    ExactCell cell;
    int index = int(whole);
    cell.below = index < 0 ? 0 : index;
    cell.above = index + 1 < size ? index + 1 : size - 1;
    cell.weight = rest;
    return cell;
}

/// Returns the position of a stored value in a table of `size` entries; stored values are the integers of integer
/// voxels. NaN (huge float voxels can overflow) gives the first entry.
EXACT ExactCell exactEntry(float stored, float scalarScale, float scalarBias, int size) {
    PRECISE float scaled = stored * scalarScale;
    PRECISE float scalar = scaled + scalarBias;
    PRECISE float entries = scalar * float(size);
    PRECISE float shifted = entries - 0.5f;
    float last = float(size - 1);
    PRECISE float clamped = shifted >= 0.0f ? (shifted <= last ? shifted : last) : 0.0f;
    PRECISE float whole = floor(clamped);
    PRECISE float rest = clamped - whole;
    ExactCell cell;
    cell.below = int(whole);
    cell.above = cell.below + 1 < size ? cell.below + 1 : size - 1;
    cell.weight = rest;
    return cell;
}

#include "exact_language.h"

#ifdef __cplusplus
} // namespace voxtact::shader
#endif

#endif

// SPDX-License-Identifier: MIT
// Where a survivor is, and how deep: one text for GLSL and C++, in the arithmetic of exact.h, so that device and host
// give the same bits. The opacity is that of the `exact` filter, whatever the detector filters with.
#ifndef VOXTACT_CONTACT_H
#define VOXTACT_CONTACT_H

#include "exact.h"

/// Bits of VOXTACT_CONSTANT_OUTPUTS.
#define OUTPUT_TRIANGLES 1
#define OUTPUT_CONTACTS 2
#define OUTPUT_BOUNDS 4
#define OUTPUT_LABELS 8
/// Words of a bound's box, of the header of the list of contacts, and of a contact.
#define OUTPUT_BOUND_WORDS 6
#define OUTPUT_HEADER_WORDS 4
#define OUTPUT_CONTACT_WORDS 12
/// Maximum steps of the march out of the opaque region, and bisections of the last step. Enough for half-voxel steps
/// through typical images; llvmpipe ends loops after 65,535 rounds.
#define CONTACT_MOST_STEPS 16384
#define CONTACT_HALVINGS 16

#include "exact_language.h"

#ifdef __cplusplus
namespace voxtact::shader {
/// An object that looks opacities up: `float opacity(OutputPair, ContactVector)`, at coordinates within [0,1]^3.
#define FIELD_FUNCTION template <class Field>
#define FIELD const Field &field,
#define PASS_FIELD field,
#define OUTPUT_PAIR const OutputPair&
#define OPACITY_AT(pair, at) field.opacity(pair, at)
#else
#define FIELD_FUNCTION
#define FIELD
#define PASS_FIELD
#define OUTPUT_PAIR OutputPair
#define OPACITY_AT(pair, at) contactOpacity(pair, at)
#endif

/// Inputs of one pair for the outputs other than the count; element `pair` of a std430 buffer.
struct OutputPair {
    vec4 world_from_texture[3];
    vec4 texture_from_world[3]; // of directions: the fourth column is not used
    vec4 label_from_texture[3]; // texture space of the label map
    vec4 voxel;                 // the sides of a voxel, texture space
    vec4 farthest;              // the longest steps of the gradient, texture space
    ItemConstants item;         // of the exact filter
    float valueScale;           // value = valueScale * stored + valueBias
    float valueBias;
    float maxDepth;    // mm
    float depthWay;    // mm: maximum depth, or the certain end of the image
    float depthStep;   // mm
    uint depthSteps;   // the last one ends at depthWay
    uint doublings;    // of the gradient's step, until it is `farthest` along all axes
    uint labelCount;   // 0: no label map
    uint outsideLabel; // number of the label 0
    uint labelSizeX;   // voxels of the label map
    uint labelSizeY;
    uint labelSizeZ;
    uint firstTriangle; // words of the outputs buffer: where the counts of the pair's triangles begin,
    uint firstMask;     // the bits of its triangles,
    uint firstLabel;    // the counts of its labels,
    uint firstBound;    // its box,
    uint contacts;      // and the list of contacts of all pairs
    uint contactRoom;   // contacts that the list has room for
    uint unused0, unused1;
};

/// A point or a direction.
struct ContactVector {
    float x, y, z;
};

/// Values of a contact at its position.
struct ContactSample {
    float stored;
    float opacity;
};

EXACT ContactSample contactSample(float stored, float opacity) {
    ContactSample found;
    found.stored = stored;
    found.opacity = opacity;
    return found;
}

#ifndef __cplusplus
float contactOpacity(OutputPair pair, ContactVector at);
#endif

EXACT ContactVector contactVector(float x, float y, float z) {
    ContactVector vector;
    vector.x = x;
    vector.y = y;
    vector.z = z;
    return vector;
}

EXACT ContactVector contactTransform(vec4 row0, vec4 row1, vec4 row2, ContactVector at) {
    return contactVector(exactDot(row0, at.x, at.y, at.z), exactDot(row1, at.x, at.y, at.z),
                         exactDot(row2, at.x, at.y, at.z));
}

EXACT ContactVector contactClamp(ContactVector at) {
    return contactVector(exactClamp(at.x), exactClamp(at.y), exactClamp(at.z));
}

/// origin + distance * direction
EXACT ContactVector contactAlong(ContactVector origin, ContactVector direction, float distance) {
    PRECISE float stepX = distance * direction.x;
    PRECISE float stepY = distance * direction.y;
    PRECISE float stepZ = distance * direction.z;
    PRECISE float x = origin.x + stepX;
    PRECISE float y = origin.y + stepY;
    PRECISE float z = origin.z + stepZ;
    return contactVector(x, y, z);
}

EXACT float contactSum(float a, float b, float c) {
    PRECISE float ab = a + b;
    PRECISE float sum = ab + c;
    return sum;
}

EXACT float contactProducts(float a, float x, float b, float y, float c, float z) {
    PRECISE float ax = a * x;
    PRECISE float by = b * y;
    PRECISE float cz = c * z;
    return contactSum(ax, by, cz);
}

/// 1/sqrt(value) for a normal, positive value: a first guess from the bits, and four Newton steps.
EXACT float contactReciprocalRoot(float value) {
    PRECISE float halved = 0.5f * value;
    PRECISE float guess = intBitsToFloat(0x5f3759df - (floatBitsToInt(value) >> 1));
    for (int step = 0; step < 4; ++step) {
        PRECISE float square = guess * guess;
        PRECISE float product = halved * square;
        PRECISE float correction = 1.5f - product;
        guess = guess * correction;
    }
    return guess;
}

EXACT float contactMagnitude(float value) {
    return value < 0.0f ? -value : value;
}

/// The unit vector of a direction; zero for one that is too short to have one, and for NaN.
EXACT ContactVector contactUnit(ContactVector direction) {
    float x = contactMagnitude(direction.x);
    float y = contactMagnitude(direction.y);
    float z = contactMagnitude(direction.z);
    float xy = x > y ? x : y;
    float largest = xy > z ? xy : z;
    if (!(largest >= 1e-30f && largest <= 1e30f)) {
        return contactVector(0.0f, 0.0f, 0.0f);
    }
    float scale = exactReciprocal(largest);
    PRECISE float scaledX = direction.x * scale;
    PRECISE float scaledY = direction.y * scale;
    PRECISE float scaledZ = direction.z * scale;
    float root = contactReciprocalRoot(contactProducts(scaledX, scaledX, scaledY, scaledY, scaledZ, scaledZ));
    PRECISE float unitX = scaledX * root;
    PRECISE float unitY = scaledY * root;
    PRECISE float unitZ = scaledZ * root;
    return contactVector(unitX, unitY, unitZ);
}

/// Central difference of the opacity along one axis: `step` is not zero along that one alone. `centre` within [0,1]^3.
FIELD_FUNCTION EXACT float contactSlope(FIELD OUTPUT_PAIR pair, ContactVector centre, ContactVector step) {
    ContactVector above = contactClamp(contactAlong(centre, step, 1.0f));
    ContactVector below = contactClamp(contactAlong(centre, step, -1.0f));
    PRECISE float spanX = above.x - below.x;
    PRECISE float spanY = above.y - below.y;
    PRECISE float spanZ = above.z - below.z;
    float span = contactSum(spanX, spanY, spanZ);
    PRECISE float difference = OPACITY_AT(pair, above) - OPACITY_AT(pair, below);
    PRECISE float slope = difference * exactReciprocal(span);
    return slope;
}

/// The step along one axis, when steps are `scale` voxels, but no longer than the farthest.
EXACT float contactStep(float voxel, float farthest, float scale) {
    PRECISE float step = scale * voxel;
    return step < farthest ? step : farthest;
}

/// The gradient of the opacity in texture space, by differences over `scale` voxels to each side.
FIELD_FUNCTION EXACT ContactVector contactGradient(FIELD OUTPUT_PAIR pair, ContactVector centre, float scale) {
    ContactVector gradient = contactVector(0.0f, 0.0f, 0.0f);
    for (uint axis = 0u; axis < 3u; ++axis) {
        float along = contactStep(pair.voxel[axis], pair.farthest[axis], scale);
        ContactVector step =
            contactVector(axis == 0u ? along : 0.0f, axis == 1u ? along : 0.0f, axis == 2u ? along : 0.0f);
        float slope = contactSlope(PASS_FIELD pair, centre, step);
        gradient.x = axis == 0u ? slope : gradient.x;
        gradient.y = axis == 1u ? slope : gradient.y;
        gradient.z = axis == 2u ? slope : gradient.z;
    }
    return gradient;
}

/// Against a gradient in texture space: a unit vector in world space, or zero. A gradient is a covector, so it is the
/// transpose of texture_from_world that takes it to world space.
EXACT ContactVector contactOutward(OUTPUT_PAIR pair, ContactVector gradient) {
    vec4 x = pair.texture_from_world[0];
    vec4 y = pair.texture_from_world[1];
    vec4 z = pair.texture_from_world[2];
    return contactUnit(contactVector(-contactProducts(x[0], gradient.x, y[0], gradient.y, z[0], gradient.z),
                                     -contactProducts(x[1], gradient.x, y[1], gradient.y, z[1], gradient.z),
                                     -contactProducts(x[2], gradient.x, y[2], gradient.y, z[2], gradient.z)));
}

EXACT bool contactIsZero(ContactVector vector) {
    return vector.x == 0.0f && vector.y == 0.0f && vector.z == 0.0f;
}

/// The normal at a texture coordinate, world space; zero where no step finds a difference.
FIELD_FUNCTION EXACT ContactVector contactNormal(FIELD OUTPUT_PAIR pair, ContactVector at) {
    ContactVector centre = contactClamp(at);
    ContactVector normal = contactVector(0.0f, 0.0f, 0.0f);
    float scale = 1.0f;
    for (uint doubling = 0u; doubling <= pair.doublings && contactIsZero(normal); ++doubling) {
        normal = contactOutward(pair, contactGradient(PASS_FIELD pair, centre, scale));
        scale = scale * 2.0f;
    }
    return normal;
}

EXACT bool contactInDomain(ContactVector at) {
    return exactInDomain(at.x) && exactInDomain(at.y) && exactInDomain(at.z);
}

FIELD_FUNCTION EXACT bool contactOpaque(FIELD OUTPUT_PAIR pair, ContactVector at) {
    return contactInDomain(at) && OPACITY_AT(pair, contactClamp(at)) >= pair.item.threshold;
}

/// Returns the distance in mm along the normal from a texture coordinate to the end of the opaque region or the image.
FIELD_FUNCTION EXACT float contactDepth(FIELD OUTPUT_PAIR pair, ContactVector at, ContactVector normal) {
    if (contactIsZero(normal)) {
        return pair.maxDepth;
    }
    vec4 x = pair.texture_from_world[0];
    vec4 y = pair.texture_from_world[1];
    vec4 z = pair.texture_from_world[2];
    ContactVector direction = contactVector(contactProducts(x[0], normal.x, x[1], normal.y, x[2], normal.z),
                                            contactProducts(y[0], normal.x, y[1], normal.y, y[2], normal.z),
                                            contactProducts(z[0], normal.x, z[1], normal.y, z[2], normal.z));
    PRECISE float inside = 0.0f;
    PRECISE float outside = 0.0f;
    bool left = false;
    int halvings = 0;
    // One loop for both compiles only one look-up.
    for (uint step = 1u; (left || step <= pair.depthSteps) && halvings <= CONTACT_HALVINGS; ++step) {
        PRECISE float marched = step == pair.depthSteps ? pair.depthWay : float(step) * pair.depthStep;
        PRECISE float sum = inside + outside;
        PRECISE float middle = 0.5f * sum;
        float distance = left ? middle : marched;
        bool opaque = contactOpaque(PASS_FIELD pair, contactAlong(at, direction, distance));
        inside = opaque ? distance : inside;
        outside = opaque ? outside : distance;
        left = left || !opaque;
        halvings += left ? 1 : 0;
    }
    return left ? outside : pair.maxDepth;
}

/// The nearest voxel along one axis; `size` for a coordinate outside.
EXACT uint contactVoxel(float coordinate, uint size) {
    if (!exactInDomain(coordinate)) {
        return size;
    }
    PRECISE float scaled = coordinate * float(size);
    uint index = uint(floor(scaled));
    return index < size ? index : size - 1u;
}

#include "exact_language.h"

#ifdef __cplusplus
#undef FIELD_FUNCTION
#undef FIELD
#undef PASS_FIELD
#undef OUTPUT_PAIR
#undef OPACITY_AT
static_assert(sizeof(OutputPair) == 272 && sizeof(OutputPair) % 16 == 0 && offsetof(OutputPair, item) == 176);
} // namespace voxtact::shader
#endif

#endif

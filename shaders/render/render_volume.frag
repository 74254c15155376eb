// SPDX-License-Identifier: MIT
// The volume, in front of the mesh, in front of the background. Along a ray everything is measured in millimetres from
// the near plane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = PICTURE_SET_FUNCTION, binding = PICTURE_BINDING_TABLE) uniform sampler2D table;
layout(set = PICTURE_SET_FUNCTION, binding = PICTURE_BINDING_OPACITY, std430) readonly buffer Opacity {
    float extremes[];
};
layout(set = PICTURE_SET_TARGETS, binding = PICTURE_BINDING_MESH_COLOUR) uniform sampler2D meshColour;
layout(set = PICTURE_SET_TARGETS, binding = PICTURE_BINDING_MESH_DISTANCE) uniform sampler2D meshDistance;
layout(set = PICTURE_SET_BRICKS, binding = 0, std430) readonly buffer Bricks {
    vec4 bricks[]; // lo, hi, wideLo, wideHi
};
layout(location = 0) out vec4 colour;

#include "render_light.glsl"

#define ENOUGH 0.99
// Upper bound of the rounding of a filtered scalar, in entries.
#define ENTRY_MARGIN 0.0625

struct Ray {
    vec3 origin;    // texture space, on the near plane
    vec3 direction; // texture space, per millimetre
    vec3 world;     // direction in world space; unit length
    float end;      // the far plane
};

Ray rayOf(vec2 pixel) {
    const vec4 near = ROWS4(picture.texture_from_clip, vec4(clipOf(pixel), 0.0, 1.0));
    const vec4 far = ROWS4(picture.texture_from_clip, vec4(clipOf(pixel), 1.0, 1.0));
    // The direction between both points without division by w: the far plane may be at infinity.
    const vec3 way = far.xyz * near.w - near.xyz * far.w;
    const vec3 world = ROWS3(picture.world_from_texture, vec4(way, 0.0));
    const float size = length(world);
    const float both = near.w * far.w;
    return Ray(near.xyz / near.w, way / size, world / size, both > 0.0 ? size / both : PICTURE_NOTHING);
}

/// Returns the part of a ray in [lo, hi] of the origin's space: x to y, empty if x > y.
vec2 insideBox(vec3 origin, vec3 direction, vec3 lo, vec3 hi) {
    // Never zero: 0 / 0 would be on a face.
    const vec3 slope = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    const vec3 a = (lo - origin) / slope;
    const vec3 b = (hi - origin) / slope;
    const vec3 first = min(a, b);
    const vec3 last = max(a, b);
    return vec2(max(max(first.x, first.y), first.z), min(min(last.x, last.y), last.z));
}

/// Returns the entry and exit of a ray: x and y, mm. `normal`, of unit length, is that of the entry face: the volume's
/// border, a clipping plane or, for a ray that begins inside, the near plane.
vec2 seenPart(Ray ray, out vec3 normal) {
    normal = ray.world;
    float from = 0.0;
    float to = ray.end;
    for (int i = 0; i < 3; ++i) {
        const float slope = abs(ray.direction[i]) < 1e-20 ? 1e-20 : ray.direction[i];
        const float a = -ray.origin[i] / slope;
        const float b = (1.0 - ray.origin[i]) / slope;
        if (min(a, b) > from) {
            from = min(a, b);
            normal = normalize(picture.texture_from_world[i].xyz);
        }
        to = min(to, max(a, b));
    }
    for (int i = 0; i < picture.planeCount; ++i) {
        const vec4 plane = picture.texturePlanes[i];
        const float slope = dot(plane.xyz, ray.direction);
        const float at = (plane.w - dot(plane.xyz, ray.origin)) / slope;
        if (slope == 0.0) {
            to = dot(plane.xyz, ray.origin) > plane.w ? -1.0 : to;
        } else if (slope > 0.0) {
            to = min(to, at);
        } else if (at > from) {
            from = at;
            normal = picture.planes[i].xyz;
        }
    }
    return vec2(from, to);
}

/// Returns the maximum opacity of the table entries from `first` to `last`.
float largestOpacity(int first, int last) {
    const int level = findMSB(last - first + 1);
    const int row = level * picture.tableSize;
    return max(extremes[row + first], extremes[row + last + 1 - (1 << level)]);
}

/// Returns true if all samples in a brick are transparent.
bool isEmpty(vec4 brick) {
    if (!(brick.x <= brick.y)) {
        return false; // of NaN only
    }
    const vec2 ends = picture.entryScale * brick.xy + picture.entryBias;
    const float last = float(picture.tableSize - 1);
    const float from = clamp(min(ends.x, ends.y) - ENTRY_MARGIN, 0.0, last);
    const float to = clamp(max(ends.x, ends.y) + ENTRY_MARGIN, 0.0, last);
    return largestOpacity(int(floor(from)), int(ceil(to))) <= 0.0;
}

/// Returns the exit distance of the brick at a coordinate (x), and 1 if the brick is empty (y).
vec2 brickAt(Ray ray, float at) {
    const ivec3 size = textureSize(volume, 0);
    const vec3 voxels = vec3(size);
    const vec3 voxel = (ray.origin + at * ray.direction) * voxels - 0.5;
    const ivec3 cell = clamp(ivec3(floor(voxel)) + 1, ivec3(0), size);
    const ivec3 brick = cell >> VOXTACT_BRICK_SHIFT;
    const vec3 lo = vec3(brick << VOXTACT_BRICK_SHIFT) - 1.0;
    const vec2 part = insideBox(ray.origin * voxels - 0.5, ray.direction * voxels, lo,
                                lo + float(1 << VOXTACT_BRICK_SHIFT));
    const vec4 range = bricks[brick.x + picture.bricksX * (brick.y + picture.bricksY * brick.z)];
    return vec2(part.y, isEmpty(range) ? 1.0 : 0.0);
}

/// (0, 1], by a permuted congruential generator (O'Neill, "PCG", 2014).
float hashOf(uvec2 pixel) {
    uint state = (pixel.x + 65536u * pixel.y) * 747796405u + 2891336453u;
    state = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    state = (state >> 22u) ^ state;
    return (float(state >> 8u) + 1.0) / 16777216.0;
}

/// Returns the weight of a cut face, 0 to 1: 1 if a layer of the face's depth with this opacity per step hides half of
/// the background. It falls off gradually, so the rim of a face is no line.
float cutThrough(float opacity) {
    return min(2.0 * (1.0 - pow(1.0 - min(opacity, 0.999), picture.faceDepth / picture.step)), 1.0);
}

/// Returns premultiplied colour and opacity of the ray between two distances. The ray enters through a face.
vec4 march(Ray ray, float from, float to, float firstStep, vec3 faceNormal) {
    const float step = picture.step;
    vec4 sum = vec4(0.0);
    float at = from;
    float next = from + firstStep;
    float front = scalarAt(ray.origin + at * ray.direction);
    float cut = (picture.switches & PICTURE_FACES) != 0u ? 1.0 : 0.0;
    float brickEnd = picture.bricksX > 0 ? from : PICTURE_NOTHING;
    // The bound is for llvmpipe (seen in Mesa 22.3), which otherwise runs some finished blocks of pixels up to its own
    // limit of 65535 rounds.
    const int most = int((to - from) / step) + 2;
    for (int i = 0; i < most && at < to && sum.a < ENOUGH; ++i) {
        if (at >= brickEnd) {
            const vec2 brick = brickAt(ray, at);
            // Skips to the last sample in the empty brick; the step out of it is an ordinary one.
            const float beyond = floor((min(brick.x, to) - next) / step);
            if (brick.y > 0.0 && beyond >= 0.0) {
                at = next + beyond * step;
                cut = 0.0;
                next = at + step;
                front = scalarAt(ray.origin + at * ray.direction);
                if (at >= to) {
                    break;
                }
            }
            brickEnd = brick.x;
        }
        const float end = min(next, to);
        const float back = scalarAt(ray.origin + end * ray.direction);
        vec4 segment = textureLod(table, vec2(front, back), 0.0);
        if (segment.a > 0.0) {
            cut = min(cut, cutThrough(segment.a));
            const float share = (end - at) / step;
            if (share < 0.999) {
                const float opacity = 1.0 - pow(1.0 - min(segment.a, 1.0), share);
                segment *= opacity / segment.a;
            }
            if ((picture.switches & PICTURE_LIT_VOLUME) != 0u) {
                const float middle = 0.5 * (at + end);
                const float face = cut * clamp(2.0 - (middle - from) / picture.faceDepth, 0.0, 1.0);
                segment.rgb = shaded(segment, ray.origin + middle * ray.direction, ray.world, faceNormal, face);
            }
            sum += (1.0 - sum.a) * segment;
        } else {
            cut = 0.0;
        }
        front = back;
        at = end;
        next += step;
    }
    return sum;
}

void main() {
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const float mesh = texelFetch(meshDistance, pixel, 0).r;
    const vec4 behind = texelFetch(meshColour, pixel, 0); // and its visibility through the volume
    const Ray ray = rayOf(gl_FragCoord.xy);
    vec3 faceNormal;
    const vec2 part = seenPart(ray, faceNormal);
    const float from = part.x;
    const float to = min(part.y, mesh);
    vec4 sum = vec4(0.0);
    if (from < to) {
        const bool jitter = (picture.switches & PICTURE_JITTER) != 0u;
        sum = march(ray, from, to, picture.step * (jitter ? hashOf(uvec2(pixel)) : 1.0), faceNormal);
    }
    const vec3 seen = sum.rgb + (1.0 - sum.a) * behind.rgb;
    colour = vec4(behind.a > 0.0 ? mix(seen, behind.rgb, behind.a) : seen, 1.0);
}

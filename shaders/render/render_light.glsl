// SPDX-License-Identifier: MIT
// How light falls on a segment of a ray through the volume. After picture.glsl, `volume` and `table`.
#ifndef VOXTACT_RENDER_LIGHT_GLSL
#define VOXTACT_RENDER_LIGHT_GLSL

// A constant: llvmpipe executes both sides of a branch, at each step of each ray.
layout(constant_id = PICTURE_CONSTANT_OCCLUSION) const bool kOcclusion = true;

// Samples along the normal, up to `reach`.
#define OCCLUSION_LOOKS 4

float scalarAt(vec3 coordinate) {
    return textureLod(volume, coordinate, 0.0).r * picture.scalarScale + picture.scalarBias;
}

vec3 gradientAt(vec3 coordinate) {
    const vec3 voxels = vec3(textureSize(volume, 0));
    const vec3 h = 1.0 / voxels;
    const vec3 difference = vec3(scalarAt(coordinate + vec3(h.x, 0, 0)) - scalarAt(coordinate - vec3(h.x, 0, 0)),
                                 scalarAt(coordinate + vec3(0, h.y, 0)) - scalarAt(coordinate - vec3(0, h.y, 0)),
                                 scalarAt(coordinate + vec3(0, 0, h.z)) - scalarAt(coordinate - vec3(0, 0, h.z)));
    const vec3 slope = difference * voxels * 0.5;
    return slope.x * picture.texture_from_world[0].xyz + slope.y * picture.texture_from_world[1].xyz +
           slope.z * picture.texture_from_world[2].xyz;
}

/// Returns true if a point of texture space is in the visible part of the volume.
bool isThere(vec3 coordinate) {
    bool there = all(greaterThanEqual(coordinate, vec3(0.0))) && all(lessThanEqual(coordinate, vec3(1.0)));
    for (int i = 0; i < picture.planeCount; ++i) {
        there = there && dot(picture.texturePlanes[i].xyz, coordinate) <= picture.texturePlanes[i].w;
    }
    return there;
}

/// Returns the openness above a surface: the mean transmission of the samples; 1 if nothing is within reach.
float opennessAt(vec3 coordinate, vec3 outside) {
    const float part = picture.reach / float(OCCLUSION_LOOKS);
    const vec3 way = part * ROWS3(picture.texture_from_world, vec4(outside, 0.0));
    float through = 1.0;
    float sum = 0.0;
    for (int i = 1; i <= OCCLUSION_LOOKS; ++i) {
        const vec3 place = coordinate + float(i) * way;
        if (isThere(place)) {
            const float scalar = scalarAt(place);
            const float opacity = min(textureLod(table, vec2(scalar), 0.0).a, 0.9999);
            through *= pow(1.0 - opacity, part / picture.step);
        }
        sum += through;
    }
    return sum / float(OCCLUSION_LOOKS);
}

/// Lights a sample by its gradient.
vec3 shadedInside(vec4 segment, vec3 coordinate, vec3 away) {
    const vec3 gradient = gradientAt(coordinate);
    const float size = length(gradient);
    if (!(size > 0.0)) {
        // Without a direction there is no surface, and all light arrives.
        return lit(segment, away, away);
    }
    const vec3 normal = gradient / size;
    const vec3 light = lit(segment, normal, away);
    if (!kOcclusion) {
        return light;
    }
    // Halfway to the eye: inside matter a gradient may point anywhere.
    const vec3 outside = normalize(outwards(dot(normal, away)) * normal - away);
    const float openness = opennessAt(coordinate, outside);
    return light * (1.0 - picture.occlusion * (1.0 - openness));
}

/// The face of a cut: matt, because specular light would whiten all of it, and fully lit from the eye to show its
/// colours.
vec3 shadedFace(vec4 segment, vec3 away, vec3 normal) {
    return segment.rgb * min(picture.light.x + (picture.light.y + picture.side.w) * abs(dot(normal, away)), 1.0);
}

/// `face`: weight of the face through which the ray enters the volume, where gradients are noise.
vec3 shaded(vec4 segment, vec3 coordinate, vec3 away, vec3 faceNormal, float face) {
    const vec3 onFace = face > 0.0 ? shadedFace(segment, away, faceNormal) : vec3(0.0);
    return face < 1.0 ? mix(shadedInside(segment, coordinate, away), onFace, face) : onFace;
}

#endif

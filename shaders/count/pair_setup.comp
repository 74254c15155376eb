// SPDX-License-Identifier: MIT
// A lane per pose: what the passes need of the pair, and its result with a count of zero. With CERTIFIED for the
// projection `certified`; with OF_HOST for poses of the host's, in double precision, which it has checked.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define DOUBLES
#include "exact/shared.h"
#include "voxtact/device_results.h"
#include "exact/pair_setup.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

#ifdef CERTIFIED
#define TRANSFORM CertifiedPair
#else
#define TRANSFORM PairTransform
#endif
layout(set = VOXTACT_SET_SETUP, binding = VOXTACT_BINDING_SETUP_TRANSFORMS, std430) writeonly buffer Transforms {
    TRANSFORM transforms[];
};
layout(set = VOXTACT_SET_SETUP, binding = VOXTACT_BINDING_SETUP_RESULTS, std430) writeonly buffer Results {
    PairResult results[];
};
layout(set = VOXTACT_SET_SETUP, binding = VOXTACT_BINDING_SETUP_ITEMS, std430) readonly buffer Items { uint words[]; };
layout(set = VOXTACT_SET_SETUP_POSES, binding = 0, std430) readonly buffer Poses { uint poses[]; };
layout(push_constant) uniform Constants { PairSetupConstants constants; };

#include "pair_grid.glsl"

#include "exact/exact_language.h"

#ifdef OF_HOST
#define POSE_WORDS VOXTACT_HOST_POSE_WORDS
#else
#define POSE_WORDS 16
#endif

/// A pose in the layout of the buffer.
struct PoseBits {
    uint word[POSE_WORDS];
};

/// Loads all elements at once: a GPU waits a microsecond for each read of mapped memory.
PoseBits poseBits(uint at) {
    PoseBits pose;
    for (uint i = 0; i < POSE_WORDS; ++i) {
        pose.word[i] = poses[at + i];
    }
    return pose;
}

#ifdef OF_HOST
bool isUsable(PoseBits pose) {
    return true;
}

Wide elementOf(PoseBits pose, uint i) {
    return wideBits(pose.word[2 * i + 1], pose.word[2 * i]);
}
#else
/// Returns true if a pose is finite and affine.
bool isUsable(PoseBits pose) {
    bool usable = true;
    ROLLED for (uint i = 0; i < 16; ++i) {
        const uint bits = pose.word[i];
        usable = usable && (bits & 0x7f800000u) != 0x7f800000u;
        if (i % 4 == 3) {
            usable = usable && (i == 15 ? bits == 0x3f800000u : (bits & 0x7fffffffu) == 0u);
        }
    }
    return usable;
}

Wide elementOf(PoseBits pose, uint i) {
    return wideOfFloatBits(pose.word[i]);
}
#endif

WideMatrix matrixOf(PoseBits pose) {
    WideMatrix matrix;
    ROLLED for (uint i = 0; i < 16; ++i) {
        matrix.element[i] = elementOf(pose, i);
    }
    return matrix;
}

#ifdef CERTIFIED
/// Places the mesh far from every cell.
CertifiedPair nowhere() {
    CertifiedPair pair;
    pair.reference = vec4(0);
    pair.error = vec4(0);
    ROLLED for (int row = 0; row < 3; ++row) {
        pair.voxel_from_reference[row] = vec4(0, 0, 0, -1e6);
    }
    ROLLED for (int row = 0; row < 9; ++row) {
        pair.place[row] = vec4(0, 0, 0, row < 3 ? -1e6 : 0);
    }
    return pair;
}

void setUp(uint pair, PoseBits pose, bool usable) {
    if (usable) {
        transforms[pair] = certifiedPairOf(gridAt(constants.setupWord), matrixOf(pose),
                                            originAt(constants.setupWord));
    } else {
        transforms[pair] = nowhere();
    }
}
#else
/// Places the mesh outside the image and every view.
PairTransform nowhere() {
    PairTransform transform;
    ROLLED for (int row = 0; row < 4; ++row) {
        transform.clip_from_object[row] = vec4(0, 0, 0, row == 3 ? 1 : 8);
    }
    ROLLED for (int row = 0; row < 3; ++row) {
        transform.texture_from_object[row] = vec4(0, 0, 0, -8);
    }
    return transform;
}

void setUp(uint pair, PoseBits pose, bool usable) {
    ROLLED for (uint view = 0; view < constants.views; ++view) {
        const uint number = pair * constants.views + view;
        if (usable) {
            const WideMatrix clip_from_world = matrixAt(constants.setupWord + 32 + 32 * view);
            const WideMatrix world_from_floats = pairWorldFromFloats(matrixOf(pose), originAt(constants.setupWord));
            transforms[number] = pairTransformOf(clip_from_world, matrixAt(constants.setupWord), world_from_floats);
        } else {
            transforms[number] = nowhere();
        }
    }
}
#endif

#include "exact/exact_language.h"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= constants.pairs) {
        return;
    }
    const uint pair = constants.firstPair + i;
    const PoseBits pose = poseBits(constants.poseWord + constants.poseWords * i);
    const bool usable = isUsable(pose);
    results[pair] = PairResult(0, 0, pair, constants.item, constants.firstPose + i,
                               usable ? constants.how : constants.refused);
    setUp(pair, pose, usable);
}

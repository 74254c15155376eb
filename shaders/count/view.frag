// SPDX-License-Identifier: MIT
// The paper's fragment program (Volume-Surface Collision Detection, section 5, Listing 1). No early fragment tests:
// an occlusion query would then count the fragments that are discarded here.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifdef COUNT_SUBGROUP
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#ifdef OUTPUTS
#extension GL_EXT_samplerless_texture_functions : require
#endif
#include "exact/shared.h"

layout(constant_id = VOXTACT_CONSTANT_RANGE_TEST) const bool kRangeTest = true;
layout(constant_id = VOXTACT_CONSTANT_CARRY) const bool kCarry = true;
const bool kYesNo = false;
layout(constant_id = VOXTACT_CONSTANT_EXACT_FILTER) const bool kExactFilter = false;

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = 0) uniform sampler1D transferFunction;
layout(push_constant) uniform Draw { RasterConstants constants; };

layout(location = 0) in vec3 textureCoordinate;
layout(location = 1) flat in uint pair;

#include "survives.glsl"
#ifdef OUTPUTS
#include "outputs.glsl"
#endif

#if defined(OUTPUTS) || defined(LIST_FRAGMENTS)
/// Number in the mesh: a mesh may take several draws.
uint triangle() {
    return constants.firstTriangle + uint(gl_PrimitiveID);
}
#endif

#if defined(COUNT_ATOMIC) || defined(COUNT_SUBGROUP)
#include "voxtact/device_results.h"
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) buffer Results { PairResult results[]; };
#include "count.glsl"
#endif

#ifdef LIST_FRAGMENTS
layout(set = VOXTACT_SET_TRACE, binding = 0, std430) buffer Trace {
    uint traced; // all passing fragments, including those that the list has no room for
    TracedFragment fragments[];
};
void list() {
    const uint at = atomicAdd(traced, 1u);
    if (at < fragments.length()) {
        fragments[at] = TracedFragment(triangle(), uint(gl_FragCoord.x), uint(gl_FragCoord.y));
    }
}
#endif

#ifdef COUNT_SUBGROUP
/// One addition per subgroup and pair. Helper lanes take part in ballots; they cover no sample. (gl_HelperInvocation
/// does not compile on some drivers.)
void countSubgroup(bool survivor) {
    bool waiting = survivor && gl_SampleMaskIn[0] != 0;
    for (uvec4 lanes = subgroupBallot(waiting); lanes != uvec4(0u); lanes = subgroupBallot(waiting)) {
        const uint leader = subgroupBallotFindLSB(lanes);
        const uint leadersPair = subgroupShuffle(pair, leader);
        const bool mine = waiting && pair == leadersPair;
        const uint survivors = subgroupBallotBitCount(subgroupBallot(mine));
        if (gl_SubgroupInvocationID == leader) {
            addSurvivors(pair, survivors);
        }
        waiting = waiting && !mine;
    }
}
#endif

void main() {
    const bool survivor = survives(textureCoordinate, constants.item, kRangeTest, kExactFilter);
#ifdef OUTPUTS
    if (survivor) {
        emitSurvivor(pair, triangle(), textureCoordinate);
    }
#endif
#if defined(COUNT_SUBGROUP)
    countSubgroup(survivor);
#elif defined(COUNT_ATOMIC)
    if (survivor) {
        addSurvivors(pair, 1u);
    }
#elif defined(LIST_FRAGMENTS)
    if (survivor) {
        list();
    }
#else
    if (!survivor) {
        discard;
    }
#endif
}

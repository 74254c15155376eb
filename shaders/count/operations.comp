// SPDX-License-Identifier: MIT
// Does each operation of operations.h on each set of inputs; what the lanes of a work group do together; and what a
// volume's texels are. Work groups along y are the operations.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/shared.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Inputs { uint inputs[]; };
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_RESULTS, std430) buffer Outputs { uint outputs[]; };

#include "exact/operations.h"
#include "stored.glsl"

layout(push_constant) uniform Constants { OperationConstants constants; };

shared uint sum;
shared uint bits;
shared uint most;

/// `at`: index in `outputs` of the first result of this kind.
void together(uint at, uint value) {
    if (gl_LocalInvocationIndex == 0) {
        sum = 0;
        bits = 0;
        most = 0;
    }
    barrier();
    atomicAdd(sum, value);
    atomicOr(bits, value);
    atomicMax(most, value);
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        const uint first = at + OPERATION_GROUP_WORDS * gl_WorkGroupID.x;
        outputs[first] = sum;
        outputs[first + 1] = bits;
        outputs[first + 2] = most;
    }
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (constants.texels != 0) {
        const ivec3 size = textureSize(volume, 0);
        const ivec3 voxel = ivec3(int(i) % size.x, int(i) / size.x % size.y, int(i) / (size.x * size.y));
        outputs[i] = floatBitsToUint(storedVoxel(voxel, constants.storedUnit));
        return;
    }
    const uint at = OPERATION_INPUTS * i;
    const int operation = int(gl_WorkGroupID.y);
    const uint first = OPERATION_RESULTS * constants.inputs * gl_WorkGroupID.y;
    if (operation == OPERATION_GROUP) {
        together(first, inputs[at] & 0xffffu);
        return;
    }
    uint low;
    uint high;
    operate(operation, inputs[at], inputs[at + 1], inputs[at + 2], inputs[at + 3], low, high);
    outputs[first + OPERATION_RESULTS * i] = low;
    outputs[first + OPERATION_RESULTS * i + 1] = high;
}

// SPDX-License-Identifier: MIT
// A caller's shader that reads the results on the device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxtact/device_results.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Results { PairResult results[]; };
layout(set = 0, binding = 1, std430) buffer Hits { uint hits[]; };

void main() {
    const PairResult result = results[gl_GlobalInvocationID.x];
    if ((result.countLow | result.countHigh) != 0u && VOXTACT_HOW_EXACTNESS(result.how) == 0u) {
        hits[result.pair] = result.item + result.pose + VOXTACT_HOW_METHOD(result.how) + VOXTACT_HOW_PROJECTION(result.how);
    }
}

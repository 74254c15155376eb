// SPDX-License-Identifier: MIT
// What a survivor gives in addition to its count: emitSurvivor() is all that a pass calls. Expects `volume`,
// `transferFunction` and survives.glsl.
#ifndef VOXTACT_OUTPUTS_GLSL
#define VOXTACT_OUTPUTS_GLSL

#include "exact/contact.h"
#include "ordered.glsl"

layout(constant_id = VOXTACT_CONSTANT_OUTPUTS) const uint kOutputs = 0;

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_OUTPUT_PAIRS, std430) readonly buffer OutputPairs {
    OutputPair outputPairs[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_OUTPUTS, std430) buffer Outputs { uint outputs[]; };
layout(set = VOXTACT_SET_LABELS, binding = 0) uniform utexture3D labelMap;

float contactOpacity(OutputPair pair, ContactVector at) {
    return exactOpacity(vec3(at.x, at.y, at.z), pair.item);
}

void emitTriangle(OutputPair pair, uint triangle) {
    if (atomicAdd(outputs[pair.firstTriangle + triangle], 1u) == 0u) {
        atomicOr(outputs[pair.firstMask + triangle / 32u], 1u << (triangle % 32u));
    }
}

void emitBound(OutputPair pair, ContactVector position) {
    atomicMax(outputs[pair.firstBound], orderedWord(-position.x));
    atomicMax(outputs[pair.firstBound + 1u], orderedWord(-position.y));
    atomicMax(outputs[pair.firstBound + 2u], orderedWord(-position.z));
    atomicMax(outputs[pair.firstBound + 3u], orderedWord(position.x));
    atomicMax(outputs[pair.firstBound + 4u], orderedWord(position.y));
    atomicMax(outputs[pair.firstBound + 5u], orderedWord(position.z));
}

/// Returns the number of the label at a texture coordinate.
uint labelAt(OutputPair pair, ContactVector at) {
    if (pair.labelCount == 0u) {
        return 0u;
    }
    const ContactVector place =
        contactTransform(pair.label_from_texture[0], pair.label_from_texture[1], pair.label_from_texture[2], at);
    const uint x = contactVoxel(place.x, pair.labelSizeX);
    const uint y = contactVoxel(place.y, pair.labelSizeY);
    const uint z = contactVoxel(place.z, pair.labelSizeZ);
    if (x >= pair.labelSizeX || y >= pair.labelSizeY || z >= pair.labelSizeZ) {
        return pair.outsideLabel;
    }
    return texelFetch(labelMap, ivec3(x, y, z), 0).r;
}

void writeVector(uint word, ContactVector vector) {
    outputs[word] = floatBitsToUint(vector.x);
    outputs[word + 1u] = floatBitsToUint(vector.y);
    outputs[word + 2u] = floatBitsToUint(vector.z);
}

/// Returns the sample of the `exact` filter at a texture coordinate.
ContactSample sampleAt(OutputPair pair, ContactVector at) {
    const ContactVector inside = contactClamp(at);
    const float stored = exactStored(vec3(inside.x, inside.y, inside.z), pair.item.storedUnit);
    return contactSample(stored, exactTable(stored, pair.item));
}

/// Stores a ContactResult, if the list has room.
void emitContact(OutputPair pair, uint number, uint triangle, ContactVector at, ContactVector position, uint label,
                 ContactSample found) {
    const uint before = atomicAdd(outputs[pair.contacts], 1u);
    if (before == 0xffffffffu) {
        atomicAdd(outputs[pair.contacts + 1u], 1u);
    }
    if (before >= pair.contactRoom) {
        return;
    }
    const uint word = pair.contacts + OUTPUT_HEADER_WORDS + before * OUTPUT_CONTACT_WORDS;
    const ContactVector normal = contactNormal(pair, at);
    precise float scaled = found.stored * pair.valueScale;
    precise float value = scaled + pair.valueBias;
    writeVector(word, position);
    writeVector(word + 3u, normal);
    outputs[word + 6u] = floatBitsToUint(contactDepth(pair, at, normal));
    outputs[word + 7u] = floatBitsToUint(value);
    outputs[word + 8u] = floatBitsToUint(found.opacity);
    outputs[word + 9u] = number;
    outputs[word + 10u] = triangle;
    outputs[word + 11u] = label;
}

/// Records a passing fragment of a pair at a texture coordinate; `found` is for contacts only.
void emitSurvivor(uint number, uint triangle, ContactVector at, ContactSample found) {
    const OutputPair pair = outputPairs[number];
    const ContactVector position =
        contactTransform(pair.world_from_texture[0], pair.world_from_texture[1], pair.world_from_texture[2], at);
    if ((kOutputs & OUTPUT_TRIANGLES) != 0u) {
        emitTriangle(pair, triangle);
    }
    if ((kOutputs & OUTPUT_BOUNDS) != 0u) {
        emitBound(pair, position);
    }
    const uint label = (kOutputs & (OUTPUT_LABELS | OUTPUT_CONTACTS)) != 0u ? labelAt(pair, at) : 0u;
    if ((kOutputs & OUTPUT_LABELS) != 0u) {
        atomicAdd(outputs[pair.firstLabel + label], 1u);
    }
    if ((kOutputs & OUTPUT_CONTACTS) != 0u) {
        emitContact(pair, number, triangle, at, position, label, found);
    }
}

/// Like above, with a contact's values looked up at its place.
void emitSurvivor(uint number, uint triangle, vec3 textureCoordinate) {
    const ContactVector at = contactVector(textureCoordinate.x, textureCoordinate.y, textureCoordinate.z);
    ContactSample found = contactSample(0.0, 0.0);
    if ((kOutputs & OUTPUT_CONTACTS) != 0u) {
        found = sampleAt(outputPairs[number], at);
    }
    emitSurvivor(number, triangle, at, found);
}

#endif

#version 460
// SPDX-License-Identifier: MIT
// A vertex of the window's panels.

layout(push_constant) uniform Placement {
    vec2 scale; // to clip space, from points of the window
    vec2 offset;
    vec2 used; // of the texture, from its upper left corner
    vec2 most; // limit of sample positions
};

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 coordinate;
layout(location = 2) in vec4 colour;

layout(location = 0) out vec2 outCoordinate;
layout(location = 1) out vec4 outColour;
layout(location = 2) flat out vec2 outMost;

void main() {
    gl_Position = vec4(position * scale + offset, 0.0, 1.0);
    outCoordinate = coordinate * used;
    outMost = most;
    outColour = colour;
}

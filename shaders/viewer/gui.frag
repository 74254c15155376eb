#version 460
// SPDX-License-Identifier: MIT
// The window's panels: the font's texture, or a picture.

layout(set = 0, binding = 0) uniform sampler2D picture;

layout(location = 0) in vec2 coordinate;
layout(location = 1) in vec4 colour;
layout(location = 2) flat in vec2 most;

layout(location = 0) out vec4 outColour;

void main() {
    outColour = colour * texture(picture, min(coordinate, most));
}

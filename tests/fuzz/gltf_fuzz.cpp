// SPDX-License-Identifier: MIT
// glTF 2, as text and in its binary container.
#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return voxtact::fuzz::readAsMesh("input.gltf", data, size);
}

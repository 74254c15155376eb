// SPDX-License-Identifier: MIT
// Wavefront OBJ, and with it how polygons are cut.
#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return voxtact::fuzz::readAsMesh("input.obj", data, size);
}

// SPDX-License-Identifier: MIT
// STL, ASCII and binary.
#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return voxtact::fuzz::readAsMesh("input.stl", data, size);
}

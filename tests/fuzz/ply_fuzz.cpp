// SPDX-License-Identifier: MIT
// PLY, ASCII and binary of either byte order.
#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return voxtact::fuzz::readAsMesh("input.ply", data, size);
}

// SPDX-License-Identifier: MIT
// VTK's legacy PolyData.
#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return voxtact::fuzz::readAsMesh("input.vtk", data, size);
}

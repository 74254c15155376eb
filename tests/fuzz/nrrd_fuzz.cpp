// SPDX-License-Identifier: MIT
// NRRD with its voxels, raw and gzip.
#include "volume_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    voxtact::fuzz::readFromMemory("v.nrrd", data, size);
    return 0;
}

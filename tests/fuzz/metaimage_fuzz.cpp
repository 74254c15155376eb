// SPDX-License-Identifier: MIT
// MetaImage with its voxels, raw and zlib.
#include "volume_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    voxtact::fuzz::readFromMemory("v.mha", data, size);
    return 0;
}

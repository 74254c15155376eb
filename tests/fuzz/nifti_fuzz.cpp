// SPDX-License-Identifier: MIT
// NIfTI-1 and -2, plain and gzip.
#include "volume_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    voxtact::fuzz::readFromMemory("v.nii", data, size);
    return 0;
}

// SPDX-License-Identifier: MIT
// The matrix of a camera.
#include "memory_file.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    const auto camera = io::readCamera(fuzz::fileOf(data, size));
    if (!camera) {
        fuzz::requireOneLine(camera.error().text);
        return 0;
    }
    fuzz::require(inverse(*camera).ok(), "a camera that is read can be inverted");
    return 0;
}

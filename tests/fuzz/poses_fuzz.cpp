// SPDX-License-Identifier: MIT
// Files of poses.
#include "memory_file.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    for (const io::PoseFormat format : io::poseFormats()) {
        const auto poses = io::readPoses(fuzz::fileOf(data, size), format);
        if (!poses) {
            fuzz::requireOneLine(poses.error().text);
            continue;
        }
        fuzz::require(!poses->empty(), "a file that is read has a pose");
        for (const Mat4& pose : *poses) {
            fuzz::require(checkAffine(pose, "pose").ok(), "a pose that is read is affine");
        }
    }
    return 0;
}

// SPDX-License-Identifier: MIT
#include "core/volume/label_grid.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "voxtact/distance.h"

#include <cmath>

namespace voxtact {

Error notOnGrid(const std::string& which) {
    return {ErrorCode::Unsupported, 0, which + ": the label map is not on the grid of the volume; resample it to that"};
}

Result<void> checkLabelGrid(const Grid& labels, const Grid& volume, const std::string& which) {
    constexpr double kApart = 1e-4; // voxels
    if (volume.size != labels.size) {
        return notOnGrid(which);
    }
    const Result<Mat4> texture = textureFromWorld(volume);
    VOXTACT_TRY(texture);
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vec3 voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxel[axis] = (corner >> axis & 1U) != 0 ? labels.size[axis] - 1.0 : 0.0;
        }
        const Vec3 there = transformPoint(*texture, transformPoint(worldFromIndex(labels), voxel));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(std::abs(there[axis] * volume.size[axis] - 0.5 - voxel[axis]) <= kApart)) {
                return notOnGrid(which);
            }
        }
    }
    return {};
}

Result<void> checkMeasuredLabels(std::span<const std::int32_t> labels) {
    if (labels.size() > kMaxMeasuredLabels) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(labels.size()) + " labels are asked for, one call measures at most " +
                         std::to_string(kMaxMeasuredLabels) + "; ask for fewer"};
    }
    return {};
}

Error noLabelsToMeasure(const std::string& which) {
    return refuse(which + ": labels is null, and clearances to labels are asked for");
}

} // namespace voxtact

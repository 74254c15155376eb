// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/volume/edit_rows.h"
#include "voxtact/data.h"

#include <cmath>

namespace voxtact {

namespace {

Result<void> check(const VoxelBox& box, const Grid& grid) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint64_t end = std::uint64_t{box.first[axis]} + box.size[axis];
        if (end > grid.size[axis]) {
            return refuse("the box of voxels ends at " + std::to_string(end) + " along " + kAxes[axis] +
                          ", the image has " + std::to_string(grid.size[axis]) + " voxels");
        }
    }
    return {};
}

Result<void> check(const Ball& ball, const Grid&) {
    if (!(ball.radius >= 0) || !std::isfinite(ball.radius)) {
        return refuse("the ball's radius is " + number(ball.radius) + " mm, it must be finite and not negative");
    }
    for (const double coordinate : ball.centre) {
        if (!std::isfinite(coordinate)) {
            return refuse("the ball's centre has a coordinate that is not finite");
        }
    }
    return {};
}

} // namespace

Result<VoxelBox> voxelBounds(const VoxelRegion& region, const Grid& grid) {
    return guard([&]() -> Result<VoxelBox> {
        VOXTACT_TRY(checkGrid(grid));
        Result<void> checked = std::visit([&](const auto& shape) { return check(shape, grid); }, region);
        VOXTACT_TRY(checked);
        return boundsOf(voxelRows(region, grid));
    });
}

} // namespace voxtact

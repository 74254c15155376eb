// SPDX-License-Identifier: MIT
#include "viewer/model/shown/view_cube.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

std::optional<ViewCube> cubeIn(const std::array<double, 2>& corner, const std::array<double, 2>& size,
                               double line) noexcept {
    // In lines.
    constexpr double kHalf = 1.45;
    constexpr double kEdge = 0.4;
    constexpr double kLeastPicture = 3; // of the room that the cube takes
    const double reach = (kHalf * kCubeReach + kEdge) * line;
    if (!(std::min(size[0], size[1]) >= kLeastPicture * 2 * reach)) {
        return std::nullopt;
    }
    return ViewCube{{corner[0] + size[0] - reach, corner[1] + reach}, kHalf * line};
}

std::vector<SeenSide> seenSides(const Camera& camera) {
    const Mat4 eye = eyeFromWorld(camera.direction); // its second row goes down
    return voxtact::seenSides({eye[0], eye[4], eye[8]}, {-eye[1], -eye[5], -eye[9]});
}

std::optional<std::size_t> sideAt(const ViewCube& cube, const Camera& camera, const std::array<double, 2>& at) {
    for (const SeenSide& side : seenSides(camera)) {
        const double x = (at[0] - cube.middle[0]) / cube.half - side.middle[0];
        const double y = (at[1] - cube.middle[1]) / cube.half - side.middle[1];
        // Area of the side's parallelogram.
        const double area = side.right[0] * side.up[1] - side.right[1] * side.up[0];
        const double along = (x * side.up[1] - y * side.up[0]) / area;
        const double above = (side.right[0] * y - side.right[1] * x) / area;
        if (std::abs(along) <= 1 && std::abs(above) <= 1) {
            return side.side;
        }
    }
    return std::nullopt;
}

void lookAtSide(Camera& camera, std::size_t side) noexcept {
    camera.direction = directionNamed(kPatientSides[side].view).value_or(camera.direction);
}

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/patient_cube.h"
#include "viewer/model/shown/camera.h"

#include <array>
#include <optional>

/// Cube of the patient's sides in a corner of the large picture: it rotates with the camera; a click on a side selects
/// that view. Pure functions.
namespace voxtact::view {

struct ViewCube {
    std::array<double, 2> middle{}; ///< points, to the right and down
    double half = 0;                ///< an edge's half, points
};

/// Returns the cube in the upper right corner of a picture. `line`: height of a line of text, points. Empty if the
/// picture is too small.
[[nodiscard]] std::optional<ViewCube> cubeIn(const std::array<double, 2>& corner, const std::array<double, 2>& size,
                                             double line) noexcept;

/// Returns the visible sides.
[[nodiscard]] std::vector<SeenSide> seenSides(const Camera& camera);

/// Returns the side, of kPatientSides, at a point of the window; empty outside the cube.
[[nodiscard]] std::optional<std::size_t> sideAt(const ViewCube& cube, const Camera& camera,
                                                const std::array<double, 2>& at);

/// Views a side of kPatientSides, with the same target.
void lookAtSide(Camera& camera, std::size_t side) noexcept;

} // namespace voxtact::view

// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/patient_cube.h"
#include "viewer/model/shown/camera.h"

#include <array>
#include <optional>

/// The cube of the patient's sides in a corner of the large picture: it turns with the camera, and a side of it that is
/// clicked is examined. Pure functions.
namespace voxtact::view {

struct ViewCube {
    std::array<double, 2> middle{}; ///< points, to the right and down
    double half = 0;                ///< an edge's half, points
};

/// In the upper right corner of a picture of the window. `line`: the height of a line of text there, points. Nothing
/// where the picture is too small for it.
[[nodiscard]] std::optional<ViewCube> cubeIn(const std::array<double, 2>& corner, const std::array<double, 2>& size,
                                             double line) noexcept;

/// The sides that the camera sees.
[[nodiscard]] std::vector<SeenSide> seenSides(const Camera& camera);

/// The side, of kPatientSides, at a point of the window; nothing beside the cube.
[[nodiscard]] std::optional<std::size_t> sideAt(const ViewCube& cube, const Camera& camera,
                                                const std::array<double, 2>& at);

/// Looks at a side of kPatientSides, and at what it examined before.
void lookAtSide(Camera& camera, std::size_t side) noexcept;

} // namespace voxtact::view

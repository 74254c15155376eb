// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <optional>
#include <string>

namespace voxtact::app {

/// From where the eye looks, in degrees. Azimuth 0 is before the patient's face, 90 beside the left ear, 180 behind the
/// head; elevation 90 is above.
struct Direction {
    double azimuth = 0;
    double elevation = 0;
};

/// front, back, left, right, top, bottom: from where. The picture's top is the patient's, or the face for top and
/// bottom.
[[nodiscard]] std::optional<Direction> directionNamed(const std::string& name);

/// The part of a picture that the volume is framed in: pixels.
struct ViewFrame {
    double left = 0;
    double top = 0;
    double right = 0;
    double bottom = 0;
};

/// Whence the eye looks, as a direction of world space, of unit length.
[[nodiscard]] Vec3 towardsEye(const Direction& direction);
/// Rows: to the picture's right, down and forward.
[[nodiscard]] Mat4 eyeFromWorld(const Direction& direction);

/// An orthographic clip_from_world that looks at the middle of the volume's box and frames it, with square pixels.
/// Near and far planes are beyond the volume and `also`, a box in world space.
[[nodiscard]] Mat4 viewFrom(const Direction& direction, const Grid& grid, const std::optional<Box>& also,
                            std::uint32_t width, std::uint32_t height);
[[nodiscard]] Mat4 viewFrom(const Direction& direction, const Grid& grid, const std::optional<Box>& also,
                            std::uint32_t width, std::uint32_t height, const ViewFrame& frame);
/// The smallest box that holds two.
[[nodiscard]] Box around(const Box& a, const Box& b);
/// The box of a volume, in world space.
[[nodiscard]] Box worldBox(const Grid& grid);

/// The box of a mesh at a pose, in world space.
[[nodiscard]] Box worldBox(const Box& object, const Mat4& world_from_object);

} // namespace voxtact::app

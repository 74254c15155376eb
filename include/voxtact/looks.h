// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Appearance of a picture as data: colours for kinds of images, and views from the patient's sides (target
/// voxtact::render; no Vulkan). All functions are pure and safe from any thread.
namespace voxtact {

/// Opacity and colours of a kind of image; values ascending.
struct Look {
    std::vector<ControlPoint> opacity; ///< ascending values
    std::vector<ColourPoint> colours;  ///< ascending values
};

/// Description of a preset.
struct LookPreset {
    const char* name = "";            ///< such as `mr-brain`, `ct-bone`
    bool hounsfield = false;          ///< values in Hounsfield units; else fractions of the image's range
    std::optional<ValueRange> window; ///< values of black and white in a slice; none: depends on the image
};

/// Returns all presets, with static lifetime.
[[nodiscard]] VOXTACT_API std::span<const LookPreset> lookPresets() noexcept;

/// Returns the preset with a name, or null.
[[nodiscard]] VOXTACT_API const LookPreset* findLookPreset(std::string_view name) noexcept;

/// Returns the look of a preset, in the image's own units. `values`: the image's smallest and largest voxel; presets in
/// Hounsfield units ignore them. Refuses an unknown name, and a range whose ends are not finite or not ascending.
[[nodiscard]] VOXTACT_API Result<Look> lookNamed(std::string_view name, const ValueRange& values);

/// Returns the colours of a volume without a preset: one warm white.
[[nodiscard]] VOXTACT_API std::vector<ColourPoint> plainColours();

/// Position of the eye, in degrees. Azimuth 0 is in front of the patient's face, 90 at the left ear, 180 behind the
/// head; elevation 90 is above.
struct ViewDirection {
    double azimuth = 0;   ///< degrees, around the body
    double elevation = 0; ///< degrees, above the horizontal plane
};

/// Returns the direction of `front`, `back`, `left`, `right`, `top` or `bottom`. The picture's top shows the patient's
/// head; for `top` and `bottom`, the face.
[[nodiscard]] VOXTACT_API std::optional<ViewDirection> directionNamed(std::string_view name) noexcept;

/// Returns the direction from the volume to the eye, a unit vector in world space.
[[nodiscard]] VOXTACT_API Vec3 towardsEye(const ViewDirection& direction) noexcept;

/// Returns the rotation from world space to the eye. Its rows point to the picture's right, down and forward.
[[nodiscard]] VOXTACT_API Mat4 eyeFromWorld(const ViewDirection& direction) noexcept;

/// The part of a picture that frames the volume, in pixels.
struct ViewFrame {
    double left = 0;   ///< left side, from the picture's left
    double top = 0;    ///< top side, from the picture's top
    double right = 0;  ///< right side, from the picture's left
    double bottom = 0; ///< bottom side, from the picture's top; greater than `top`
};

/// Returns an orthographic clip_from_world that looks at the middle of the volume's box. Frames the box with square
/// pixels in `frame` of a picture of width x height (none: the whole picture). The near and far planes lie beyond the
/// volume and `also`, a box in world space. Sizes must not be 0.
[[nodiscard]] VOXTACT_API Mat4 viewFrom(const ViewDirection& direction, const Grid& grid,
                                        const std::optional<Box>& also, std::uint32_t width, std::uint32_t height,
                                        const std::optional<ViewFrame>& frame = std::nullopt) noexcept;

} // namespace voxtact

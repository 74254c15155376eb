// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// How a picture looks, as data: colours for kinds of images, and views from the patient's sides (target
/// voxtact::render; no Vulkan here). All functions are pure and safe from any thread.
namespace voxtact {

/// Opacity and colours of a kind of image; values ascending.
struct Look {
    std::vector<ControlPoint> opacity; ///< ascending values
    std::vector<ColourPoint> colours;  ///< the same
};

/// One of the looks that there are.
struct LookPreset {
    const char* name = "";            ///< as `mr-brain`, `ct-bone`
    bool hounsfield = false;          ///< in Hounsfield units; else in fractions of an image's own range of values
    std::optional<ValueRange> window; ///< what a slice shows from black to white; none: it depends on the image
};

/// All of them, for as long as the program runs.
[[nodiscard]] VOXTACT_API std::span<const LookPreset> lookPresets() noexcept;

/// The preset of that name; null where there is none.
[[nodiscard]] VOXTACT_API const LookPreset* findLookPreset(std::string_view name) noexcept;

/// The look of a preset, in the image's own units. `values`: the image's smallest and largest voxel, which presets in
/// Hounsfield units ignore. Refuses a name that there is not, and a range whose ends are not finite or not ascending.
[[nodiscard]] VOXTACT_API Result<Look> lookNamed(std::string_view name, const ValueRange& values);

/// Where there is no preset: one warm white.
[[nodiscard]] VOXTACT_API std::vector<ColourPoint> plainColours();

/// From where the eye looks, in degrees. Azimuth 0 is before the patient's face, 90 beside the left ear, 180 behind the
/// head; elevation 90 is above.
struct ViewDirection {
    double azimuth = 0;   ///< degrees, round the body
    double elevation = 0; ///< degrees, above it
};

/// `front`, `back`, `left`, `right`, `top`, `bottom`: from where. The picture's top is the patient's, or the face for
/// top and bottom.
[[nodiscard]] VOXTACT_API std::optional<ViewDirection> directionNamed(std::string_view name) noexcept;

/// From where the eye looks, as a direction of world space, of unit length.
[[nodiscard]] VOXTACT_API Vec3 towardsEye(const ViewDirection& direction) noexcept;

/// A rotation. Rows: to the picture's right, down and forward.
[[nodiscard]] VOXTACT_API Mat4 eyeFromWorld(const ViewDirection& direction) noexcept;

/// The part of a picture that the volume is framed in: pixels.
struct ViewFrame {
    double left = 0;   ///< of the part's left side
    double top = 0;    ///< from the picture's top
    double right = 0;  ///< of its right side
    double bottom = 0; ///< greater than `top`
};

/// An orthographic clip_from_world that looks at the middle of the volume's box and frames it, with square pixels, in
/// `frame` of a picture of width x height (none: in all of it). Near and far planes are beyond the volume and `also`, a
/// box in world space. Sizes are not 0.
[[nodiscard]] VOXTACT_API Mat4 viewFrom(const ViewDirection& direction, const Grid& grid,
                                        const std::optional<Box>& also, std::uint32_t width, std::uint32_t height,
                                        const std::optional<ViewFrame>& frame = std::nullopt) noexcept;

} // namespace voxtact

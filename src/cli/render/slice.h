// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"
#include "voxtact/looks.h"
#include "voxtact/render.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Gray pictures of a plane through a volume, and the outlines of meshes in it: made on the host, without any device.
namespace voxtact::app {

/// --slice.
struct SliceOption {
    std::string text;         ///< as it was given
    std::string name;         ///< axial, coronal, sagittal, or view: at right angles to the view
    std::optional<double> at; ///< mm
};

/// Returns the error of a text, if any.
[[nodiscard]] std::optional<std::string> parseSlice(const std::string& text, SliceOption& slice);

/// A plane of world space, as the eye sees it.
struct SlicePlane {
    ViewDirection direction; ///< from where
    Vec3 towardsEye{};       ///< its normal, of unit length
    double offset = 0;       ///< of its points along the normal
    double shown = 0;        ///< the same as --slice takes it
};

/// `view`: where a slice `view` is seen from. `mesh`: through its middle the slice goes where no place is given,
/// if that is in the volume. Refuses a place outside of the volume.
[[nodiscard]] Result<SlicePlane> slicePlane(const SliceOption& slice, const ViewDirection& view, const Grid& grid,
                                            const std::optional<Box>& mesh);

/// A mesh at a pose, in a slice.
struct SliceMesh {
    const MeshData* mesh = nullptr;
    Mat4 world_from_object{};
    Colour colour{};
    std::span<const std::uint32_t> touching{}; ///< triangles in the contact colour
    std::span<const Colour> vertices{};        ///< colours of the vertices; none: one colour
};

struct SliceScene {
    const VolumeData* volume = nullptr;
    SlicePlane plane;
    Mat4 clip_from_world{}; ///< orthographic, along the plane's normal
    ValueRange window{};    ///< from black to white
    Colour background{};
    std::vector<SliceMesh> meshes;
    /// Tints values at or above the threshold; there outlines have the contact colour, elsewhere `elsewhere` or the
    /// mesh's own.
    std::optional<TransferFunctionDesc> transferFunction;
    double threshold = 0;
    Colour contactColour = MeshPaint{}.contactColour;
    std::optional<Colour> elsewhere;
    double thickness = 2; ///< of outlines, pixels
};

[[nodiscard]] Result<Picture> makeSlice(const SliceScene& scene, VkExtent2D size);

/// Returns the range from dark to bright of nearly all voxels.
[[nodiscard]] ValueRange usualWindow(const VolumeView& volume, const ValueRange& values);

} // namespace voxtact::app

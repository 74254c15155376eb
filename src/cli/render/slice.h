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

/// Gray pictures of a plane through a volume, with outlines of meshes. Drawn on the host, without a device.
namespace voxtact::app {

/// Value of --slice.
struct SliceOption {
    std::string text;         ///< as given
    std::string name;         ///< axial, coronal, sagittal, or view: perpendicular to the view
    std::optional<double> at; ///< mm
};

/// Returns the error of a text, if any.
[[nodiscard]] std::optional<std::string> parseSlice(const std::string& text, SliceOption& slice);

/// A plane in world space and the direction to the eye.
struct SlicePlane {
    ViewDirection direction; ///< towards the eye
    Vec3 towardsEye{};       ///< unit normal
    double offset = 0;       ///< of its points along the normal
    double shown = 0;        ///< offset in the coordinate of --slice
};

/// Returns the plane of a slice. `view`: the direction of a slice `view`. `mesh`: without a position, the slice goes
/// through the middle of this box if that is in the volume. Refuses a position outside the volume.
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
    /// Tints values at or above the threshold. Outlines have the contact colour there; elsewhere `elsewhere` or the
    /// mesh colour.
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

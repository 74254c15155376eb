// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"
#include "cli/render/options.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// What a picture is made of, read before there is a device.
struct RenderInputs {
    VolumeData volume;
    ValueRange values;
    std::vector<MeshData> meshes;       ///< as they are drawn
    std::vector<Box> bounds;            ///< of the meshes, in object space
    std::vector<Mat4> poses;            ///< those that are shown, of every mesh
    std::vector<std::uint32_t> numbers; ///< of those poses
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours;
    ValueRange domain;
    std::optional<SlicePlane> slice;
    std::vector<ClipPlane> clips;
    std::optional<AnnotationRoom> room; ///< of a picture that is annotated
    Mat4 clip_from_world{};
    std::optional<MeshClearance> clearance; ///< with --show clearance

    [[nodiscard]] TransferFunctionDesc transferFunction(const RenderOptions& options) const {
        return {opacity, domain, options.transferFunction.tableSize.value_or(kDefaultTableSize)};
    }
};

[[nodiscard]] Result<RenderInputs> readRenderInputs(const RenderOptions& options);

/// Of a mesh by its number.
[[nodiscard]] Colour meshColour(const RenderOptions& options, std::size_t mesh);

/// What is written on the picture.
[[nodiscard]] Annotation annotationOf(const RenderOptions& options, const RenderInputs& inputs,
                                      const std::optional<ValueRange>& window);

} // namespace voxtact::app

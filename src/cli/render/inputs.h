// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"
#include "cli/render/options.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// Inputs of a picture, read before a device is opened.
struct RenderInputs {
    VolumeData volume;
    ValueRange values;
    std::vector<MeshData> meshes;       ///< as drawn
    std::vector<Box> bounds;            ///< of the meshes, in object space
    std::vector<Mat4> poses;            ///< shown poses, of every mesh
    std::vector<std::uint32_t> numbers; ///< indices of these poses
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours;
    ValueRange domain;
    std::optional<SlicePlane> slice;
    std::vector<ClipPlane> clips;
    std::optional<AnnotationRoom> room; ///< of an annotated picture
    Mat4 clip_from_world{};
    std::optional<MeshDistances> distances; ///< with --show distance

    [[nodiscard]] TransferFunctionDesc transferFunction(const RenderOptions& options) const {
        return {opacity, domain, options.transferFunction.tableSize.value_or(kDefaultTableSize)};
    }
};

[[nodiscard]] Result<RenderInputs> readRenderInputs(const RenderOptions& options);

/// Returns the colour of a mesh by its index.
[[nodiscard]] Colour meshColour(const RenderOptions& options, std::size_t mesh);

/// Returns the text of the picture.
[[nodiscard]] Annotation annotationOf(const RenderOptions& options, const RenderInputs& inputs,
                                      const std::optional<ValueRange>& window);

} // namespace voxtact::app

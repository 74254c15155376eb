// SPDX-License-Identifier: MIT
#pragma once

#include "request.h"
#include "voxtact/render.h"

#include <pybind11/pybind11.h>

#include <cstdint>
#include <vector>

namespace voxtact::python {

/// What a picture shows.
struct PictureWish {
    Request shown; ///< meshes at poses; none: the volume alone
    Mat4 clip_from_world{};
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<ColourPoint> colours;
    std::vector<Colour> meshColours; ///< of each of the request's items
    Colour background{};
    Lighting lighting;
    std::vector<ClipPlane> clips;
    bool clipMeshes = false;
    Paint paint = Paint::Contacts;
    std::vector<std::vector<std::uint32_t>> triangles; ///< of each pair, for Paint::Triangles
    double through = 0;
    double threshold = kDefaultThreshold;
};

/// Of the arguments of Scene.picture(), which Python has brought into these forms; for a picture of that volume.
[[nodiscard]] PictureWish pictureWishOf(const Image& volume, const py::object& meshes, const py::object& poses,
                                        const py::dict& options);
/// (H,W,4).
[[nodiscard]] py::array_t<std::uint8_t> pixelsOf(const Picture& picture);

void definePictures(py::module_& module);

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
// What pictures are asked for, as Python says it.
#include "pictures.h"

#include "arrays.h"
#include "failure.h"
#include "voxtact/io.h"
#include "voxtact/looks.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace voxtact::python {

namespace {

constexpr std::array<std::pair<const char*, Paint>, 4> kPaints{{{"contacts", Paint::Contacts},
                                                                {"discarded", Paint::Discarded},
                                                                {"triangles", Paint::Triangles},
                                                                {"plain", Paint::Plain}}};

Paint paintOf(const std::string& name) {
    for (const auto& [word, paint] : kPaints) {
        if (name == word) {
            return paint;
        }
    }
    refuseArgument("show '" + name + "' is none of contacts, discarded, triangles, plain");
}

/// Where a picture is seen from: by a name or by angles, or by a matrix.
struct Camera {
    std::optional<ViewDirection> direction;
    Mat4 clip_from_world{};
};

Camera cameraOf(const py::handle& view) {
    if (py::isinstance<py::str>(view)) {
        const auto name = view.cast<std::string>();
        const std::optional<ViewDirection> found = directionNamed(name);
        if (!found) {
            refuseArgument("view '" + name + "' is none of front, back, left, right, top, bottom");
        }
        return {found, {}};
    }
    if (py::isinstance<py::tuple>(view) && py::len(view) == 2) {
        const auto [azimuth, elevation] = view.cast<std::pair<double, double>>();
        return {ViewDirection{azimuth, elevation}, {}};
    }
    return {std::nullopt, matrixOf(view.cast<Doubles>(), "view")};
}

std::optional<Box> boxOf(const Request& shown) {
    std::optional<Box> around;
    for (const Request::Item& item : shown.items) {
        for (const Mat4& pose : item.world_from_object) {
            const Box box = transformBox(pose, item.mesh->facts().bounds);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (!around) {
                    around = box;
                }
                around->lo[axis] = std::min(around->lo[axis], box.lo[axis]);
                around->hi[axis] = std::max(around->hi[axis], box.hi[axis]);
            }
        }
    }
    return around;
}

/// (side, mm or None), or (x, y, z, offset).
ClipPlane clipOf(const py::tuple& given, const Grid& grid, const std::optional<ViewDirection>& direction) {
    if (py::len(given) == 4) {
        const auto [x, y, z, offset] = given.cast<std::tuple<double, double, double, double>>();
        return {{x, y, z}, offset};
    }
    const auto [side, at] = given.cast<std::pair<std::string, std::optional<double>>>();
    if (side == "near" && !direction) {
        refuseArgument("clip 'near' needs a view by name or by angles; with a matrix, give a plane: (x, y, z, offset)");
    }
    const std::optional<ClipPlane> plane = clipSide(side, at, grid, direction ? towardsEye(*direction) : Vec3{});
    if (!plane) {
        refuseArgument("clip '" + side + "' is none of left, right, back, front, top, bottom, near");
    }
    return *plane;
}

/// (value, red, green, blue) each.
std::vector<ColourPoint> coloursOf(const Doubles& rows) {
    if (rows.ndim() != 2 || rows.shape(1) != 4) {
        refuseArgument("colours are no (N,4): value, red, green and blue");
    }
    std::vector<ColourPoint> points;
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
        points.push_back({rows.at(i, 0), {rows.at(i, 1), rows.at(i, 2), rows.at(i, 3)}});
    }
    return points;
}

py::array_t<double> coloursInPython(const std::vector<ColourPoint>& points) {
    py::array_t<double> rows({static_cast<py::ssize_t>(points.size()), py::ssize_t{4}});
    double* to = rows.mutable_data();
    for (const ColourPoint& point : points) {
        *to++ = point.value;
        to = std::copy(point.colour.begin(), point.colour.end(), to);
    }
    return rows;
}

using Numbers = std::vector<std::uint32_t>;

/// Chosen triangles by the pair; their own numbers are refused with the mesh.
std::vector<Numbers> chosenTriangles(const std::pair<Numbers, Numbers>& chosen, std::size_t pairs) {
    std::vector<Numbers> triangles(pairs);
    for (std::size_t i = 0; i < chosen.first.size(); ++i) {
        if (chosen.first[i] >= pairs) {
            refuseArgument("triangles are of pair " + std::to_string(chosen.first[i]) + ", and there are " +
                           std::to_string(pairs) + " pairs of a mesh and a pose");
        }
        triangles[chosen.first[i]].push_back(chosen.second[i]);
    }
    return triangles;
}

void setMeshColours(PictureWish& wish, const std::vector<Colour>& given) {
    const std::size_t items = wish.shown.items.size();
    if (!given.empty() && given.size() != items) {
        refuseArgument("mesh_colours has " + std::to_string(given.size()) + " colours, and there are " +
                       std::to_string(items) + " meshes");
    }
    for (std::size_t item = 0; item < items; ++item) {
        wish.meshColours.push_back(given.empty() ? meshColour(item) : given[item]);
    }
}

/// What is read before what depends on it.
struct Reading {
    PictureWish& wish;
    const Image& volume;
    std::optional<double> through;
    std::vector<Colour> meshColours;
    std::pair<Numbers, Numbers> triangles;
    std::vector<py::tuple> clips;
    Camera camera;

    void read(const std::string& name, const py::handle& value);
};

void Reading::read(const std::string& name, const py::handle& value) {
    if (name == "size") {
        std::tie(wish.width, wish.height) = value.cast<std::pair<std::uint32_t, std::uint32_t>>();
    } else if (name == "view") {
        camera = cameraOf(value);
    } else if (name == "preset") {
        wish.colours = take(lookNamed(value.cast<std::string>(), volume.range())).colours;
    } else if (name == "colours") {
        wish.colours = coloursOf(value.cast<Doubles>());
    } else if (name == "background") {
        wish.background = value.cast<Colour>();
    } else if (name == "lighting") {
        const auto light = value.cast<std::string>();
        const std::optional<Lighting> found = lightingNamed(light, volume.data().grid);
        if (!found) {
            refuseArgument("lighting '" + light + "' is none of soft, eye, none");
        }
        wish.lighting = *found;
    } else if (name == "show") {
        wish.paint = paintOf(value.cast<std::string>());
    } else if (name == "through") {
        through = value.cast<double>();
    } else if (name == "triangles") {
        triangles = value.cast<std::pair<Numbers, Numbers>>();
    } else if (name == "mesh_colours") {
        meshColours = value.cast<std::vector<Colour>>();
    } else if (name == "clip") {
        clips = value.cast<std::vector<py::tuple>>();
    } else if (name == "clip_meshes") {
        wish.clipMeshes = value.cast<bool>();
    } else {
        throw py::type_error("there is no option " + name);
    }
}

py::array_t<double> sideViewOf(const py::object& view, const Image& volume, const std::shared_ptr<Shape>& mesh,
                               const py::object& poses, std::uint32_t width, std::uint32_t height) {
    Camera camera;
    py::dict options; // which says what is wrong with its values
    options["view"] = view;
    readOptions(options, [&](const std::string&, const py::handle& value) { camera = cameraOf(value); });
    if (!camera.direction) {
        refuseArgument("view is neither a name nor (azimuth, elevation)");
    }
    if (width == 0 || height == 0) {
        refuseArgument("size has a 0; a view has at least one pixel");
    }
    if (!std::isfinite(camera.direction->azimuth) || !std::isfinite(camera.direction->elevation)) {
        refuseArgument("view: azimuth or elevation is not finite");
    }
    Request shown;
    if (mesh != nullptr) {
        shown = requestOf(py::cast(mesh), poses);
    }
    return matrixInPython(viewFrom(*camera.direction, volume.data().grid, boxOf(shown), width, height));
}

} // namespace

PictureWish pictureWishOf(const Image& volume, const py::object& meshes, const py::object& poses,
                          const py::dict& options) {
    PictureWish wish;
    if (!meshes.is_none()) {
        wish.shown = requestOf(meshes, poses);
    }
    wish.colours = plainColours();
    Reading reading{wish, volume, {}, {}, {}, {}, {}};
    readOptions(options, [&](const std::string& name, const py::handle& value) { reading.read(name, value); });
    if (wish.width == 0 || wish.height == 0) {
        refuseArgument("size has a 0; a picture has at least one pixel");
    }
    const Grid& grid = volume.data().grid;
    const Camera& camera = reading.camera;
    wish.clip_from_world = camera.direction
                               ? viewFrom(*camera.direction, grid, boxOf(wish.shown), wish.width, wish.height)
                               : camera.clip_from_world;
    for (const py::tuple& clip : reading.clips) {
        wish.clips.push_back(clipOf(clip, grid, camera.direction));
    }
    setMeshColours(wish, reading.meshColours);
    wish.triangles = chosenTriangles(reading.triangles, wish.shown.pairs);
    wish.through = reading.through.value_or(throughFor(wish.paint));
    return wish;
}

py::array_t<std::uint8_t> pixelsOf(const Picture& picture) {
    py::array_t<std::uint8_t> pixels(
        {static_cast<py::ssize_t>(picture.height), static_cast<py::ssize_t>(picture.width), py::ssize_t{4}});
    std::copy(picture.rgba.begin(), picture.rgba.end(), pixels.mutable_data());
    return pixels;
}

void definePictures(py::module_& module) {
    module.def("view_from", &sideViewOf, py::arg("view"), py::arg("volume"), py::arg("mesh"), py::arg("poses"),
               py::arg("width"), py::arg("height"));
    module.def("look_names", [] {
        std::vector<std::string> names;
        for (const LookPreset& preset : lookPresets()) {
            names.emplace_back(preset.name);
        }
        return names;
    });
    module.def(
        "look",
        [](const std::string& name, const Image& volume) {
            const Look found = take(lookNamed(name, volume.range()));
            return py::make_tuple(pointsInPython(found.opacity), coloursInPython(found.colours));
        },
        py::arg("name"), py::arg("volume"));
    module.def(
        "read_colours", [](const std::string& path) { return coloursInPython(take(io::readColours(path))); },
        py::arg("path"));
}

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
// Volumes, label maps, meshes and the files that they come from, as Python sees them.
#include "arrays.h"
#include "failure.h"
#include "image.h"
#include "lock.h"
#include "text.h"
#include "voxtact/io.h"
#include "voxtact/plan.h"
#include "voxtact/samples.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>

namespace voxtact::python {

namespace {

/// Runs what needs no Python, without the interpreter's lock.
template <class Work> auto unlocked(const Work& work) {
    const Unlocked unlocked;
    return work();
}

std::shared_ptr<Image> imageOf(Result<VolumeData> data) {
    return std::make_shared<Image>(take(std::move(data)));
}

std::shared_ptr<Image> readImage(const std::string& path, std::optional<std::uint32_t> frame,
                                 const std::string& series) {
    return unlocked([&] { return imageOf(io::readVolume(path, {.frame = frame, .series = series})); });
}

Grid gridOf(const Doubles& spacing, const Doubles& origin, const Doubles& direction) {
    Grid grid;
    grid.spacing = vectorOf(spacing, "spacing");
    grid.origin = vectorOf(origin, "origin");
    if (direction.ndim() != 2 || direction.shape(0) != 3 || direction.shape(1) != 3) {
        refuseArgument("direction has the wrong shape; (3,3) is needed");
    }
    for (py::ssize_t row = 0; row < 3; ++row) {
        for (py::ssize_t column = 0; column < 3; ++column) {
            grid.direction[static_cast<std::size_t>(3 * column + row)] = direction.at(row, column);
        }
    }
    return grid;
}

std::shared_ptr<Image> wrapImage(const py::array& array, const Doubles& spacing, const Doubles& origin,
                                 const Doubles& direction, std::string name, std::vector<std::string> notes) {
    const Grid grid = gridOf(spacing, origin, direction);
    if (std::string note = io::shearNote(grid); !note.empty()) {
        notes.push_back(std::move(note));
    }
    return std::make_shared<Image>(array, grid, std::move(name), std::move(notes));
}

py::array_t<double> directionInPython(const Grid& grid) {
    py::array_t<double> rows({3, 3});
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            rows.mutable_data()[3 * row + column] = grid.direction[3 * column + row];
        }
    }
    return rows;
}

py::array_t<std::int32_t> labelsAt(const LabelData& labels, const Doubles& points) {
    if (points.ndim() != 2 || points.shape(1) != 3) {
        refuseArgument("points have the wrong shape; (N,3) is needed");
    }
    py::array_t<std::int32_t> found(points.shape(0));
    for (py::ssize_t i = 0; i < points.shape(0); ++i) {
        const Vec3 point{points.at(i, 0), points.at(i, 1), points.at(i, 2)};
        found.mutable_at(i) = labels.values[labelAt(labels, point)];
    }
    return found;
}

py::array_t<std::int32_t> labelsOnLine(const LabelData& labels, const Doubles& from, const Doubles& to) {
    const Vec3 first = vectorOf(from, "start");
    const Vec3 last = vectorOf(to, "end");
    const std::vector<std::int32_t> found = unlocked([&] { return take(labelsAlong(labels, first, last)); });
    return py::array_t<std::int32_t>(static_cast<py::ssize_t>(found.size()), found.data());
}

void defineImage(py::module_& module) {
    py::class_<Image, std::shared_ptr<Image>>(module, "Volume")
        .def_static("read", &readImage, py::arg("path"), py::arg("frame"), py::arg("series"))
        .def_static(
            "builtin", [](const std::string& name) { return imageOf(makeBuiltinVolume(name)); }, py::arg("name"))
        .def_static("wrap", &wrapImage, py::arg("array"), py::arg("spacing"), py::arg("origin"), py::arg("direction"),
                    py::arg("name"), py::arg("notes"))
        .def_property_readonly("array", [](const py::object& self) { return self.cast<const Image&>().array(self); })
        .def_property_readonly("spacing", [](const Image& image) { return vectorInPython(image.data().grid.spacing); })
        .def_property_readonly("origin", [](const Image& image) { return vectorInPython(image.data().grid.origin); })
        .def_property_readonly("direction", [](const Image& image) { return directionInPython(image.data().grid); })
        .def_property_readonly("shear", [](const Image& image) { return io::shearDegrees(image.data().grid); })
        .def_property_readonly("world_from_index",
                               [](const Image& image) { return matrixInPython(worldFromIndex(image.data().grid)); })
        .def_property_readonly("type", [](const Image& image) { return toString(image.data().type); })
        .def_property_readonly("size", [](const Image& image) { return py::cast(image.data().grid.size); })
        .def_property_readonly("range",
                               [](const Image& image) { return py::make_tuple(image.range().lo, image.range().hi); })
        .def_property_readonly("name", [](const Image& image) { return textInPython(image.data().name); })
        .def_property_readonly("notes", [](const Image& image) { return textsInPython(image.data().notes); })
        .def(
            "write",
            [](const Image& image, const std::string& path) {
                unlocked([&] { take(io::writeVolume(path, image.view())); });
            },
            py::arg("path"));
    py::class_<LabelData, std::shared_ptr<LabelData>>(module, "Labels")
        .def(py::init([](const Image& image) {
                 return unlocked([&] { return std::make_shared<LabelData>(take(makeLabels(image.view()))); });
             }),
             py::arg("volume"))
        .def_property_readonly(
            "values",
            [](const py::object& self) { return readOnly(shown(self.cast<const LabelData&>().values, self)); })
        .def("at", &labelsAt, py::arg("points"))
        .def("along", &labelsOnLine, py::arg("start"), py::arg("end"));
}

std::shared_ptr<Shape> readShape(const std::string& path, bool ras, double scale) {
    const io::MeshReadOptions options{ras ? io::MeshSpace::RAS : io::MeshSpace::LPS, scale};
    return unlocked([&] { return std::make_shared<Shape>(take(io::readMesh(path, options))); });
}

using Floats = py::array_t<float, py::array::c_style>;
using Indices = py::array_t<std::uint32_t, py::array::c_style>;

std::shared_ptr<Shape> makeShape(const Floats& vertices, const Indices& faces, std::string name,
                                 std::vector<std::string> notes) {
    MeshData data;
    data.positions.assign(vertices.data(), vertices.data() + vertices.size());
    data.indices.assign(faces.data(), faces.data() + faces.size());
    data.name = std::move(name);
    data.notes = std::move(notes);
    return unlocked([&] { return std::make_shared<Shape>(std::move(data)); });
}

void defineShape(py::module_& module) {
    py::class_<Shape, std::shared_ptr<Shape>>(module, "Mesh")
        .def_static("read", &readShape, py::arg("path"), py::arg("ras"), py::arg("scale"))
        .def_static(
            "builtin", [](const std::string& name) { return std::make_shared<Shape>(take(makeBuiltinMesh(name))); },
            py::arg("name"))
        .def_static("make", &makeShape, py::arg("vertices"), py::arg("faces"), py::arg("name"), py::arg("notes"))
        .def_property_readonly(
            "vertices",
            [](const py::object& self) { return readOnly(shown(self.cast<const Shape&>().data().positions, 3, self)); })
        .def_property_readonly(
            "faces",
            [](const py::object& self) { return readOnly(shown(self.cast<const Shape&>().data().indices, 3, self)); })
        .def_property_readonly("bounds",
                               [](const Shape& shape) {
                                   const Box& box = shape.facts().bounds;
                                   return py::make_tuple(vectorInPython(box.lo), vectorInPython(box.hi));
                               })
        .def_property_readonly("degenerate", [](const Shape& shape) { return shape.facts().degenerate; })
        .def_property_readonly("name", [](const Shape& shape) { return textInPython(shape.data().name); })
        .def_property_readonly("notes", [](const Shape& shape) { return textsInPython(shape.data().notes); })
        .def(
            "write",
            [](const Shape& shape, const std::string& path) {
                unlocked([&] { take(io::writeMesh(path, shape.data().view())); });
            },
            py::arg("path"));
}

py::array_t<double> readPoses(const std::string& path) {
    return matricesInPython(unlocked([&] { return take(io::readPoses(path)); }));
}

py::dict readLabelNames(const std::string& path) {
    py::dict names;
    for (const io::LabelName& entry : take(io::readLabelNames(path))) {
        names[py::int_(entry.label)] = textInPython(entry.name);
    }
    return names;
}

py::tuple readPoints(const std::string& path) {
    const std::vector<io::NamedPoint> points = unlocked([&] { return take(io::readPoints(path)); });
    py::array_t<double> positions({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
    py::list names;
    double* to = positions.mutable_data();
    for (const io::NamedPoint& point : points) {
        to = std::copy(point.position.begin(), point.position.end(), to);
        names.append(textInPython(point.name));
    }
    return py::make_tuple(std::move(positions), py::tuple(names));
}

void writePng(const std::string& path, const py::array_t<std::uint8_t, py::array::c_style>& picture) {
    const std::span<const std::uint8_t> rgba{picture.data(), static_cast<std::size_t>(picture.size())};
    take(io::writePng(path, static_cast<std::uint32_t>(picture.shape(1)), static_cast<std::uint32_t>(picture.shape(0)),
                      rgba));
}

} // namespace

void defineData(py::module_& module) {
    defineImage(module);
    defineShape(module);
    module.def("read_poses", &readPoses, py::arg("path"));
    module.def(
        "read_camera", [](const std::string& path) { return matrixInPython(take(io::readCamera(path))); },
        py::arg("path"));
    module.def(
        "read_opacity", [](const std::string& path) { return pointsInPython(take(io::readTransferFunction(path))); },
        py::arg("path"));
    module.def(
        "parse_opacity", [](const std::string& text) { return pointsInPython(take(io::parseOpacity(text))); },
        py::arg("text"));
    module.def("read_points", &readPoints, py::arg("path"));
    module.def("read_label_names", &readLabelNames, py::arg("path"));
    module.def("write_png", &writePng, py::arg("path"), py::arg("picture"));
}

} // namespace voxtact::python

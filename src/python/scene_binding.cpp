// SPDX-License-Identifier: MIT
// Scenes as Python sees them. Arguments are read with the interpreter's lock, and the work is done without.
#include "arrays.h"
#include "failure.h"
#include "lock.h"
#include "scene.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

namespace voxtact::python {

namespace {

/// 0..255 for uint8, else the volume's values, made wider where that is one value: as the program has it.
ValueRange domainOf(const Image& volume, const py::object& domain) {
    if (!domain.is_none()) {
        const auto [lo, hi] = domain.cast<std::pair<double, double>>();
        return {lo, hi};
    }
    if (volume.data().type == ScalarType::UInt8) {
        return {0, 255};
    }
    const ValueRange& range = volume.range();
    if (range.lo < range.hi) {
        return range;
    }
    const double half = std::max(0.5, std::abs(range.lo) * 1e-6);
    return {range.lo - half, range.lo + half};
}

OpacityDesc opacityOf(const Image& volume, const py::object& points, const py::object& domain,
                      std::uint32_t tableSize) {
    OpacityDesc opacity{{}, domainOf(volume, domain), tableSize};
    opacity.points = points.is_none() ? std::vector<ControlPoint>{{opacity.domain.lo, 0}, {opacity.domain.hi, 1}}
                                      : pointsOf(points.cast<Doubles>());
    return opacity;
}

std::string number(double value) {
    return py::str("{:g}").format(value);
}

std::string rangeText(const ValueRange& range) {
    return number(range.lo) + (range.lo < range.hi ? " to " + number(range.hi) : "");
}

void warn(const std::string& text) {
    constexpr int kCaller = 2; // of the method of the package
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), kCaller) != 0) {
        throw py::error_already_set();
    }
}

/// Where nothing is opaque, or less than the points say. Of points that are refused somebody else speaks. `who`: the
/// argument that they are from.
void warnOfOpacity(const Image& volume, const OpacityDesc& opacity, double threshold, const std::string& who) {
    const Result<OpacityFacts> facts =
        checkOpacity({opacity.points, opacity.domain, opacity.tableSize}, volume.range(), threshold);
    if (!facts.ok()) {
        return;
    }
    if (!facts->reaches) {
        warn(who + ": none reaches the threshold " + number(threshold) + ": nothing touches");
    } else if (!facts->any && facts->lost.empty()) {
        warn(who + ": none of the volume's values, " + rangeText(volume.range()) + ", is opaque: nothing touches");
    }
    for (const ValueRange& lost : facts->lost) {
        warn(who + ": the entries of the table, " + number(facts->spacing) + " apart, pass over the opaque values " +
             rangeText(lost) + ": nothing touches them; table_size and domain bring them nearer to each other");
    }
}

/// What Python is told of the way: (done, all).
Progress progressOf(const py::object& callback, std::size_t all) {
    if (callback.is_none()) {
        return {};
    }
    return [&callback, all](std::size_t done) { tell(callback, done, all); };
}

std::shared_ptr<Scene> makeScene(std::shared_ptr<Image> volume, const py::object& points, const py::object& domain,
                                 std::uint32_t tableSize, double threshold, std::shared_ptr<LabelData> labels,
                                 std::shared_ptr<Device> device, std::uint32_t threads) {
    OpacityDesc opacity = opacityOf(*volume, points, domain, tableSize);
    warnOfOpacity(*volume, opacity, threshold, "opacity");
    SceneDesc desc{std::move(volume), std::move(opacity), threshold, std::move(labels), std::move(device), threads};
    const Unlocked unlocked;
    return std::make_shared<Scene>(std::move(desc));
}

void setOpacity(Scene& scene, const py::object& points, const py::object& domain, std::uint32_t tableSize) {
    OpacityDesc opacity = opacityOf(*scene.desc().volume, points, domain, tableSize);
    warnOfOpacity(*scene.desc().volume, opacity, scene.desc().threshold, "opacity");
    const Unlocked unlocked;
    scene.setOpacity(std::move(opacity));
}

void setBall(Scene& scene, const Doubles& centre, double radius, double value) {
    const Edit edit = SetEdit{Ball{vectorOf(centre, "the ball's centre"), radius}, value};
    const Unlocked unlocked;
    scene.edit(edit);
}

void setBox(Scene& scene, const std::array<std::uint32_t, 3>& first, const std::array<std::uint32_t, 3>& size,
            double value) {
    const Unlocked unlocked;
    scene.edit(SetEdit{VoxelBox{first, size}, value});
}

/// `voxels`: z, y, x, of the volume's type and in C order.
void writeBox(Scene& scene, const std::array<std::uint32_t, 3>& first, const py::array& voxels) {
    WriteEdit edit;
    edit.box.first = first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        edit.box.size[axis] = static_cast<std::uint32_t>(voxels.shape(static_cast<py::ssize_t>(2 - axis)));
    }
    const auto* begin = static_cast<const std::byte*>(voxels.data());
    edit.voxels.assign(begin, begin + voxels.nbytes());
    const Unlocked unlocked;
    scene.edit(edit);
}

std::shared_ptr<Answer> detect(Scene& scene, const py::object& meshes, const py::object& poses, const py::dict& options,
                               const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Question question = questionOf(options);
    const Progress progress = progressOf(callback, request->pairs);
    const Unlocked unlocked;
    return scene.detect(request, question, progress);
}

std::shared_ptr<Answer> again(Scene& scene, const Answer& answer, const std::string& output) {
    Outputs outputs;
    outputs.triangles = output == "triangles";
    outputs.contacts = output == "contacts";
    outputs.bounds = output == "bounds";
    outputs.labels = output == "labels";
    const Unlocked unlocked;
    return scene.again(answer, outputs);
}

std::vector<double> engineSeconds(Scene& scene, const py::object& meshes, const py::object& poses,
                                  const py::dict& options, std::uint32_t times) {
    const Request request = requestOf(meshes, poses);
    const Question question = questionOf(options);
    const Unlocked unlocked;
    return scene.engineSeconds(request, question, times);
}

std::shared_ptr<Clearances> clearance(Scene& scene, const py::object& meshes, const py::object& poses, double tolerance,
                                      double maximum, std::uint64_t mostSteps,
                                      std::optional<std::vector<std::int32_t>> labels, bool labelsAtAnyOpacity,
                                      const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Progress progress = progressOf(callback, request->pairs);
    const Distance distance{tolerance, maximum, mostSteps, labelsAtAnyOpacity};
    const Unlocked unlocked;
    return labels ? scene.labelClearance(request, distance, std::move(*labels), progress)
                  : scene.clearance(request, distance, progress);
}

std::shared_ptr<Clearances> clearanceByDevice(Scene& scene, const py::object& meshes, const py::object& poses,
                                              double tolerance, double maximum,
                                              std::optional<std::vector<std::int32_t>> labels, bool labelsAtAnyOpacity,
                                              const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Progress progress = progressOf(callback, request->pairs);
    const Unlocked unlocked;
    return scene.clearanceByDevice(request, {tolerance, maximum}, std::move(labels), labelsAtAnyOpacity, progress);
}

std::shared_ptr<Areas> area(Scene& scene, const py::object& meshes, const py::object& poses, double tolerance,
                            std::uint64_t mostSteps, std::optional<std::vector<std::int32_t>> labels, bool byTriangle,
                            const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Progress progress = progressOf(callback, request->pairs);
    const Unlocked unlocked;
    return scene.area(request, {tolerance, mostSteps}, std::move(labels), byTriangle, progress);
}

std::shared_ptr<Answer> within(Scene& scene, const py::object& meshes, const py::object& poses, double margin,
                               bool byDevice, const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Progress progress = progressOf(callback, request->pairs);
    const Unlocked unlocked;
    return scene.within(request, margin, byDevice, progress);
}

std::shared_ptr<Motions> motion(Scene& scene, const py::object& meshes, const py::object& poses,
                                const std::string& interpolation, double resolution, std::uint64_t mostSteps,
                                bool byDevice, const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Way way{interpolationOf(interpolation), resolution, mostSteps};
    checkWays(*request, way.interpolation);
    const Progress progress = progressOf(callback, request->segments());
    const Unlocked unlocked;
    return byDevice ? scene.motionByDevice(request, {resolution, way.interpolation}, progress)
                    : scene.motion(request, way, progress);
}

std::shared_ptr<Answer> around(Scene& scene, const py::object& meshes, const py::object& poses, double distance,
                               double angle, bool byDevice, const py::object& callback) {
    const auto request = std::make_shared<const Request>(requestOf(meshes, poses));
    const Progress progress = progressOf(callback, request->pairs);
    const Unlocked unlocked;
    return scene.around(request, {distance, angle}, byDevice, progress);
}

std::shared_ptr<Plan> plan(Scene& scene, const Doubles& target, const py::dict& options, std::shared_ptr<Image> avoided,
                           const py::object& points, const py::object& domain) {
    PlanWish wish = planWishOf(target, options);
    if (!points.is_none()) {
        const Image& volume = avoided != nullptr ? *avoided : *scene.desc().volume;
        OpacityDesc opacity = opacityOf(volume, points, domain, scene.desc().opacity.tableSize);
        warnOfOpacity(volume, opacity, scene.desc().threshold, "avoid_opacity");
        wish.avoided = PlanAvoided{std::move(avoided), std::move(opacity)};
    }
    const Unlocked unlocked;
    return scene.plan(wish);
}

py::array_t<std::uint8_t> picture(Scene& scene, const py::object& meshes, const py::object& poses,
                                  const py::dict& options, const std::shared_ptr<Device>& device) {
    const PictureWish wish = pictureWishOf(*scene.desc().volume, meshes, poses, options);
    Picture made;
    {
        const Unlocked unlocked;
        made = scene.picture(wish, device);
    }
    return pixelsOf(made);
}

} // namespace

void defineScene(py::module_& module) {
    py::class_<Scene, std::shared_ptr<Scene>>(module, "Scene")
        .def(py::init(&makeScene), py::arg("volume"), py::arg("opacity"), py::arg("domain"), py::arg("table_size"),
             py::arg("threshold"), py::arg("labels"), py::arg("device"), py::arg("threads"))
        .def("set_opacity", &setOpacity, py::arg("opacity"), py::arg("domain"), py::arg("table_size"))
        .def("set_threshold", &Scene::setThreshold, py::arg("threshold"), py::call_guard<Unlocked>())
        .def_property_readonly("opacity",
                               [](const Scene& scene) { return pointsInPython(scene.desc().opacity.points); })
        .def_property_readonly("domain",
                               [](const Scene& scene) {
                                   return py::make_tuple(scene.desc().opacity.domain.lo,
                                                         scene.desc().opacity.domain.hi);
                               })
        .def_property_readonly("table_size", [](const Scene& scene) { return scene.desc().opacity.tableSize; })
        .def_property_readonly("threshold", [](const Scene& scene) { return scene.desc().threshold; })
        .def_property_readonly("revision", &Scene::revision)
        .def("set_ball", &setBall, py::arg("centre"), py::arg("radius"), py::arg("value"))
        .def("set_box", &setBox, py::arg("first"), py::arg("size"), py::arg("value"))
        .def("write_box", &writeBox, py::arg("first"), py::arg("voxels"))
        .def("detect", &detect, py::arg("meshes"), py::arg("poses"), py::arg("options"), py::arg("progress"))
        .def("again", &again, py::arg("answer"), py::arg("output"))
        .def("engine_seconds", &engineSeconds, py::arg("meshes"), py::arg("poses"), py::arg("options"),
             py::arg("times"))
        .def("clearance", &clearance, py::arg("meshes"), py::arg("poses"), py::arg("tolerance"), py::arg("maximum"),
             py::arg("most_steps"), py::arg("labels"), py::arg("labels_at_any_opacity"), py::arg("progress"))
        .def("clearance_by_device", &clearanceByDevice, py::arg("meshes"), py::arg("poses"), py::arg("tolerance"),
             py::arg("maximum"), py::arg("labels"), py::arg("labels_at_any_opacity"), py::arg("progress"))
        .def("area", &area, py::arg("meshes"), py::arg("poses"), py::arg("tolerance"), py::arg("most_steps"),
             py::arg("labels"), py::arg("by_triangle"), py::arg("progress"))
        .def("within", &within, py::arg("meshes"), py::arg("poses"), py::arg("margin"), py::arg("by_device"),
             py::arg("progress"))
        .def("motion", &motion, py::arg("meshes"), py::arg("poses"), py::arg("interpolation"), py::arg("resolution"),
             py::arg("most_steps"), py::arg("by_device"), py::arg("progress"))
        .def("around", &around, py::arg("meshes"), py::arg("poses"), py::arg("distance"), py::arg("angle"),
             py::arg("by_device"), py::arg("progress"))
        .def("plan", &plan, py::arg("target"), py::arg("options"), py::arg("avoided"), py::arg("points"),
             py::arg("domain"))
        .def("picture", &picture, py::arg("meshes"), py::arg("poses"), py::arg("options"), py::arg("device"))
        .def("close", &Scene::close, py::call_guard<Unlocked>());
}

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
#include "motions.h"

#include "arrays.h"
#include "failure.h"

namespace voxtact::python {

namespace {

TouchRow noTouch() {
    TouchRow row{.at = kNone, .triangle = -1, .position = {kNone, kNone, kNone}, .label = 0, .world_from_object = {}};
    for (auto& each : row.world_from_object) {
        each.fill(kNone);
    }
    return row;
}

TouchRow rowOf(const MotionTouch& touch, const LabelData* labels) {
    TouchRow row{
        .at = touch.at, .triangle = touch.triangle, .position = touch.position, .label = 0, .world_from_object = {}};
    if (labels != nullptr) {
        row.label = labels->values[labelAt(*labels, touch.position)];
    }
    for (std::size_t element = 0; element < touch.world_from_object.size(); ++element) {
        row.world_from_object[element % 4][element / 4] = touch.world_from_object[element];
    }
    return row;
}

Vec3 centreOf(const Shape& mesh) {
    const Box& box = mesh.facts().bounds;
    return {0.5 * (box.lo[0] + box.hi[0]), 0.5 * (box.lo[1] + box.hi[1]), 0.5 * (box.lo[2] + box.hi[2])};
}

/// Of each segment: the number of its item, or that of the pose that it begins with in the item.
template <class Number> py::array_t<std::uint32_t> numbered(const Request& request, const Number& number) {
    py::array_t<std::uint32_t> numbers(static_cast<py::ssize_t>(request.segments()));
    std::uint32_t* to = numbers.mutable_data();
    for (std::size_t item = 0; item < request.items.size(); ++item) {
        for (std::size_t pose = 0; pose < request.items[item].segments(); ++pose) {
            *to++ = static_cast<std::uint32_t>(number(item, pose));
        }
    }
    return numbers;
}

/// Poses between two: (T,4,4) for T parameters.
py::array_t<double> posesBetween(const Doubles& from, const Doubles& to, const Doubles& parameters,
                                 const std::string& interpolation, const Doubles& centre) {
    const Mat4 first = matrixOf(from, "the first pose");
    const Mat4 last = matrixOf(to, "the second pose");
    const Vec3 middle = vectorOf(centre, "centre");
    std::vector<Mat4> poses;
    for (py::ssize_t i = 0; i < parameters.size(); ++i) {
        poses.push_back(take(poseBetween(first, last, parameters.at(i), interpolationOf(interpolation), middle)));
    }
    return matricesInPython(poses);
}

} // namespace

Interpolation interpolationOf(const std::string& name) {
    for (const Interpolation known : {Interpolation::Screw, Interpolation::Slerp}) {
        if (name == toString(known)) {
            return known;
        }
    }
    refuseArgument("interpolation '" + name + "' is none of screw, slerp");
}

void checkWays(const Request& request, Interpolation interpolation) {
    for (std::size_t i = 0; i < request.items.size(); ++i) {
        const Request::Item& item = request.items[i];
        const std::string which = request.items.size() == 1 ? "" : "item " + std::to_string(i) + ": ";
        const std::vector<Mat4>& poses = item.world_from_object;
        if (poses.size() < 2) {
            refuseArgument(which + "the number of poses is " + std::to_string(poses.size()) +
                           ", a motion needs two or more: (N,4,4)");
        }
        for (std::size_t pose = 0; pose + 1 < poses.size(); ++pose) {
            const Result<Mat4> known =
                poseBetween(poses[pose], poses[pose + 1], 0, interpolation, centreOf(*item.mesh));
            if (!known.ok()) {
                refuse(known.error().code, which + "poses " + std::to_string(pose) + " and " +
                                               std::to_string(pose + 1) + ": " + known.error().text);
            }
        }
    }
}

void Motions::add(const MotionAnswer& piece, const LabelData* labels) {
    for (const SegmentMotion& segment : piece.segments) {
        hit.push_back(segment.touch ? 1 : 0);
        possible.push_back(segment.possible ? 1 : 0);
        freeUntil.push_back(segment.freeUntil);
        end.push_back(static_cast<std::uint8_t>(segment.end));
        touches.push_back(segment.touch ? rowOf(*segment.touch, labels) : noTouch());
    }
    milliseconds += piece.wallMilliseconds;
}

void defineMotions(py::module_& module) {
    PYBIND11_NUMPY_DTYPE(TouchRow, at, triangle, position, label, world_from_object);

    const auto column = [](auto member, auto show) {
        return [member, show](const py::object& self) { return show(self.cast<const Motions&>().*member, self); };
    };
    const auto rows = [](const auto& values, const py::object& self) { return shown(values, self); };
    py::class_<Motions, std::shared_ptr<Motions>>(module, "Motions")
        .def_property_readonly("hit", column(&Motions::hit, truths))
        .def_property_readonly("possible", column(&Motions::possible, truths))
        .def_property_readonly("free_until", column(&Motions::freeUntil, rows))
        .def_property_readonly("end", column(&Motions::end, rows))
        .def_property_readonly("touches", column(&Motions::touches, rows))
        .def_property_readonly(
            "item",
            [](const Motions& motions) { return numbered(*motions.request, [](auto item, auto) { return item; }); })
        .def_property_readonly(
            "pose",
            [](const Motions& motions) { return numbered(*motions.request, [](auto, auto pose) { return pose; }); })
        .def_readonly("milliseconds", &Motions::milliseconds)
        .def("__len__", [](const Motions& motions) { return motions.hit.size(); });
    module.def("poses_between", &posesBetween, py::arg("first"), py::arg("last"), py::arg("parameters"),
               py::arg("interpolation"), py::arg("centre"));
}

} // namespace voxtact::python

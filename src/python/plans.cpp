// SPDX-License-Identifier: MIT
#include "plans.h"

#include "arrays.h"
#include "request.h"

#include <pybind11/stl.h>

#include <utility>

namespace voxtact::python {

namespace {

PathRow rowOf(const PlannedPath& path, bool withLabels) {
    PathRow row{.entry = path.entry,
                .position = path.position,
                .length = path.length,
                .angle = path.angle.value_or(kNone),
                .safety = static_cast<std::uint8_t>(path.safety),
                .lo = path.clearance.lo,
                .hi = path.clearance.hi,
                .end = static_cast<std::uint8_t>(path.end),
                .obstacle = -1,
                .label = 0,
                .nearest = {kNone, kNone, kNone},
                .onPath = {kNone, kNone, kNone}};
    if (path.nearest) {
        // Obstacles without those labels begin with what is opaque.
        row.obstacle = static_cast<std::int32_t>(path.nearest->obstacle) + (withLabels ? 0 : 1);
        row.label = path.nearest->label;
        row.nearest = path.nearest->position;
        row.onPath = path.nearest->onPath;
    }
    return row;
}

void read(PlanWish& wish, const std::string& name, const py::handle& value) {
    if (name == "needle") {
        const auto [diameter, length] = value.cast<std::pair<double, double>>();
        wish.needle = {diameter, length};
    } else if (name == "mesh") {
        wish.mesh = value.cast<std::shared_ptr<Shape>>();
    } else if (name == "tip") {
        wish.tip = vectorOf(value.cast<Doubles>(), "tip");
    } else if (name == "axis") {
        wish.axis = vectorOf(value.cast<Doubles>(), "axis");
    } else if (name == "avoid") {
        wish.avoid = value.cast<std::vector<std::int32_t>>();
    } else if (name == "entries") {
        wish.entries = value.cast<std::uint32_t>();
    } else if (name == "entry_label") {
        wish.entryLabel = value.cast<std::int32_t>();
    } else if (name == "entry_radius") {
        wish.entryRadius = value.cast<double>();
    } else if (name == "border_entries") {
        wish.borderEntries = value.cast<bool>();
    } else if (name == "margin") {
        wish.margin = value.cast<double>();
    } else if (name == "max_length") {
        wish.longest = value.cast<double>();
    } else if (name == "max_angle") {
        wish.steepest = value.cast<double>();
    } else if (name == "tolerance") {
        wish.tolerance = value.cast<double>();
    } else if (name == "maximum") {
        wish.maximum = value.cast<double>();
    } else if (name == "most_steps") {
        wish.mostSteps = value.cast<std::uint64_t>();
    } else if (name == "triangle_clearances") {
        wish.triangleClearances = value.cast<bool>();
    } else {
        throw py::type_error("there is no option " + name);
    }
}

} // namespace

Plan::Plan(PlanAnswer answer, bool withLabels) : totals(std::move(answer)) {
    paths.reserve(totals.paths.size());
    for (const PlannedPath& path : totals.paths) {
        paths.push_back(rowOf(path, withLabels));
    }
    for (const EntryTriangle& triangle : totals.triangles) {
        triangles.insert(triangles.end(), triangle.paths.begin(), triangle.paths.end());
        safe.push_back(triangle.safe ? 1 : 0);
        clearances.push_back(triangle.clearance);
    }
    totals.paths = {};
    totals.triangles = {};
}

PlanWish planWishOf(const Doubles& target, const py::dict& options) {
    PlanWish wish;
    wish.target = vectorOf(target, "target");
    readOptions(options, [&](const std::string& name, const py::handle& value) { read(wish, name, value); });
    return wish;
}

void definePlans(py::module_& module) {
    PYBIND11_NUMPY_DTYPE_EX(PathRow, entry, "entry", position, "position", length, "length", angle, "angle", safety,
                            "safety", lo, "lo", hi, "hi", end, "end", obstacle, "obstacle", label, "label", nearest,
                            "nearest", onPath, "on_path");
    const auto total = [](auto member) { return [member](const Plan& plan) { return plan.totals.*member; }; };
    py::class_<Plan, std::shared_ptr<Plan>>(module, "Plan")
        .def_property_readonly("paths",
                               [](const py::object& self) { return shown(self.cast<const Plan&>().paths, self); })
        .def_property_readonly(
            "triangles", [](const py::object& self) { return shown(self.cast<const Plan&>().triangles, 3, self); })
        .def_property_readonly("safe",
                               [](const py::object& self) { return truths(self.cast<const Plan&>().safe, self); })
        .def_property_readonly("triangle_clearance",
                               [](const py::object& self) { return shown(self.cast<const Plan&>().clearances, self); })
        .def_property_readonly("area", total(&PlanAnswer::area))
        .def_property_readonly("safe_area", total(&PlanAnswer::safeArea))
        .def_property_readonly("directions", total(&PlanAnswer::directions))
        .def_property_readonly("no_surface", total(&PlanAnswer::noSurface))
        .def_property_readonly("on_border", total(&PlanAnswer::onBorder))
        .def_property_readonly("too_long", total(&PlanAnswer::tooLong))
        .def_property_readonly("too_oblique", total(&PlanAnswer::tooOblique))
        .def_property_readonly("milliseconds", total(&PlanAnswer::wallMilliseconds))
        .def("__len__", [](const Plan& plan) { return plan.paths.size(); });
}

} // namespace voxtact::python

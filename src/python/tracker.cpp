// SPDX-License-Identifier: MIT
// Meshes that move by little from call to call.
#include "tracker.h"

#include "arrays.h"
#include "failure.h"
#include "lock.h"

namespace voxtact::python {

Tracker::Tracker(std::shared_ptr<Scene> scene, std::shared_ptr<const Shape> mesh, const cpu::TrackerDesc& desc)
    : scene_(std::move(scene)), mesh_(std::move(mesh)), tracker_(take(cpu::ClearanceTracker::create(desc))) {}

TrackedClearance Tracker::update(const Mat4& world_from_object) {
    return scene_->track(tracker_, *mesh_, world_from_object);
}

void defineTracker(py::module_& module) {
    py::class_<Tracker>(module, "Tracker")
        .def(py::init([](std::shared_ptr<Scene> scene, std::shared_ptr<Shape> mesh, double maximum, double resolution,
                         std::uint64_t mostSteps) {
                 return std::make_unique<Tracker>(std::move(scene), std::move(mesh),
                                                  cpu::TrackerDesc{maximum, resolution, mostSteps});
             }),
             py::arg("scene"), py::arg("mesh"), py::arg("maximum"), py::arg("resolution"), py::arg("most_steps"))
        .def(
            "update",
            [](Tracker& tracker, const Doubles& pose) {
                const Mat4 world_from_object = matrixOf(pose, "pose");
                TrackedClearance found;
                {
                    const Unlocked unlocked;
                    found = tracker.update(world_from_object);
                }
                return py::make_tuple(found.hit, found.possible, found.bounds.lo, found.bounds.hi, found.searched);
            },
            py::arg("pose"));
}

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
#include "measuring.h"

#include "failure.h"
#include "lock.h"
#include "text.h"
#include "voxtact/detector.h"
#include "voxtact/samples.h"

#include <vector>

namespace voxtact::python {

namespace {

/// (method, available, trusted, text, pairs per second) of each.
py::list inPython(const std::vector<MethodSpeed>& speeds) {
    py::list rows;
    for (const MethodSpeed& speed : speeds) {
        rows.append(py::make_tuple(toString(speed.verdict.method), speed.verdict.available, speed.verdict.trusted,
                                   textInPython(speed.verdict.text), speed.pairsPerSecond));
    }
    return rows;
}

py::list measure(const Device& device) {
    std::vector<MethodSpeed> speeds;
    {
        const Unlocked unlocked;
        const MeasureScene scene = take(makeMeasureScene());
        MeasureDesc desc;
        desc.scene = &scene;
        speeds = take(measureMethods(device.context(), device.queue(), desc));
    }
    return inPython(speeds);
}

py::list test(const Device& device) {
    std::vector<MethodSpeed> speeds;
    {
        const Unlocked unlocked;
        for (SelfTestVerdict& verdict : take(selfTest(device.context(), device.queue()))) {
            speeds.push_back({std::move(verdict), 0});
        }
    }
    return inPython(speeds);
}

} // namespace

void defineMeasuring(py::class_<Device, std::shared_ptr<Device>>& device) {
    device.def("measure_methods", &measure)
        .def("self_test", &test)
        .def_property_readonly("default_method",
                               [](const Device& of) { return toString(of.context().defaultMethod()); });
}

} // namespace voxtact::python

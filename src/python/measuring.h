// SPDX-License-Identifier: MIT
#pragma once

#include "device.h"

namespace voxtact::python {

/// What a device's counting methods are worth: adds to its class.
void defineMeasuring(py::class_<Device, std::shared_ptr<Device>>& device);

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace voxtact::python {

/// Boxes and the broad phase.
void defineGeometry(pybind11::module_& module);

} // namespace voxtact::python

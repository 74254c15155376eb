// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

/// Text that may come from a file, as a str. Files and their names may hold any bytes: those that are not UTF-8 become
/// surrogate escapes, as in Python's own names of files, so that the same str given back means the same bytes. It never
/// raises. All of it needs the interpreter's lock.
namespace voxtact::python {

[[nodiscard]] pybind11::str textInPython(const std::string& text);
[[nodiscard]] pybind11::list textsInPython(const std::vector<std::string>& texts);

} // namespace voxtact::python

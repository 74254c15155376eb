// SPDX-License-Identifier: MIT
#include "text.h"

namespace voxtact::python {

namespace py = pybind11;

py::str textInPython(const std::string& text) {
    PyObject* const made = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape");
    if (made == nullptr) {
        throw py::error_already_set(); // there is no memory
    }
    return py::reinterpret_steal<py::str>(made);
}

py::list textsInPython(const std::vector<std::string>& texts) {
    py::list all;
    for (const std::string& text : texts) {
        all.append(textInPython(text));
    }
    return all;
}

} // namespace voxtact::python

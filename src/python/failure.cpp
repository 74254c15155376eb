// SPDX-License-Identifier: MIT
#include "failure.h"

#include "text.h"

namespace voxtact::python {

namespace {

namespace py = pybind11;

void setException(const Error& error) {
    const py::object exception =
        py::module_::import("voxtact._errors")
            .attr("exception")(static_cast<std::uint32_t>(error.code), textInPython(error.text), error.vkResult);
    PyErr_SetObject(py::type::handle_of(exception).ptr(), exception.ptr());
}

} // namespace

void registerFailures() {
    py::register_local_exception_translator([](std::exception_ptr thrown) {
        try {
            std::rethrow_exception(std::move(thrown));
        } catch (const Failure& failure) {
            setException(failure.error);
        }
    });
}

} // namespace voxtact::python

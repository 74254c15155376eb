// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <pybind11/numpy.h>

#include <limits>
#include <vector>

/// Between numpy and plain data. All of it needs the interpreter's lock.
namespace voxtact::python {

namespace py = pybind11;

/// What an array has where there is no number.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Numbers as Python code may give them: any dtype that numpy turns into doubles.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// What numpy makes of it; numpy's exception where these are no numbers.
[[nodiscard]] Doubles numbersOf(const py::handle& numbers);

/// An array that shows a vector's memory; `owner` keeps it.
template <class T> py::array shown(const std::vector<T>& values, const py::object& owner) {
    return py::array(py::dtype::of<T>(), {static_cast<py::ssize_t>(values.size())}, values.data(), owner);
}
/// The same in rows of `columns`.
template <class T> py::array shown(const std::vector<T>& values, std::size_t columns, const py::object& owner) {
    return py::array(py::dtype::of<T>(),
                     {static_cast<py::ssize_t>(values.size() / columns), static_cast<py::ssize_t>(columns)},
                     values.data(), owner);
}
/// The same of ones and zeros, as truth values.
[[nodiscard]] py::array truths(const std::vector<std::uint8_t>& values, const py::object& owner);
/// The same array, not to be written to.
[[nodiscard]] py::array readOnly(py::array array);

/// A 4x4 matrix as one writes it, row by row, and back. `what` begins the text of a refusal.
[[nodiscard]] Mat4 matrixOf(const Doubles& rows, const char* what);
[[nodiscard]] py::array_t<double> matrixInPython(const Mat4& matrix);

/// Matrices of shape (4,4) or (N,4,4), and back to the latter.
[[nodiscard]] std::vector<Mat4> matricesOf(const Doubles& rows, const char* what);
[[nodiscard]] py::array_t<double> matricesInPython(const std::vector<Mat4>& matrices);

[[nodiscard]] Vec3 vectorOf(const Doubles& numbers, const char* what);
[[nodiscard]] py::array_t<double> vectorInPython(const Vec3& vector);

/// (N,2): value and opacity.
[[nodiscard]] std::vector<ControlPoint> pointsOf(const Doubles& rows);
[[nodiscard]] py::array_t<double> pointsInPython(const std::vector<ControlPoint>& points);

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
#include "arrays.h"

#include "failure.h"

#include <algorithm>

namespace voxtact::python {

namespace {

std::string shapeText(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
        text += (axis == 0 ? "" : ",") + std::to_string(array.shape(axis));
    }
    return text + ")";
}

Mat4 fromRows(const double* rows) noexcept {
    Mat4 matrix;
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            matrix[4 * column + row] = rows[4 * row + column];
        }
    }
    return matrix;
}

bool isSquare(const py::array& array, py::ssize_t first) {
    return array.shape(first) == 4 && array.shape(first + 1) == 4;
}

} // namespace

Doubles numbersOf(const py::handle& numbers) {
    return Doubles(py::reinterpret_borrow<py::object>(numbers));
}

py::array truths(const std::vector<std::uint8_t>& values, const py::object& owner) {
    return py::array(py::dtype::of<bool>(), {static_cast<py::ssize_t>(values.size())}, values.data(), owner);
}

py::array readOnly(py::array array) {
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

Mat4 matrixOf(const Doubles& rows, const char* what) {
    if (rows.ndim() != 2 || !isSquare(rows, 0)) {
        refuseArgument(std::string(what) + " has the shape " + shapeText(rows) + "; (4,4) is needed");
    }
    return fromRows(rows.data());
}

py::array_t<double> matrixInPython(const Mat4& matrix) {
    py::array_t<double> rows({4, 4});
    const Mat4 transposed = fromRows(matrix.data());
    std::copy(transposed.begin(), transposed.end(), rows.mutable_data());
    return rows;
}

std::vector<Mat4> matricesOf(const Doubles& rows, const char* what) {
    const bool one = rows.ndim() == 2 && isSquare(rows, 0);
    if (!one && (rows.ndim() != 3 || !isSquare(rows, 1))) {
        refuseArgument(std::string(what) + " have the shape " + shapeText(rows) +
                       "; (4,4) or (N,4,4) is needed, row by row");
    }
    std::vector<Mat4> matrices(one ? 1 : static_cast<std::size_t>(rows.shape(0)));
    const double* from = rows.data();
    for (Mat4& matrix : matrices) {
        matrix = fromRows(from);
        from += matrix.size();
    }
    return matrices;
}

py::array_t<double> matricesInPython(const std::vector<Mat4>& matrices) {
    py::array_t<double> rows({static_cast<py::ssize_t>(matrices.size()), py::ssize_t{4}, py::ssize_t{4}});
    double* to = rows.mutable_data();
    for (const Mat4& matrix : matrices) {
        const Mat4 transposed = fromRows(matrix.data());
        to = std::copy(transposed.begin(), transposed.end(), to);
    }
    return rows;
}

Vec3 vectorOf(const Doubles& numbers, const char* what) {
    if (numbers.ndim() != 1 || numbers.shape(0) != 3) {
        refuseArgument(std::string(what) + " has the shape " + shapeText(numbers) + "; (3,) is needed");
    }
    return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

py::array_t<double> vectorInPython(const Vec3& vector) {
    return py::array_t<double>(3, vector.data());
}

std::vector<ControlPoint> pointsOf(const Doubles& rows) {
    if (rows.ndim() != 2 || rows.shape(1) != 2) {
        refuseArgument("opacity has the shape " + shapeText(rows) + "; (N,2) is needed: value and opacity");
    }
    std::vector<ControlPoint> points(static_cast<std::size_t>(rows.shape(0)));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = {rows.at(static_cast<py::ssize_t>(i), 0), rows.at(static_cast<py::ssize_t>(i), 1)};
    }
    return points;
}

py::array_t<double> pointsInPython(const std::vector<ControlPoint>& points) {
    py::array_t<double> rows({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
    double* to = rows.mutable_data();
    for (const ControlPoint& point : points) {
        *to++ = point.value;
        *to++ = point.opacity;
    }
    return rows;
}

} // namespace voxtact::python

// SPDX-License-Identifier: MIT
#include "image.h"

#include "arrays.h"
#include "failure.h"
#include "lock.h"
#include "voxtact/cpu.h"

#include <array>

namespace voxtact::python {

namespace {

constexpr std::array kTypes{ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32};

py::dtype dtypeOf(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return py::dtype::of<std::uint8_t>();
    case ScalarType::Int16:
        return py::dtype::of<std::int16_t>();
    case ScalarType::UInt16:
        return py::dtype::of<std::uint16_t>();
    case ScalarType::Float32:
        break;
    }
    return py::dtype::of<float>();
}

ScalarType typeOf(const py::array& array) {
    for (const ScalarType type : kTypes) {
        if (array.dtype().is(dtypeOf(type)) || array.dtype().equal(dtypeOf(type))) {
            return type;
        }
    }
    throw py::type_error("voxels of uint8, int16, uint16 or float32 in the machine's byte order");
}

} // namespace

Image::Image(VolumeData data) : data_(std::move(data)), voxels_(data_.voxels), range_(take(checkVolume(view()))) {}

Image::Image(const py::array& array, const Grid& grid, std::string name, std::vector<std::string> notes)
    : kept_(array) {
    data_.grid = grid;
    data_.type = typeOf(array);
    data_.name = std::move(name);
    data_.notes = std::move(notes);
    if (array.ndim() != 3 || (array.flags() & py::array::c_style) == 0) {
        throw py::type_error("an array of three dimensions in C order");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        data_.grid.size[axis] = static_cast<std::uint32_t>(array.shape(static_cast<py::ssize_t>(2 - axis)));
    }
    voxels_ = {static_cast<const std::byte*>(array.data()), static_cast<std::size_t>(array.nbytes())};
    const VolumeView seen = view();
    const Unlocked unlocked;
    range_ = take(checkVolume(seen));
}

py::array Image::array(const py::object& self) const {
    const std::array<std::uint32_t, 3>& size = data_.grid.size;
    return readOnly(
        py::array(dtypeOf(data_.type), std::vector<py::ssize_t>{size[2], size[1], size[0]}, voxels_.data(), self));
}

Shape::Shape(MeshData data) : data_(std::move(data)), facts_(take(checkMesh(data_.view()))) {}
Shape::~Shape() {
    delete onHost_.load();
}

const cpu::Mesh& Shape::onHost() const {
    const cpu::Mesh* known = onHost_.load();
    if (known != nullptr) {
        return *known;
    }
    auto made = std::make_unique<const cpu::Mesh>(take(cpu::Mesh::create(data_.view())));
    if (onHost_.compare_exchange_strong(known, made.get())) {
        return *made.release();
    }
    return *known;
}

} // namespace voxtact::python

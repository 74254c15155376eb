// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxtact::cpu {
class Mesh;
}

/// What Python code holds and scenes are made of: volumes, label maps and meshes.
namespace voxtact::python {

namespace py = pybind11;

/// A volume whose voxels are its own, or those of a numpy array that is kept and not copied.
class Image {
  public:
    explicit Image(VolumeData data);
    /// The array has the machine's byte order and is in C order, z, y, x. Refuses what checkVolume() refuses.
    Image(const py::array& array, const Grid& grid, std::string name, std::vector<std::string> notes);

    [[nodiscard]] VolumeView view() const noexcept { return {data_.grid, data_.type, voxels_}; }
    [[nodiscard]] const VolumeData& data() const noexcept { return data_; }
    /// Smallest and largest voxel.
    [[nodiscard]] const ValueRange& range() const noexcept { return range_; }
    /// The voxels, z, y, x: `self` keeps them.
    [[nodiscard]] py::array array(const py::object& self) const;

  private:
    VolumeData data_; ///< without voxels where these are an array's
    std::span<const std::byte> voxels_;
    py::object kept_; ///< whose voxels they are, where they are not ours
    ValueRange range_;
};

/// A mesh whose arrays are its own, and what the host engine makes of it when it is first asked for.
class Shape {
  public:
    /// Refuses what checkMesh() refuses.
    explicit Shape(MeshData data);
    ~Shape();
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;

    [[nodiscard]] const MeshData& data() const noexcept { return data_; }
    [[nodiscard]] const MeshFacts& facts() const noexcept { return facts_; }
    /// Thread-safe; the interpreter's lock is not needed.
    [[nodiscard]] const cpu::Mesh& onHost() const;

  private:
    MeshData data_;
    MeshFacts facts_;
    /// Of two threads that make it, one is first; a lock could be held by a thread that a fork leaves behind.
    mutable std::atomic<const cpu::Mesh*> onHost_ = nullptr;
};

void defineData(py::module_& module);

} // namespace voxtact::python

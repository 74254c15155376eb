// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/mesh_file.h"
#include "io/volume/stored_image.h"

#include <optional>
#include <span>

namespace voxtact::io {

enum class VtkCellKind { Vertices, Lines, Strips, Polygons };

/// Adds cells of VTK's PolyData to a mesh file: polygons and strips as faces, vertices and lines as a count. Each
/// function returns the reason why the cells cannot be used.
class VtkCells {
  public:
    /// The corners of the cells count from `firstVertex`, and lie below the vertices that `file` has now.
    VtkCells(MeshFile& file, std::size_t firstVertex) : file_(file), firstVertex_(firstVertex) {}

    /// Each cell as its number of corners and the corners.
    [[nodiscard]] std::optional<std::string> addCounted(VtkCellKind kind, std::span<const std::uint64_t> numbers,
                                                        std::uint64_t cells);
    /// `ends`: of each cell the end of its corners in `corners`.
    [[nodiscard]] std::optional<std::string> addListed(VtkCellKind kind, std::span<const std::uint64_t> ends,
                                                       std::span<const std::uint64_t> corners);

  private:
    [[nodiscard]] std::optional<std::string> add(VtkCellKind kind, std::span<const std::uint64_t> corners);

    MeshFile& file_;
    std::size_t firstVertex_;
    std::vector<std::uint32_t> cell_;
};

/// Appends the numbers of an array in a file, as doubles.
void appendVtkReals(std::string_view bytes, StoredType type, bool swapped, std::vector<double>& values);
/// Appends whole numbers; false if one is negative, or the type is real.
[[nodiscard]] bool appendVtkNaturals(std::string_view bytes, StoredType type, bool swapped,
                                     std::vector<std::uint64_t>& values);

/// Appends points of three coordinates; false if there are more vertices than 32 bits count.
[[nodiscard]] bool addVtkPoints(std::span<const double> coordinates, MeshFile& file);

/// Takes the value of 3D Slicer's field SPACE: RAS or LPS.
void takeVtkSpace(std::string_view value, MeshFile& file);

} // namespace voxtact::io

// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/shown/camera.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

/// Slices through the volume along the world's planes.
namespace voxtact::view {

/// A slice in radiological orientation, with the letters of the patient's sides.
struct SliceKind {
    const char* name;
    ViewDirection direction;
    std::size_t axis; ///< world axis perpendicular to the slice
    const char* left;
    const char* right;
    const char* top;
    const char* bottom;
};
inline constexpr std::array<SliceKind, 3> kSlices{{{"axial", {0, -90}, 2, "R", "L", "A", "P"},
                                                   {"coronal", {0, 0}, 1, "R", "L", "S", "I"},
                                                   {"sagittal", {90, 0}, 0, "A", "P", "S", "I"}}};

/// Position of a slice in its picture.
struct SlicePlace {
    Mat4 clip_from_world{}; ///< orthographic, along the world's axis
    Mat4 world_from_clip{}; ///< onto the plane, whatever the depth
};

/// Position of the slice through `cursor`, with the volume framed in a picture of that size.
[[nodiscard]] SlicePlace slicePlace(const SliceKind& kind, const Grid& grid, const Vec3& cursor, const Extent& extent);

/// x and y of a picture, 0..1 from its upper left corner.
using Point2 = std::array<double, 2>;

/// Converts between points of the picture and of the world.
[[nodiscard]] Vec3 worldAt(const SlicePlace& place, const Point2& at);
[[nodiscard]] Point2 pictureAt(const SlicePlace& place, const Vec3& world);

/// Number of decimals of a millimetre; more if voxels are too small to distinguish.
[[nodiscard]] int decimalsOn(const Grid& grid, int decimals);
/// Formats a length or position with that many decimals; zero has no sign.
[[nodiscard]] std::string mmText(const Grid& grid, int decimals, double mm);

/// A piece of a mesh's outline in a slice.
struct OutlinePiece {
    Point2 from{};
    Point2 to{};
    std::uint32_t triangle = 0;
};

/// Returns the intersection of the mesh with the plane at `at` mm of a world axis.
[[nodiscard]] std::vector<OutlinePiece> outline(const MeshView& mesh, const Mat4& world_from_object, std::size_t axis,
                                                double at, const SlicePlace& place);

} // namespace voxtact::view

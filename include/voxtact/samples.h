// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <string_view>

/// Builtin meshes and volumes. The same arguments give the same data, bit for bit, on every machine with IEEE
/// arithmetic.
namespace voxtact {

/// Number of triangles of the paper's instrument.
inline constexpr std::uint32_t kScalpelTriangles = 3068;
/// Number of triangles of the paper's finer mesh.
inline constexpr std::uint32_t kEllipsoidTriangles = 49998;

/// Creates a scalpel with handle, neck and blade: 150 mm long, y from -8 to 2, x from -1.5 to 1.5. The tip of the blade
/// is at the object's origin, the handle points along +z, the cutting edge towards -y, the flat sides face +-x. Closed,
/// genus 0, outward counter-clockwise, with exactly `triangles` triangles. Refuses odd numbers, because a closed
/// surface of genus 0 has 2V-4 triangles. Refuses numbers too small for the shape or above 2^24. The error names the
/// nearest valid numbers. A finer mesh resolves more of the blade's belly and the grip's ridges.
[[nodiscard]] VOXTACT_API Result<MeshData> makeScalpel(std::uint32_t triangles = kScalpelTriangles);

/// Creates an ellipsoid around the origin with half axes 20, 30 and 40 mm along x, y, z. Closed, genus 0, outward
/// counter-clockwise, with exactly `triangles` triangles; the valid numbers are those of makeScalpel().
[[nodiscard]] VOXTACT_API Result<MeshData> makeEllipsoid(std::uint32_t triangles = kEllipsoidTriangles);

/// Creates a straight round needle with round ends: the tip at the object's origin, the shaft along +z. Closed, outward
/// counter-clockwise, 32 corners around. All vertices lie on the round needle; the mesh is inside by at most 0.5 % of
/// the radius along the shaft, and 1 % at the ends. Refuses a diameter (mm) that is not above 0, and a length below the
/// diameter.
[[nodiscard]] VOXTACT_API Result<MeshData> makeNeedle(double diameter, double length);
/// Default diameter of the builtin `needle`, mm.
inline constexpr double kNeedleDiameter = 2;
inline constexpr double kNeedleLength = 200; ///< default length of the builtin `needle`, mm

/// Creates a builtin mesh, by the name after `builtin:` on the command line: `scalpel` or `ellipsoid`, optionally with
/// a number of triangles (`scalpel:3068`), or `needle`, optionally with diameter and length in mm (`needle:1.5:180`).
[[nodiscard]] VOXTACT_API Result<MeshData> makeBuiltinMesh(std::string_view name);

/// Creates a synthetic volume, 200 mm per side, centred on the world's origin. The name may end in the number of voxels
/// per side, from 4 to 1024 (`head:256`); the default is 128.
///
/// - `head`: uint8, a layered head (skin, skull, brain, ventricles); the boundary voxels are 0.
/// - `sphere`: uint8, a ramp from 255 at the centre to 0 at 0.45 of the side.
/// - `noise`: uint16, smooth noise from 0 to 4095.
/// - `ct`: int16, -1024..3071, the same head in HU, anisotropic and oblique; a third as many slices, rounded up.
/// - `shells`: float, 0..1, thin shells at 20, 40, 60 and 80 mm, 3 voxels thick.
/// - `vessels`: uint8, a sparse tree of tubes, from 255 on their axes to 0, that enters through the lowest face; half
///   as many slices, rounded up.
[[nodiscard]] VOXTACT_API Result<VolumeData> makeBuiltinVolume(std::string_view name);

} // namespace voxtact

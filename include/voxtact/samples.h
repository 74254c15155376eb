// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <string_view>

/// Meshes and volumes that need no file. The same arguments give the same data, bit for bit, on every machine with
/// IEEE arithmetic.
namespace voxtact {

/// Triangles of the paper's instrument.
inline constexpr std::uint32_t kScalpelTriangles = 3068;
/// Triangles of the paper's finer mesh.
inline constexpr std::uint32_t kEllipsoidTriangles = 49998;

/// A scalpel with handle, neck and blade: 150 mm long, the tip of the blade at the object's origin, the handle along
/// +z, the cutting edge towards -y, the flat sides facing +-x. Closed, genus 0, outward counter-clockwise, with
/// exactly `triangles` triangles. A closed surface of genus 0 has 2V-4 triangles: an odd number is refused with the
/// nearest possible ones named, and so is one too small for the shape, or above 2^24. y runs from -8 to 2, x from -1.5
/// to 1.5; the finer the mesh, the more of the belly of the blade and of the ridges of the grip it has.
[[nodiscard]] VOXTACT_API Result<MeshData> makeScalpel(std::uint32_t triangles = kScalpelTriangles);

/// An ellipsoid around the origin with half axes 20, 30 and 40 mm along x, y, z. Closed, genus 0, outward
/// counter-clockwise, with exactly `triangles` triangles; numbers are refused as by makeScalpel().
[[nodiscard]] VOXTACT_API Result<MeshData> makeEllipsoid(std::uint32_t triangles = kEllipsoidTriangles);

/// A straight needle of round section, with round ends: the tip at the object's origin, the shaft along +z. Closed,
/// outward counter-clockwise, 32 corners around. All of them are on the round needle itself, inside which the mesh
/// stays: by at most 0.5 % of the radius along the shaft, 1 % at the ends. Refuses a diameter that is not above 0, mm,
/// and a length that is smaller.
[[nodiscard]] VOXTACT_API Result<MeshData> makeNeedle(double diameter, double length);
/// Of `needle` without numbers, mm.
inline constexpr double kNeedleDiameter = 2;
inline constexpr double kNeedleLength = 200; ///< see kNeedleDiameter

/// `scalpel` or `ellipsoid`, with or without a number of triangles (`scalpel:3068`), or `needle`, with or without its
/// diameter and length in mm (`needle:1.5:180`): the names after `builtin:` on the command line.
[[nodiscard]] VOXTACT_API Result<MeshData> makeBuiltinMesh(std::string_view name);

/// Synthetic volumes, 200 mm per side, centred on the world's origin. The name may end in the number of voxels per
/// side, from 4 to 1024: `head:256`; without one there are 128. `head` (uint8, a layered head: skin, skull, brain,
/// ventricles; the voxels on the boundary are 0), `sphere` (uint8, a ramp that falls from 255 at the centre to 0 at
/// 0.45 of the side), `noise` (uint16, smooth noise, stretched to reach both 0 and 4095), `ct` (int16, -1024..3071, the
/// same head in HU, anisotropic and oblique, a third as many slices, rounded up), `shells` (float, 0..1, thin shells at
/// 20, 40, 60 and 80 mm, 3 voxels thick), `vessels` (uint8, a sparse tree of tubes, from 255 on their axes to 0, that
/// enters through the lowest face; half as many slices, rounded up).
[[nodiscard]] VOXTACT_API Result<VolumeData> makeBuiltinVolume(std::string_view name);

} // namespace voxtact

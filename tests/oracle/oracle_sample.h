// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle_raster.h"
#include "voxtact/data.h"

#include <vector>

/// The look-ups of the oracle, at a point and over all that a tolerance reaches.
namespace voxtact::oracle {

struct Table {
    std::vector<float> entries;
    ValueRange domain;
};

/// Texture coordinate, clamped to the domain -> value, trilinear between voxel centres, clamped to the edge.
[[nodiscard]] double sampleVolume(const VolumeView& volume, const Vec3& coordinate);
/// Value -> opacity, linear between the centres of the table's entries, clamped to the first and the last.
[[nodiscard]] double lookUp(const Table& table, double value);

struct SampleTolerance {
    double weight = 0; ///< of a voxel along each axis, and of an entry of the table
    double value = 0;  ///< in stored units
};
/// The least and the greatest opacity at coordinates in the box, which is clamped to the domain, with the tolerance and
/// with arithmetic in single precision. Tight but for these: the extremes of an interpolant that is linear along each
/// axis are at the corners of each cell's part of the box.
[[nodiscard]] ValueRange opacityRange(const VolumeView& volume, const Table& table, const TextureBox& box,
                                      const SampleTolerance& tolerance);

} // namespace voxtact::oracle

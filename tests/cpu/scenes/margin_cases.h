// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/certified_scenes.h"
#include "voxtact/cpu.h"

#include <array>
#include <random>
#include <span>
#include <vector>

/// Scenes for what asks how near something is.
namespace voxtact::test {

/// Like those of the certified tests, at some distance, and some with axes that are not at right angles.
[[nodiscard]] CertifiedCase makeClearanceCase(std::uint64_t seed, std::uint64_t number);

struct MarginCase {
    OracleScene scene;
    double margin = 0; ///< mm: the clearance, or a little more or less, or half or twice of it; some number where it is
                       ///< 0 or infinite
};

/// The same case for the same numbers.
[[nodiscard]] MarginCase makeMarginCase(std::uint64_t seed, std::uint64_t number, cpu::ClearanceMeter& meter);
/// The world, larger or smaller: so the margin becomes `margin`.
void scaleTo(MarginCase& c, double margin);

/// A volume that is opaque beyond a plane, and a triangle before it, with its tip, an edge or all of it as near: in a
/// grid with axes of different lengths, turned, and sheared.
struct KnownPlane {
    VolumeData volume; ///< of one of the types
    std::vector<ControlPoint> points;
    ValueRange domain;
    double threshold = 0; ///< a half for all that is beyond, nearly one for a thin sheet of it
    MeshData mesh;
    double distance = 0; ///< mm, of the mesh from what is opaque
    double slack = 0;    ///< mm: what is so much nearer or farther is certainly told apart
};

inline constexpr std::array kVoxelTypes{ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32};

/// `number` says of which kind it is.
/// `types`: of the voxels, by turns.
[[nodiscard]] KnownPlane makeKnownPlane(std::mt19937_64& random, int number,
                                        std::span<const ScalarType> types = kVoxelTypes);
/// The world, larger or smaller: so the distance becomes `distance`.
void scaleTo(KnownPlane& known, double distance);

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"

#include <array>
#include <cstdint>
#include <vector>

/// The certified oracle: the question of the projection `certified` answered in double precision, written apart from
/// the engine. A triangle touches when it has a point in the closed domain, the box [0,1]^3 of texture space, whose
/// opacity reaches the threshold. Opacity is that of the trilinear interpolant of the voxels, constant beyond the
/// outermost voxel centres, looked up between the control points. No camera, no samples, no hierarchy: each
/// triangle is cut at the cells of the image, and the pieces are halved until bounds decide.
///
/// It shares with everybody the floats of the vertices, and the doubles of
/// textureFromWorld() and the pose; what it rounds itself is in its bounds.
namespace voxtact::oracle {

enum class Certainty : std::uint32_t {
    None,     ///< beyond doubt no opaque point
    Certain,  ///< beyond doubt an opaque point
    Undecided ///< neither could be shown
};
[[nodiscard]] const char* toString(Certainty certainty) noexcept;

/// Pieces of a triangle no longer than this many voxels are not divided.
inline constexpr double kOracleResolution = 1.0 / 512;

struct JudgedTriangle {
    Certainty certainty = Certainty::None;
    Vec3 witness{}; ///< texture space, of an opaque point; only where certain
    /// The proof is the intermediate value theorem, between two points on either side of opaque values: the witness is
    /// opaque up to the rounding of its value.
    bool crossing = false;
};

struct CertifiedOracle {
    Certainty certainty = Certainty::None; ///< of the pair: certain if a triangle is, none if all are
    std::vector<JudgedTriangle> triangles; ///< of the mesh, in order
};

/// A voxel cell of the image: [i, i+1] in index space along each axis, i from -1 to n-1. The outermost ones are cut by
/// the domain.
struct JudgedCell {
    std::array<std::int64_t, 3> cell{};
    Certainty certainty = Certainty::None;
};

/// The verdicts on a pair, whose view is ignored. Refuses what oracleSurvivors() refuses but for the view, and a
/// resolution that is not positive and finite.
[[nodiscard]] Result<CertifiedOracle> certifiedOracle(const OraclePair& pair, double resolution = kOracleResolution);

/// How much a cell is enlarged before it is said that a triangle has no opaque point in it, voxels to each side, unless
/// told otherwise.
inline constexpr double kCellMargin = 0x1p-9;

/// The cells in which a triangle certainly has an opaque point, and those that are undecided, x fastest. In all other
/// cells it has none, not even in the cell enlarged by `margin`. A point in a face between cells is in neither
/// beyond doubt. Refuses what certifiedOracle() refuses, a triangle that the mesh does not have and a margin that is
/// not within 0 to 1.
[[nodiscard]] Result<std::vector<JudgedCell>> certifiedCells(const OraclePair& pair, std::uint32_t triangle,
                                                             double margin = kCellMargin);

} // namespace voxtact::oracle

// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/oracle_scenes.h"

#include <cstdint>
#include <vector>

namespace voxtact::test {

/// What the triangles of a random case are like.
enum class CaseKind : std::uint32_t {
    Plain,      ///< a tenth of a voxel to some voxels
    Sliver,     ///< down to a millionth of a voxel wide
    Plate,      ///< in planes of voxel centres and of voxel faces
    DomainFace, ///< in the faces of the domain: in or out is a matter of the last bit
    SubVoxel,   ///< a thousandth of a voxel
    Huge,       ///< a hundred to a thousand voxels
    FarAway,
    Degenerate, ///< points and segments
};
inline constexpr std::size_t kCaseKinds = 8;
[[nodiscard]] const char* toString(CaseKind kind) noexcept;

/// A small volume and 1 to 12 triangles, as data; the scene's view is of no use.
struct CertifiedCase {
    OracleScene scene;
    CaseKind kind = CaseKind::Plain;
    bool onset = false;     ///< placed within a voxel of where contact begins
    bool farOrigin = false; ///< the object's origin is hundreds or thousands of millimetres away
    std::vector<float> table;
};

/// The same case for the same numbers.
[[nodiscard]] CertifiedCase makeCertifiedCase(std::uint64_t seed, std::uint64_t number);

/// Float voxels, one of each 8^3 of which is the outlier, and ten triangles that stay two voxels from all of these, or,
/// where they may be `near`, do not. The same case for the same numbers, but for the outlier.
[[nodiscard]] CertifiedCase outlierCase(std::uint64_t seed, double outlier, bool near);

/// By the control points; the greatest at a step.
[[nodiscard]] double opacityOfValue(const std::vector<ControlPoint>& points, double value);
/// At a place in texture space, in a few lines of double precision that share nothing with the certified oracle. Minus
/// one outside the domain.
[[nodiscard]] double opacityOf(const CertifiedCase& c, const Vec3& texture);
/// Fills the table from the scene's transfer function, which opacityOf() needs.
[[nodiscard]] CertifiedCase withTable(OracleScene scene);

} // namespace voxtact::test

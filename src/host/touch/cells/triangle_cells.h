// SPDX-License-Identifier: MIT
#pragma once

#include "exact/certified_overlap.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// The axes of TriangleCells: normals whose components' magnitudes add up to 1, so that half of a cell's shadow on one
/// is 1/2 long. An edge that is nearly parallel to an axis of the cells has a shorter one with it, or none: it
/// separates nothing that its neighbours do not.
struct TriangleAxes {
    static constexpr std::size_t kCount = 16; ///< zero for padding
    static constexpr std::size_t kNormal = 0; ///< is the triangle's
    static constexpr std::size_t kUsed = 13;
    using Numbers = std::array<float, kCount>;

    Numbers x{};
    Numbers y{};
    Numbers z{};
    Numbers lo{}; ///< the triangle's projection, enlarged by half of a cell's on either side
    Numbers hi{};
    float margin = 0; ///< voxels: by how much a cell is made smaller and larger on each side
    float slack = 0;  ///< voxels along the triangle's normal, which rounding may have turned
};

/// Finds the cells that a triangle passes through, many at a time, without cutting it: a triangle meets a box if no
/// separating axis exists among those of the box, the triangle's normal, and the nine perpendicular to an edge of each
/// (Akenine-Moeller, "Fast 3D triangle-box overlap testing", 2001). Tests a box slightly smaller than the cell, and a
/// larger one; certifiedClip() decides the cells in between.
class TriangleCells {
  public:
    /// Cells of a side of a cube.
    static constexpr std::uint32_t kSide = 4;
    /// A bit for each cell of a cube: x + kSide (y + kSide z).
    using Bits = std::uint64_t;
    /// Voxels: triangles that may be displaced farther are not tested.
    static constexpr float kMostDelta = CERTIFIED_OVERLAP_DELTA;

    struct Overlap {
        Bits some = 0; ///< of a cell in the domain, certifiedClip() leaves something of the triangle
        Bits none = 0; ///< it leaves nothing
    };

    /// Returns true if a triangle can be tested.
    [[nodiscard]] static bool mayBeAsked(const shader::CertifiedTriangle& triangle) noexcept {
        return shader::certifiedOverlapMayBeAsked(triangle);
    }
    /// Expects a supported triangle.
    explicit TriangleCells(const shader::CertifiedTriangle& triangle) noexcept;

    /// Tests some cells of the cube from `first` on. Expects cells that the triangle's box meets, or at most two cubes
    /// beside them.
    [[nodiscard]] Overlap of(Bits cells, const std::array<std::int32_t, 3>& first) const noexcept;

  private:
    shader::VoxelPoint corner_; ///< all else is measured from here
    TriangleAxes axes_;
};

} // namespace voxtact::cpu

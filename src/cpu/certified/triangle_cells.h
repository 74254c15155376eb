// SPDX-License-Identifier: MIT
#pragma once

#include "certified_overlap.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// The axes of TriangleCells: normals whose components' magnitudes add up to 1, so that half of a cell's shadow on one
/// is 1/2 long. An edge that is nearly parallel to an axis of the cells has a shorter one with it, or none: it
/// separates nothing that its neighbours do not.
struct TriangleAxes {
    static constexpr std::size_t kCount = 16; ///< some are nothing, to make them as many
    static constexpr std::size_t kAlong = 7;  ///< of them are not at right angles to a row
    static constexpr std::size_t kNormal = 7; ///< is the triangle's
    static constexpr std::size_t kStill = 8;  ///< and on: those at right angles, the same for all of a row
    using Numbers = std::array<float, kCount>;

    Numbers x{};
    Numbers y{};
    Numbers z{};
    Numbers lo{}; ///< the triangle's shadow, and half of a cell's on either side
    Numbers hi{};
    float slack = 0; ///< voxels along the triangle's normal, which rounding may have turned
};

/// Which cells a triangle passes through, eight of a row at a time, as far as that is clear without cutting the
/// triangle: it meets a box where no axis separates them, of those of the box, the triangle's normal, and the nine at
/// right angles to an edge of either (Akenine-Moeller, "Fast 3D triangle-box overlap testing", 2001). They are asked of
/// a box somewhat smaller than the cell, and of a larger one; for what is between, there is certifiedClip().
class TriangleCells {
  public:
    /// Cells of a row.
    static constexpr std::size_t kRow = 8;
    /// Voxels: by how much a cell is made smaller and larger on each side.
    static constexpr float kMargin = CERTIFIED_OVERLAP_MARGIN;
    /// Voxels: nothing is said of triangles that may be displaced farther.
    static constexpr float kMostDelta = CERTIFIED_OVERLAP_DELTA;

    /// A bit for each cell of a row.
    struct Row {
        unsigned some = 0; ///< of a cell in the domain, certifiedClip() leaves something of the triangle
        unsigned none = 0; ///< it leaves nothing
    };

    /// Whether something is said of a triangle: nothing of large ones, either.
    [[nodiscard]] static bool mayBeAsked(const shader::CertifiedTriangle& triangle) noexcept {
        return shader::certifiedOverlapMayBeAsked(triangle);
    }
    /// Expects one that may be asked.
    explicit TriangleCells(const shader::CertifiedTriangle& triangle) noexcept;

    /// Of the cells from (x, y, z) on, along x. Expects cells that the triangle's box meets, or beside these by no more
    /// than a row.
    [[nodiscard]] Row row(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept;

  private:
    shader::VoxelPoint corner_; ///< all else is measured from here
    TriangleAxes axes_;
};

} // namespace voxtact::cpu

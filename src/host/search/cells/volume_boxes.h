// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/found.h"
#include "host/search/label_part.h"
#include "host/search/opaque_part.h"
#include "host/search/sweep.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace voxtact::cpu {

/// 2^shift padded cells per side.
struct CellCube {
    NodePlace node{}; ///< times 2^shift cells: its first padded cell
    std::uint8_t shift = 0;
};

/// A box in centred voxel coordinates, with the bricks and smaller boxes that contain its cells that may be opaque.
struct OpaqueBox {
    glm::dvec3 lo{};
    glm::dvec3 hi{};
    const BrickCells* known = nullptr;
    CellBox cells;       ///< of `known`
    glm::dvec3 corner{}; ///< of the brick's first cell

    [[nodiscard]] glm::dvec3 middle() const noexcept { return 0.5 * (lo + hi); }
};

/// The boxes of a volume in a search, with lower bounds of the distance of their opaque points. For one thread.
class VolumeBoxes {
  public:
    /// `searched`: the searched region; `error`: of the distances. All must live until the next call.
    void begin(const VolumeImpl& volume, const OpaquePart& part, const SearchedPart& searched,
               const DistanceError& error) noexcept;

    /// Returns the part of a cube in the volume; false outside it, and without opaque cells.
    [[nodiscard]] bool whole(const CellCube& cube, OpaqueBox& box) const;
    /// The part of a cube, of a brick or less, that may hold opaque cells; false where there is none.
    [[nodiscard]] bool narrow(const CellCube& cube, OpaqueBox& box) const;
    /// Returns the part of a cube that may be opaque; false if there is none.
    [[nodiscard]] bool opaque(const CellCube& cube, OpaqueBox& box) const {
        return whole(cube, box) && (cube.shift > kBrickShift || narrow(cube, box));
    }

    /// Returns the minimum dot product of an opaque point with a normal.
    [[nodiscard]] double least(const OpaqueBox& box, const glm::dvec3& normal) const;
    /// Returns the distance from a box of centred voxel coordinates.
    [[nodiscard]] double gap(const OpaqueBox& box, const glm::dvec3& lo, const glm::dvec3& hi) const {
        const glm::dvec3 off = glm::max(glm::max(box.lo - hi, lo - box.hi), glm::dvec3(0));
        return error_.below(glm::length(off * part_->space.spacing));
    }
    /// Returns the distance along a direction; `reach`: maximum of the mesh along it.
    [[nodiscard]] double apart(const OpaqueBox& box, const Direction& along, double reach) const;
    /// Like apart(), for the whole box; faster.
    [[nodiscard]] double wholeApart(const OpaqueBox& box, const Direction& along, double reach) const;

  private:
    void set(const NodePlace& first, const NodePlace& last, OpaqueBox& box) const;

    const VolumeImpl* volume_ = nullptr;
    const OpaquePart* part_ = nullptr;
    const SearchedPart* searched_ = nullptr;
    DistanceError error_;
};

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/volume_cells.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// The fragments of a triangle whose first place is too uncertain for them: it is placed precisely. One thread's.
template <class Kept> class PreciseFragments {
  public:
    /// Verdict on a fragment.
    struct Found {
        int verdict = CERTIFIED_UNDECIDED;
        shader::CertifiedCorners corners; ///< with which it was found
        shader::CertifiedWitness witness; ///< if it is certain
    };

    /// Both must outlive it.
    PreciseFragments(const CertifiedJob& job, const VolumeCells<Kept>& cells)
        : job_(job), cells_(cells), item_(job.occupancy.item()), opaque_(job.occupancy.opaque()) {}

    /// Places a triangle of the mesh; `vertices` are its numbers in the mesh's arrays.
    void begin(std::uint32_t triangle, const std::array<std::size_t, 3>& vertices) {
        if (triangle == number_) {
            return;
        }
        const auto vertex = [&](std::size_t i) {
            return shader::VoxelPoint{job_.mesh.x[vertices[i]], job_.mesh.y[vertices[i]], job_.mesh.z[vertices[i]]};
        };
        triangle_ = shader::preciseTriangle(job_.transform, item_, vertex(0), vertex(1), vertex(2));
        number_ = triangle;
    }
    /// False: no verdict is possible.
    [[nodiscard]] bool known() const { return shader::preciseKnown(triangle_); }
    /// Expects one that is known.
    [[nodiscard]] bool outside() const { return triangle_.outside; }
    [[nodiscard]] shader::PrecisePlane plane() const { return shader::precisePlane(item_, triangle_); }

    /// Decides the fragment in the cell (x, y, z): precisely, with the range of the cell's own voxels, and with the
    /// part that is certainly in the domain.
    [[nodiscard]] Found decide(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& brick) const {
        Found found;
        found.corners = cells_.corners(x, y, z, brick);
        shader::CertifiedCell cell = shader::preciseCell(item_, triangle_, found.corners, x, y, z);
        for (int attempt = 1; found.verdict == CERTIFIED_UNDECIDED && attempt <= 3; ++attempt) {
            const bool within = attempt == 3;
            if (attempt == 2) {
                found.corners = cells_.cornersAround(x, y, z, brick);
                cell = shader::preciseCell(item_, triangle_, found.corners, x, y, z);
            } else if (within && !shader::preciseCrosses(cell)) {
                break;
            } else if (within) {
                cell = shader::preciseWithin(cell);
            }
            found.verdict = settle(cell, x, y, z, within, found.witness);
            // The part that is certainly in the domain has no opaque point, but other parts may.
            found.verdict = within && found.verdict == CERTIFIED_NONE ? CERTIFIED_UNDECIDED : found.verdict;
        }
        return found;
    }

    /// The verdict in a cell that may have an opaque point.
    [[nodiscard]] int verdict(const std::array<std::int32_t, 3>& cell) const {
        if (!known()) {
            return CERTIFIED_UNDECIDED;
        }
        return outside() ? CERTIFIED_NONE : decide(cell[0], cell[1], cell[2], cells_.ofCell(cell)).verdict;
    }

  private:
    int settle(const shader::CertifiedCell& cell, std::int32_t x, std::int32_t y, std::int32_t z, bool within,
               shader::CertifiedWitness& witness) const {
        shader::VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        const int count = shader::certifiedBeginAgain(triangle_, cell, x, y, z, within, polygon);
        return shader::certifiedSettle(opaque_, shader::certifiedFinest(item_), cell, polygon, count, witness);
    }

    const CertifiedJob& job_;
    const VolumeCells<Kept>& cells_;
    shader::CertifiedItem item_;
    shader::OpaqueValues opaque_;
    shader::PreciseTriangle triangle_{}; ///< of number `number_`
    std::uint32_t number_ = kNoTriangle;
};

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/volume_cells.h"
#include "host/touch/fragment_filter.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// Counts fragments in partly opaque cells: most in batches, the others one by one. Not thread-safe.
template <class Kept> class PartCounter {
    using Place = std::array<std::int32_t, 3>;
    using VoxelPoint = shader::VoxelPoint;

  public:
    struct Triangle {
        std::array<VoxelPoint, 3> corners{}; ///< finite
        float delta = 0;
        std::uint32_t number = 0;              ///< in the mesh
        std::array<std::size_t, 3> vertices{}; ///< in the mesh's arrays
    };

    /// Both must outlive it.
    PartCounter(const CertifiedJob& job, const VolumeCells<Kept>& cells)
        : cells_(cells), item_(job.occupancy.item()), opaque_(job.occupancy.opaque()) {}

    [[nodiscard]] bool full() const { return filter_.full(); }
    /// Adds a fragment; expects room. `passes`: certifiedClip() certainly leaves a part of it.
    void add(const Triangle& triangle, const Place& cell, const BrickCells& known, bool passes) {
        const auto corners = cells_.corners(cell[0], cell[1], cell[2], known);
        waiting_[filter_.count()] = {triangle, cell, corners};
        filter_.add({triangle.corners, triangle.delta, cell, corners, passes});
    }
    /// Counts those that were added since the last time. Calls `again(triangle, cell)` for those that the first place
    /// of their triangles leaves undecided: the verdict when they are placed precisely.
    template <class Again> [[nodiscard]] CertifiedTally count(const Again& again) {
        const std::size_t count = filter_.count();
        filter_.test(item_, opaque_.bounds);
        CertifiedTally tally;
        for (std::size_t i = 0; i < count; ++i) {
            const int verdict = filter_.isNone(i)      ? CERTIFIED_NONE
                                : filter_.isCertain(i) ? CERTIFIED_CERTAIN
                                                       : decide(waiting_[i], again);
            tally.certain += verdict == CERTIFIED_CERTAIN ? 1 : 0;
            tally.undecided = tally.undecided || verdict == CERTIFIED_UNDECIDED;
        }
        return tally;
    }

  private:
    struct Waiting {
        Triangle triangle;
        Place cell{};
        shader::CertifiedCorners corners;
    };

    template <class Again> int decide(const Waiting& fragment, const Again& again) const {
        const auto& [a, b, c] = fragment.triangle.corners;
        shader::CertifiedTriangle triangle{}; // input of certifiedBegin()
        triangle.corner0 = a;
        triangle.corner1 = b;
        triangle.corner2 = c;
        triangle.delta = fragment.triangle.delta;
        const auto [x, y, z] = fragment.cell;
        const shader::CertifiedCell cell = shader::certifiedCell(item_, fragment.corners, x, y, z, triangle.delta);
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        const int count = shader::certifiedBegin(opaque_, triangle, cell, x, y, z, polygon);
        if (someProves(cell, polygon, count)) {
            return CERTIFIED_CERTAIN;
        }
        shader::CertifiedWitness witness{};
        const int verdict = shader::certifiedSettle(opaque_, item_.resolution, cell, polygon, count, witness);
        return verdict == CERTIFIED_UNDECIDED ? again(fragment.triangle, fragment.cell) : verdict;
    }

    /// Returns true if a corner proves a touch, as certifiedSettle() would find, because it tests all corners before it
    /// fails.
    bool someProves(const shader::CertifiedCell& cell, const VoxelPoint* polygon, int count) const {
        for (int i = 0; i < count; ++i) {
            const VoxelPoint& at = polygon[i];
            if (shader::certifiedPointProves(opaque_, cell, at, shader::certifiedInterpolate(cell, at.x, at.y, at.z))) {
                return true;
            }
        }
        return false;
    }

    const VolumeCells<Kept>& cells_;
    shader::CertifiedItem item_;
    shader::OpaqueValues opaque_;
    FragmentFilter filter_;
    std::array<Waiting, FragmentFilter::kMost> waiting_;
};

} // namespace voxtact::cpu

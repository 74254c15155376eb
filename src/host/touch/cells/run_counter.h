// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/fine_run.h"
#include "host/touch/certified_pair.h"
#include "host/touch/placed_vertices.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// Counts the fragments of a run's small triangles that need no cutting: a cell that is entirely opaque
/// (CertifiedBricks::allOpaqueAt()) gives a certain fragment, a cell that the triangle does not pass through gives
/// none. Not thread-safe.
class RunCounter {
  public:
    /// Cells of a small triangle that are still to be decided.
    struct Left {
        unsigned cells = 0;
        unsigned passed = 0; ///< cells that it passes through (FineRun::Overlap)
    };

    /// The job must outlive it.
    explicit RunCounter(const CertifiedJob& job) noexcept : job_(job), blocks_(job.volume, job.occupancy) {}

    /// Returns how many are certain. Calls `proves(vertex)` for vertices in cells that are opaque in part: whether it
    /// proves a touch; `large(at)` for those triangles of the run that are to be counted by themselves, `at` being
    /// their numbers in the mesh's arrays; and `open(at, small, left)` for those that have cells which are still to be
    /// decided, in the block of `small`.
    template <class Proves, class Large, class Open>
    [[nodiscard]] std::uint64_t count(PlacedVertices& placed, std::uint32_t run, const Proves& proves,
                                      const Large& large, const Open& open) {
        const std::size_t first = placed.begin(run);
        const std::size_t triangles = add(placed, first);
        small_.test(job_.occupancy.item(), job_.occupancy.bricks());
        std::uint64_t certain = 0;
        for (std::size_t i = 0; i < triangles; ++i) {
            left_[i] = {};
            if (small_.isSmall(i)) {
                certain += countCorners(first + i, i, proves);
            } else {
                large(first + i);
            }
        }
        small_.answer();
        for (std::size_t i = 0; i < triangles; ++i) {
            if (left_[i].mayBeOpaque == 0) {
                continue;
            }
            certain += countOverlap(i);
            if (const unsigned cells = left_[i].mayBeOpaque; cells != 0) {
                open(first + i, small_[i], Left{cells, cells & small_.overlap(i).some});
            }
        }
        return certain;
    }

  private:
    std::size_t add(const PlacedVertices& placed, std::size_t first) {
        const MeshImpl& mesh = job_.mesh;
        std::size_t count = 0;
        for (std::size_t at = first; count < kRunTriangles && mesh.numbers[at] != kNoTriangle; ++at, ++count) {
            small_.add(placed.at(mesh.corner0[at]), placed.at(mesh.corner1[at]), placed.at(mesh.corner2[at]));
        }
        return count;
    }

    /// Counts the cells with one of its corners; queues queries about the others.
    template <class Proves> unsigned countCorners(std::size_t at, std::size_t i, const Proves& proves) {
        const FineRun::Small small = small_[i];
        if (small.block.cells == 0) {
            return 0;
        }
        const BlockBits known = blocks_.at(small.block);
        unsigned counted = known.allOpaque & small.corners();
        const std::array<std::size_t, 3> vertices{job_.mesh.corner0[at], job_.mesh.corner1[at], job_.mesh.corner2[at]};
        for (std::size_t corner = 0; corner < vertices.size(); ++corner) {
            const unsigned cell = small.corner[corner] & known.mayBeOpaque & ~counted;
            counted |= cell != 0 && proves(vertices[corner]) ? cell : 0;
        }
        left_[i] = {known.mayBeOpaque & ~counted, known.allOpaque & ~counted};
        small_.ask(i, left_[i].mayBeOpaque);
        return bitsIn(counted);
    }

    unsigned countOverlap(std::size_t i) {
        const FineRun::Overlap& overlap = small_.overlap(i);
        const unsigned counted = overlap.some & left_[i].allOpaque;
        left_[i].mayBeOpaque &= ~(counted | overlap.none);
        return bitsIn(counted);
    }

    const CertifiedJob& job_;
    BlockLookup blocks_;
    FineRun small_;
    std::array<BlockBits, kRunTriangles> left_{}; ///< of each triangle, the cells that are still to be decided
};

} // namespace voxtact::cpu

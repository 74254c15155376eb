// SPDX-License-Identifier: MIT
#include "host/overlap/inside_point.h"
#include "core/geometry/glm_bridge.h"
#include "host/overlap/solid_triangles.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

class InsideSearch {
  public:
    InsideSearch(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface, MeshPlace& mesh,
                 CancelFlag cancel)
        : volume_(volume), part_(part), surface_(surface), mesh_(mesh), cancel_(cancel),
          off_(2 * (surface.reach() + surface.rounding())) {}

    std::optional<Vec3> run() {
        std::vector<NodePlace> crossed; // later: most of their opaque points may be outside
        surface_.walk(
            [&](const CrossedRow& row, std::uint32_t number, std::uint32_t, Jump) {
                crossed.push_back({surface_.cells()[number].x, row.y, row.z});
            },
            [&](const CrossedRow& row, std::int32_t first, std::int32_t last, Jump) {
                for (std::int32_t x = first; x <= last && goesOn(); ++x) {
                    visit({x, row.y, row.z});
                }
            });
        for (std::size_t i = 0; i < crossed.size() && goesOn(); ++i) {
            visit(crossed[i]);
        }
        return found_;
    }

  private:
    static constexpr std::size_t kMaxRejected = 4096;

    [[nodiscard]] bool goesOn() const { return !found_ && rejected_ < kMaxRejected && !isCancelled(cancel_); }

    /// Tries the middle and the edges. Each opaque component of a cell has a point on an edge: the interpolant is
    /// harmonic in the cell and on its faces, so neither has a component of values between two limits apart from its
    /// border. A surface without opaque points divides no component.
    void visit(const NodePlace& number) {
        if (part_.kind(volume_, number) == OverlapPart::Kind::Clear) {
            return;
        }
        const PartCell cell = part_.part.cell(volume_, number);
        const std::array<dvec3, 2> ends{cell.domain - cell.half, cell.domain + cell.half};
        tryAt(cell, cell.domain);
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3;
            const int last = (axis + 2) % 3;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                dvec3 from = ends[0];
                from[next] = ends[corner & 1U][next];
                from[last] = ends[corner >> 1U][last];
                dvec3 to = from;
                to[axis] = ends[1][axis];
                tryAlong(cell, from, to);
            }
        }
    }

    /// The value is linear along an edge.
    void tryAlong(const PartCell& cell, const dvec3& from, const dvec3& to) {
        const double first = valueAt(cell.terms, from);
        const double last = valueAt(cell.terms, to);
        const auto [lo, hi] = std::minmax({first, last});
        for (const ValueRange& opaque : part_.part.intervals.between(lo, hi).inner) {
            const double wanted = 0.5 * (std::max(opaque.lo, lo) + std::min(opaque.hi, hi));
            tryAt(cell, from + (lo < hi ? (wanted - first) / (last - first) : 0.5) * (to - from));
        }
    }

    void tryAt(const PartCell& cell, const dvec3& at) {
        const double value = valueAt(cell.terms, at);
        if (!goesOn() || !part_.part.intervals.contain(value - cell.error, value + cell.error)) {
            return;
        }
        const dvec3 voxel = cell.middle + 0.5 * at;
        if (isInside(voxel)) {
            const VolumeSpace& space = part_.part.space;
            found_ = fromGlm(space.toWorld(voxel) + space.middle);
        } else {
            ++rejected_;
        }
    }

    [[nodiscard]] bool isInside(const dvec3& voxel) {
        for (const auto& ray : kRays) {
            if (const std::optional<int> winding = windingAlong(voxel, {ray[0], ray[1], ray[2]})) {
                return *winding != 0;
            }
        }
        return false;
    }

    /// Returns the winding number at a point, by a ray; empty if the surface may contain the point or the ray may meet
    /// an edge.
    [[nodiscard]] std::optional<int> windingAlong(const dvec3& voxel, const dvec3& direction) {
        const VolumeSpace& space = part_.part.space;
        int winding = 0;
        bool isKnown = true;
        mesh_.mesh().tree.descend(
            0, static_cast<std::uint32_t>(mesh_.mesh().clusters.size()),
            [&](const RunBox& box) {
                SolidBox around;
                mesh_.voxelBounds(box, around.lo, around.hi);
                return mayMeet(voxel, direction, {around.lo - off_, around.hi + off_});
            },
            [&](std::uint32_t run) {
                const std::uint32_t first = run % ClusterTree::kRunsOfCluster * kRunTriangles;
                const PlacedCluster& placed = mesh_.cluster(run / ClusterTree::kRunsOfCluster);
                for (std::uint32_t i = 0; i < mesh_.count(run) && isKnown; ++i) {
                    std::array<dvec3, 3> corners = placed.triangle(first + i).corners;
                    for (dvec3& corner : corners) {
                        corner = space.toVoxel(corner) - voxel;
                    }
                    const Crossing crossing = crossingOf(corners, direction, off_);
                    winding += crossing == Crossing::Leaves ? 1 : (crossing == Crossing::Enters ? -1 : 0);
                    isKnown = crossing != Crossing::Unknown;
                }
                return isKnown;
            });
        return isKnown ? std::optional(winding) : std::nullopt;
    }

    const VolumeImpl& volume_;
    const OverlapPart& part_;
    const PairSurface& surface_;
    MeshPlace& mesh_;
    CancelFlag cancel_;
    double off_; ///< voxels: no corner is off by more
    std::size_t rejected_ = 0;
    std::optional<Vec3> found_;
};

} // namespace

std::optional<Vec3> opaquePointInside(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface,
                                      MeshPlace& mesh, CancelFlag cancel) {
    return InsideSearch(volume, part, surface, mesh, cancel).run();
}

} // namespace voxtact::cpu

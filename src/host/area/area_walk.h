// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/cell_part.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::cpu {

/// Cuts triangles at the faces of cells, and skips transparent regions. For one thread.
class AreaWalk {
  public:
    /// All must outlive it. `cellByCell`: also visits the cells of entirely opaque bricks.
    AreaWalk(const VolumeImpl& volume, const OpaquePart& part, const AreaSlack& slack, const PartMeasure& measure,
             bool cellByCell)
        : volume_(volume), part_(part), slack_(slack), measure_(measure), cellByCell_(cellByCell) {}

    /// Returns true if the triangles in a box of centred voxel coordinates may have an opaque point.
    [[nodiscard]] bool mayTouch(const glm::dvec3& lo, const glm::dvec3& hi) const {
        const CellBox all = everywhere();
        for (int axis = 0; axis < 3; ++axis) {
            const double doubt = slack_.cut(axis);
            if (!(hi[axis] >= -part_.space.reach[axis] - doubt && lo[axis] <= part_.space.reach[axis] + doubt)) {
                return false;
            }
        }
        return mayBeOpaque(cellsOf(lo, hi, all));
    }

    /// Calls `part(CellPart)` for the parts of a triangle in cells that may contain opaque points, and
    /// `opaque(polygon)` for completely opaque parts. Stops when `goesOn()` is false.
    template <class GoesOn, class Part, class Opaque>
    void triangle(const AreaFrame& frame, std::uint32_t number, const GoesOn& goesOn, const Part& part,
                  const Opaque& opaque) const {
        const Walk<GoesOn, Part, Opaque> walk{*this, frame, number, goesOn, part, opaque};
        if (isInside(AreaBox(frame, UvPolygon::whole()))) {
            walk.divide(UvPolygon::whole(), everywhere(), false);
        } else {
            walk.cutAtVolume(UvPolygon::whole(), 0, false);
        }
    }

  private:
    template <class GoesOn, class Part, class Opaque> struct Walk {
        const AreaWalk& walk;
        const AreaFrame& frame;
        std::uint32_t number;
        const GoesOn& goesOn;
        const Part& part;
        const Opaque& opaque;

        /// Cuts off the part beyond the volume, along the axes from `axis` on.
        void cutAtVolume(const UvPolygon& polygon, int axis, bool atEdge) const {
            if (polygon.empty()) {
                return;
            }
            if (axis == 3) {
                divide(polygon, walk.everywhere(), atEdge);
                return;
            }
            const double reach = walk.part_.space.reach[axis];
            const double doubt = walk.slack_.doubt(axis);
            // Outside, in doubt, inside, in doubt, outside.
            const Halves first = cut(polygon, axis, -reach - doubt);
            const Halves second = cut(first.above, axis, -reach + doubt);
            const Halves third = cut(second.above, axis, reach - doubt);
            const Halves fourth = cut(third.above, axis, reach + doubt);
            const bool unsure = atEdge || !(first.sure && second.sure && third.sure && fourth.sure);
            cutAtVolume(second.below, axis + 1, true);
            cutAtVolume(third.below, axis + 1, unsure);
            cutAtVolume(fourth.below, axis + 1, true);
        }

        /// `cells` are around the polygon.
        void divide(const UvPolygon& polygon, const CellBox& cells, bool atEdge) const {
            if (polygon.empty() || !goesOn()) {
                return;
            }
            const AreaBox box(frame, polygon);
            const CellBox left = walk.cellsOf(box.lo, box.hi, cells);
            if (!walk.mayBeOpaque(left)) {
                return;
            }
            const BrickBox bricks = left.bricks();
            if (!walk.cellByCell_ && bricks.lo == bricks.hi && !atEdge && walk.measure_.allOpaque(bricks.lo)) {
                opaque(polygon);
                return;
            }
            if (left.single()) {
                part(CellPart{polygon, number, {left.lo[0] + 1, left.lo[1] + 1, left.lo[2] + 1}, 0, atEdge});
                return;
            }
            const Cut at = cutOf(left);
            const Halves parts = cut(polygon, at.axis, at.cell - walk.part_.space.centre[at.axis]);
            CellBox half = left;
            half.hi[static_cast<std::size_t>(at.axis)] = at.cell - 1;
            divide(parts.below, half, atEdge || !parts.sure);
            half = left;
            half.lo[static_cast<std::size_t>(at.axis)] = at.cell;
            divide(parts.above, half, atEdge || !parts.sure);
        }

        /// Halves of a polygon; uncertain if rounding makes too many corners: either half may then be the whole
        /// polygon.
        struct Halves {
            UvPolygon below;
            UvPolygon above;
            bool sure = true;
        };

        Halves cut(const UvPolygon& polygon, int axis, double at) const {
            Halves halves;
            halves.sure = split(polygon, heightsAlong(frame, polygon, axis, at), walk.slack_.cut(axis), halves.below,
                                halves.above);
            if (!halves.sure) {
                halves.below = halves.above = polygon;
            }
            return halves;
        }
    };

    /// The plane in front of a cell.
    struct Cut {
        int axis = 0;
        std::int32_t cell = 0;
    };

    /// Across the longest side; at the face of a brick where there is one.
    [[nodiscard]] static Cut cutOf(const CellBox& cells) {
        std::size_t axis = 0;
        for (std::size_t other = 1; other < 3; ++other) {
            if (cells.hi[other] - cells.lo[other] > cells.hi[axis] - cells.lo[axis]) {
                axis = other;
            }
        }
        const std::int32_t middle = cells.lo[axis] + (cells.hi[axis] - cells.lo[axis] + 1) / 2;
        const std::int32_t face = (((middle + 1) >> kBrickShift) << kBrickShift) - 1;
        for (const std::int32_t at : {face, face + kBrickSide}) {
            if (at > cells.lo[axis] && at <= cells.hi[axis]) {
                return {static_cast<int>(axis), at};
            }
        }
        return {static_cast<int>(axis), middle};
    }

    /// True if the polygon is certainly in the volume.
    [[nodiscard]] bool isInside(const AreaBox& box) const {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            const double most = part_.space.reach[axis] - slack_.doubt(axis);
            inside = inside && box.lo[axis] >= -most && box.hi[axis] <= most;
        }
        return inside;
    }

    [[nodiscard]] CellBox everywhere() const {
        CellBox cells;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cells.lo[axis] = -1;
            cells.hi[axis] = volume_.image.size[axis] - 1;
        }
        return cells;
    }

    /// The cells of a box of centred voxel coordinates, but none that are not in `within`.
    [[nodiscard]] CellBox cellsOf(const glm::dvec3& lo, const glm::dvec3& hi, const CellBox& within) const {
        CellBox cells;
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            const double first = within.lo[at];
            const double last = within.hi[at];
            cells.lo[at] =
                static_cast<std::int32_t>(std::clamp(std::floor(lo[axis] + part_.space.centre[axis]), first, last));
            cells.hi[at] =
                static_cast<std::int32_t>(std::clamp(std::floor(hi[axis] + part_.space.centre[axis]), first, last));
        }
        return cells;
    }

    /// Returns true if some cells, or cells near enough for a part to reach them, may have an opaque point.
    [[nodiscard]] bool mayBeOpaque(CellBox cells) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cells.lo[axis] = std::max(cells.lo[axis] - 1, -1);
            cells.hi[axis] = std::min(cells.hi[axis] + 1, volume_.image.size[axis] - 1);
        }
        return part_.occupancy.mayBeOpaque(volume_, cells);
    }

    const VolumeImpl& volume_;
    const OpaquePart& part_;
    const AreaSlack& slack_;
    const PartMeasure& measure_;
    bool cellByCell_;
};

} // namespace voxtact::cpu

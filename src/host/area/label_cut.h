// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/cell_part.h"
#include "voxtact/data.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace voxtact::cpu {

/// Labels that areas are measured to.
struct AreaLabels {
    /// Slot of a label that was not requested.
    static constexpr std::uint16_t kNoSlot = 0xffff;

    const LabelData* map = nullptr;       ///< on the volume's grid
    std::span<const std::uint16_t> slots; ///< of LabelData::values: the number of the sum, or kNoSlot
};

/// Cuts the parts of triangles in cells along the boxes of voxels with different labels: a cell overlaps eight of them.
class LabelCut {
  public:
    /// All must outlive it.
    LabelCut(const AreaLabels& labels, const VolumeSpace& space, const AreaSlack& slack)
        : labels_(labels), space_(space), slack_(slack) {}

    /// Calls `visit(part)` for the parts with a slot. A part so near the face of a voxel's box that rounding decides
    /// its side is visited once for each possible slot, with its edge flag set.
    template <class Visit> void cut(const AreaFrame& frame, const CellPart& part, const Visit& visit) const {
        const Octants octants = octantsOf(part.padded);
        if (std::ranges::all_of(octants, [&](std::uint16_t slot) { return slot == octants[0]; })) {
            give(part, part.polygon, octants[0], part.atEdge, visit);
            return;
        }
        cutAlong(frame, part, part.polygon, {}, 0, octants, visit);
    }

  private:
    /// Slots: of the octant that is the upper one along x at 1, y at 2, z at 4.
    using Octants = std::array<std::uint16_t, 8>;
    /// Along each axis: whether a polygon may be in the lower and in the upper half.
    using Halves = std::array<std::array<bool, 2>, 3>;

    template <class Visit>
    static void give(const CellPart& part, const UvPolygon& polygon, std::uint16_t slot, bool atEdge,
                     const Visit& visit) {
        if (slot != AreaLabels::kNoSlot) {
            CellPart own = part;
            own.polygon = polygon;
            own.slot = slot;
            own.atEdge = atEdge;
            visit(own);
        }
    }

    template <class Visit>
    void cutAlong(const AreaFrame& frame, const CellPart& part, const UvPolygon& polygon, Halves halves,
                  std::size_t axis, const Octants& octants, const Visit& visit) const {
        if (polygon.empty()) {
            return;
        }
        if (axis == 3) {
            giveHalves(part, polygon, halves, octants, visit);
            return;
        }
        const int along = static_cast<int>(axis);
        const double middle = part.padded[axis] - 0.5 - space_.centre[along];
        const double doubt = slack_.doubt(along);
        UvPolygon below;
        UvPolygon above;
        UvPolygon between;
        UvPolygon upper;
        if (!split(polygon, heightsAlong(frame, polygon, along, middle - doubt), slack_.cut(along), below, above) ||
            !split(above, heightsAlong(frame, above, along, middle + doubt), slack_.cut(along), between, upper)) {
            below = upper = {}; // no room for corners, which is rounding's, too
            between = polygon;
        }
        halves[axis] = {true, false};
        cutAlong(frame, part, below, halves, axis + 1, octants, visit);
        halves[axis] = {true, true};
        cutAlong(frame, part, between, halves, axis + 1, octants, visit);
        halves[axis] = {false, true};
        cutAlong(frame, part, upper, halves, axis + 1, octants, visit);
    }

    template <class Visit>
    static void giveHalves(const CellPart& part, const UvPolygon& polygon, const Halves& halves, const Octants& octants,
                           const Visit& visit) {
        std::array<std::uint16_t, 8> slots{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 8; ++i) {
            const bool in = halves[0][i & 1U] && halves[1][i >> 1U & 1U] && halves[2][i >> 2U & 1U];
            if (in && std::find(slots.begin(), slots.begin() + count, octants[i]) == slots.begin() + count) {
                slots[count++] = octants[i];
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            give(part, polygon, slots[i], part.atEdge || count > 1, visit);
        }
    }

    [[nodiscard]] Octants octantsOf(const NodePlace& padded) const {
        const auto& size = labels_.map->grid.size;
        Octants octants{};
        for (std::size_t i = 0; i < 8; ++i) {
            std::array<std::size_t, 3> voxel{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::int32_t at = padded[axis] - ((i >> axis & 1U) != 0 ? 0 : 1);
                voxel[axis] = static_cast<std::size_t>(std::clamp(at, 0, static_cast<std::int32_t>(size[axis]) - 1));
            }
            octants[i] = labels_.slots[labels_.map->indices[(voxel[2] * size[1] + voxel[1]) * size[0] + voxel[0]]];
        }
        return octants;
    }

    const AreaLabels& labels_;
    const VolumeSpace& space_;
    const AreaSlack& slack_;
};

} // namespace voxtact::cpu

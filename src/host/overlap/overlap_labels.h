// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/opaque_part.h"
#include "voxtact/cpu.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// Slots of a cell's octants: of the one that is the upper one along x at 1, y at 2, z at 4.
using SlotOctants = std::array<std::uint16_t, 8>;

/// The requested labels of one map.
struct OverlapLabels {
    /// Slot of a label that is not requested.
    static constexpr std::uint16_t kNoSlot = 0xffff;
    static_assert(kMaxMeasuredLabels < kNoSlot);

    OverlapLabels(const LabelData& of, std::span<const std::int32_t> labels) : map(&of) {
        slots.assign(of.values.size(), kNoSlot);
        for (const std::int32_t label : labels) {
            const auto found = std::ranges::lower_bound(of.values, label);
            if (found == of.values.end() || *found != label) {
                ofAsked.push_back(kNoSlot);
                continue;
            }
            std::uint16_t& slot = slots[static_cast<std::size_t>(found - of.values.begin())];
            if (slot == kNoSlot) {
                slot = static_cast<std::uint16_t>(count++);
            }
            ofAsked.push_back(slot);
        }
    }

    [[nodiscard]] SlotOctants octantsOf(const NodePlace& cell) const noexcept {
        const auto& size = map->grid.size;
        SlotOctants octants{};
        for (std::size_t i = 0; i < 8; ++i) {
            std::array<std::size_t, 3> voxel{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::int32_t at = cell[axis] - ((i >> axis & 1U) != 0 ? 0 : 1);
                voxel[axis] = static_cast<std::size_t>(std::clamp(at, 0, static_cast<std::int32_t>(size[axis]) - 1));
            }
            octants[i] = slots[map->indices[(voxel[2] * size[1] + voxel[1]) * size[0] + voxel[0]]];
        }
        return octants;
    }

    const LabelData* map;               ///< on the volume's grid
    std::vector<std::uint16_t> slots;   ///< of LabelData::values: the number of the sum, or kNoSlot
    std::vector<std::uint16_t> ofAsked; ///< by the requested labels; kNoSlot: no voxel has the label
    std::size_t count = 0;              ///< of sums
};

} // namespace voxtact::cpu

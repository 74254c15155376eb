// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/opaque_part.h"
#include "voxtact/cpu.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxtact::cpu {

/// A box within a cell, in its coordinates from -1 to 1.
struct CellRegion {
    glm::dvec3 lo{};
    glm::dvec3 hi{};
};

/// Where a piece of a cell is: the piece is 2^-depth of the cell's part in the domain a side.
struct PiecePlace {
    NodePlace cell{}; ///< padded number
    std::uint8_t depth = 0;
    std::array<std::uint16_t, 3> piece{}; ///< times 2^-depth
};

/// Some labels of a map.
struct LabelSet {
    BrickPyramid pyramid;           ///< the bricks that may be opaque and have one of them
    std::vector<std::uint8_t> with; ///< by LabelData::values: not zero for those of the set
};

/// What is opaque, all of it or what has one of some labels. Labels are constant in the boxes around voxel centres,
/// which are closed: a cell has eight of them, and a face between two labels belongs to both. Thread-safe.
class SearchedPart {
  public:
    explicit SearchedPart(const OpaquePart& part) : pyramid_(&part.pyramid) {}
    /// `labels` on the volume's grid; all must outlive it.
    SearchedPart(const LabelSet& set, const LabelData& labels)
        : pyramid_(&set.pyramid), labels_(&labels), with_(set.with.data()) {}

    [[nodiscard]] const BrickPyramid& pyramid() const noexcept { return *pyramid_; }
    /// Whether some of a piece belongs to it.
    [[nodiscard]] bool meets(const PiecePlace& place) const noexcept;
    /// Where in the piece's cell points may be looked for that belong to it: the whole cell, or its part in which the
    /// piece is; nothing where that is not all of the same label.
    [[nodiscard]] std::optional<CellRegion> region(const PartCell& cell, const PiecePlace& place) const noexcept;
    /// Calls `visit(region)` for the regions of a cell that belong to it.
    template <class Visit> void forRegions(const PartCell& cell, const NodePlace& padded, const Visit& visit) const {
        if (const std::optional<CellRegion> whole = region(cell, {padded})) {
            visit(*whole);
            return;
        }
        for (std::uint16_t i = 0; i < 8; ++i) {
            const PiecePlace octant{padded,
                                    1,
                                    {static_cast<std::uint16_t>(i & 1U), static_cast<std::uint16_t>(i >> 1U & 1U),
                                     static_cast<std::uint16_t>(i >> 2U & 1U)}};
            const std::optional<CellRegion> part = region(cell, octant);
            if (part && meets(octant)) {
                visit(*part);
            }
        }
    }

  private:
    struct Octants {
        std::array<std::uint32_t, 3> first{};
        std::array<std::uint32_t, 3> last{}; ///< inclusive
    };
    [[nodiscard]] Octants octantsOf(const PiecePlace& place) const noexcept;
    [[nodiscard]] bool has(const NodePlace& padded, const std::array<std::uint32_t, 3>& octant) const noexcept;
    /// Of some octants: how many belong to it, and how many there are.
    [[nodiscard]] std::array<unsigned, 2> count(const NodePlace& padded, const Octants& octants) const noexcept;

    const BrickPyramid* pyramid_;
    const LabelData* labels_ = nullptr; ///< null: all that is opaque
    const std::uint8_t* with_ = nullptr;
};

/// Refuses a label map that is not on a volume's grid, as checkLabelGrid() does. `which` begins the text of a refusal.
[[nodiscard]] Result<void> checkLabelsOnGrid(const LabelData& labels, const Grid& grid, const std::string& which);
/// Refuses too many labels, and items of a checked batch without a label map on the volume's grid.
[[nodiscard]] Result<void> checkMeasuredLabels(const Batch& batch, std::span<const std::int32_t> labels);

/// Sets of a single label each. `indices`: numbers of labels in LabelData::values. The map is on the volume's grid.
[[nodiscard]] std::vector<LabelSet> singleLabels(const OpaquePart& part, const VolumeImpl& volume,
                                                 const LabelData& labels, std::span<const std::uint32_t> indices);
/// The set of all of them.
[[nodiscard]] LabelSet allLabels(const OpaquePart& part, const VolumeImpl& volume, const LabelData& labels,
                                 std::span<const std::uint32_t> indices);

} // namespace voxtact::cpu

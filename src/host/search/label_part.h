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

/// Position of a piece in a cell: its side is 2^-depth of that of the cell's part in the domain.
struct PiecePlace {
    NodePlace cell{}; ///< padded number
    std::uint8_t depth = 0;
    std::array<std::uint16_t, 3> piece{}; ///< times 2^-depth
};

/// Some labels of a map.
struct LabelSet {
    BrickPyramid pyramid;           ///< bricks that may be opaque and have one of the labels
    std::vector<std::uint8_t> with; ///< by LabelData::values: not zero for those of the set
};

/// The searched region: the opaque region, or its part with some labels. Labels are constant in the closed boxes around
/// voxel centres: a cell overlaps eight of them, and a face between two labels belongs to both. Thread-safe.
class SearchedPart {
  public:
    explicit SearchedPart(const OpaquePart& part) : pyramid_(&part.pyramid) {}
    /// `labels` on the volume's grid; all must outlive it.
    SearchedPart(const LabelSet& set, const LabelData& labels)
        : pyramid_(&set.pyramid), labels_(&labels), with_(set.with.data()) {}

    [[nodiscard]] const BrickPyramid& pyramid() const noexcept { return *pyramid_; }
    /// Returns true if a part of a piece belongs to the region.
    [[nodiscard]] bool meets(const PiecePlace& place) const noexcept;
    /// Returns the part of the piece's cell in which to search for points of the region: the whole cell, or the octant
    /// with the piece; empty if its labels differ.
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
    /// Returns the number of octants in the region, and their total number.
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
/// Returns the set of all labels.
[[nodiscard]] LabelSet allLabels(const OpaquePart& part, const VolumeImpl& volume, const LabelData& labels,
                                 std::span<const std::uint32_t> indices);

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/clearance/opaque_part.h"
#include "voxtact/data.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
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

/// What is opaque, all of it or what has one label. Labels are constant in the boxes around voxel centres, which are
/// closed: a cell has eight of them, and a face between two labels belongs to both.
/// Thread-safe.
class SearchedPart {
  public:
    explicit SearchedPart(const OpaquePart& part) : pyramid_(&part.pyramid) {}
    /// `labels` on the volume's grid; all must outlive it. `pyramid`: of the bricks with the label.
    SearchedPart(const BrickPyramid& pyramid, const LabelData& labels, std::uint32_t index)
        : pyramid_(&pyramid), labels_(&labels), index_(index) {}

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
    std::uint32_t index_ = 0;           ///< of the label
};

/// For each of some labels the bricks that may be opaque and have it.
class LabelPyramids {
  public:
    /// `indices`: numbers of labels in LabelData::values. The map is on the volume's grid.
    LabelPyramids(const OpaquePart& part, const VolumeImpl& volume, const LabelData& labels,
                  std::span<const std::uint32_t> indices);

    /// Of the label at this place among `indices`.
    [[nodiscard]] const BrickPyramid& at(std::size_t place) const noexcept { return pyramids_[place]; }

  private:
    std::vector<BrickPyramid> pyramids_;
};

} // namespace voxtact::cpu

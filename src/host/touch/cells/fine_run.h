// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "host/touch/cells/cell_block.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// The triangles of a run. All with at most the cells of a CellBlock, like most triangles of a fine mesh, are tested
/// together. For one thread.
class FineRun {
  public:
    static constexpr std::size_t kMost = kRunTriangles;

    struct Small {
        CellBlock block; ///< the cells of certifiedBounds(); none where it meets nothing of the volume
        /// The cell of each corner, or none: no cutting is needed there.
        std::array<unsigned, 3> corner{};
        float delta = 0; ///< no more than CERTIFIED_OVERLAP_DELTA

        [[nodiscard]] unsigned corners() const noexcept { return corner[0] | corner[1] | corner[2]; }
    };
    /// Same as certifiedOverlap(); neither bit of a cell that it leaves open.
    struct Overlap {
        unsigned some = 0; ///< the cells that the triangle passes through
        unsigned none = 0; ///< those that it does not
    };

    /// The next triangle; expects room.
    void add(const shader::CertifiedVertex& a, const shader::CertifiedVertex& b,
             const shader::CertifiedVertex& c) noexcept;
    /// Tests the triangles added since the last call. `bricks`: number of the volume's bricks along each axis.
    void test(const shader::CertifiedItem& item, const std::array<std::int32_t, 3>& bricks) noexcept;

    /// Returns true if triangle i is small and precise enough for certifiedOverlap().
    [[nodiscard]] bool isSmall(std::size_t i) const noexcept { return triangles_.small[i] != 0; }
    /// Expects one that is.
    [[nodiscard]] Small operator[](std::size_t i) const noexcept {
        const Triangles& of = triangles_;
        return {{{of.first[0][i], of.first[1][i], of.first[2][i]},
                 of.cells[i],
                 of.brick[i],
                 of.row[i],
                 of.column[i],
                 of.oneBrick[i] != 0},
                {of.corner[0][i], of.corner[1][i], of.corner[2][i]},
                of.delta[i]};
    }

    /// Asks which of some cells of its block triangle i passes through; expects one that is small, and each once.
    void ask(std::size_t i, unsigned cells) noexcept;
    /// Answers the queries since the last call.
    void answer() noexcept;
    [[nodiscard]] const Overlap& overlap(std::size_t i) const noexcept { return overlaps_[i]; }

    /// A lane per triangle.
    struct Triangles {
        template <class Number> using Each = std::array<Number, kMost>;

        std::array<std::array<Each<float>, 3>, 3> at{}; ///< by corner and axis
        std::array<Each<float>, 3> error{};             ///< by corner
        Each<std::uint32_t> small{};                    ///< not 0: it is
        std::array<Each<std::int32_t>, 3> first{};
        // index of the CellBlock; `oneBrick`: not 0 if true
        Each<std::uint32_t> cells{};
        Each<std::uint32_t> brick{};
        Each<std::uint32_t> row{};
        Each<std::uint32_t> column{};
        Each<std::uint32_t> oneBrick{};
        std::array<Each<std::uint32_t>, 3> corner{};
        Each<float> delta{};
    };
    /// A lane per cell of a triangle.
    struct Cells {
        template <class Number> using Each = std::array<Number, kMost * CellBlock::kMost>;

        Each<std::int32_t> triangle{};
        Each<std::int32_t> number{}; ///< in its block
        Each<std::uint32_t> some{};  ///< not 0: the triangle passes through it
        Each<std::uint32_t> none{};  ///< not 0: it does not
    };

  private:
    Triangles triangles_;
    std::size_t count_ = 0;
    Cells cells_;
    std::size_t asked_ = 0;
    std::array<Overlap, kMost> overlaps_{};
};

} // namespace voxtact::cpu

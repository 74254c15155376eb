// SPDX-License-Identifier: MIT
#pragma once

#include "host/plan/plan_scene.h"

#include <memory>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// The triangles of the cells of a grid, by rhombus, i, j and which of a cell's two.
class TrianglePlaces {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffU;

    explicit TrianglePlaces(const DirectionGrid& grid)
        : side_(grid.side()), places_(2 * std::size_t{grid.count()}, kNone) {}

    [[nodiscard]] std::uint32_t& at(std::uint32_t rhombus, std::uint32_t i, std::uint32_t j, std::uint32_t which) {
        return places_[((std::size_t{rhombus} * side_ + i) * side_ + j) * 2 + which];
    }
    [[nodiscard]] std::uint32_t at(std::uint32_t rhombus, std::uint32_t i, std::uint32_t j, std::uint32_t which) const {
        return places_[((std::size_t{rhombus} * side_ + i) * side_ + j) * 2 + which];
    }

  private:
    std::uint32_t side_;
    std::vector<std::uint32_t> places_; ///< in PlanAnswer::triangles
};

/// Proves on one thread that all paths in a patch of directions are safe. All positions of the axis in a cone are one
/// sweep, its rotations about the target; if the sweep keeps clear of the obstacles, the paths do. Otherwise the patch
/// is halved.
class PatchCertificate {
  public:
    /// All must live as long as it. `paths` by the numbers of their directions, null where there is none.
    PatchCertificate(const PlanScene& scene, std::span<const PlannedPath* const> paths, const TrianglePlaces& places,
                     ThreadMemory& memory)
        : scene_(scene), paths_(paths), places_(places), memory_(memory) {}

    /// Marks the triangles that are safe, and measures them where the task asks for that.
    void run(const DirectionPatch& patch, std::vector<EntryTriangle>& triangles);

  private:
    /// Start of a search for each obstacle; null: everything.
    using Open = std::vector<std::shared_ptr<const OpenPairs>>;
    struct Contents {
        bool some = false;  ///< there is a triangle whose corners are all safe
        bool all = true;    ///< every path is
        double longest = 0; ///< mm
    };
    [[nodiscard]] Contents contentsOf(const DirectionPatch& patch) const;
    /// Calls `visit(corners, place)` for the triangles of a patch.
    template <class Visit> void forTriangles(const DirectionPatch& patch, const Visit& visit) const;
    [[nodiscard]] bool isApart(const DirectionPatch& patch, double longest, Open& open);
    void certify(const DirectionPatch& patch, Open open, std::vector<EntryTriangle>& triangles);
    /// All positions of the axis in a cone, from entries up to the longest.
    [[nodiscard]] Sweep sweepOf(const DirectionCone& cone) const;
    /// mm: lower bound of the distance of all paths in a cell, up to `most`.
    [[nodiscard]] double clearanceOf(const DirectionPatch& cell, double longest, double most);
    void measure(const DirectionPatch& cell, std::vector<EntryTriangle>& triangles);

    const PlanScene& scene_;
    std::span<const PlannedPath* const> paths_;
    const TrianglePlaces& places_;
    ThreadMemory& memory_;
};

} // namespace voxtact::cpu

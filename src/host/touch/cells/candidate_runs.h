// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/point_hull.h"
#include "host/touch/cells/volume_cells.h"
#include "host/touch/placed_vertices.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// The cells that the triangles of certifiedBounds() may pass through.
inline CellBox cellsOf(const shader::CertifiedBounds& bounds) {
    return {{bounds.firstX, bounds.firstY, bounds.firstZ}, {bounds.lastX, bounds.lastY, bounds.lastZ}};
}

/// Runs of triangles that pass the bounds test, with the cells that they may touch.
template <class Kept> class CandidateRuns {
  public:
    struct Run {
        std::uint32_t number = 0;
        bool isTested = false; ///< false: too large or too imprecise for the test; any cell may touch
        CellSet cells;
        std::size_t firstCell = 0; ///< occupancy of the cells
    };

    /// All must outlive it.
    CandidateRuns(const CertifiedJob& job, const VolumeCells<Kept>& cells, PlacedVertices& placed)
        : mesh_(job.mesh), item_(job.occupancy.item()), opaque_(job.occupancy.opaque()), cells_(cells),
          placed_(placed) {}

    [[nodiscard]] const std::vector<Run>& all() const { return runs_; }

    /// Adds a run if it may touch. `probe(triangle, vertex, delta)` is then called for its vertices, as long as
    /// `goesOn()`; with no vertex where its place is too uncertain.
    template <class GoesOn, class Probe> void test(std::uint32_t number, const GoesOn& goesOn, const Probe& probe) {
        RunPoints points;
        const std::size_t first = placed_.begin(number);
        const RunVertices& vertices = mesh_.runVertices;
        for (std::uint32_t i = vertices.first[number]; i < vertices.first[number + 1]; ++i) {
            points.add(placed_.at(vertices.corner[i]), mesh_.numbers[first + vertices.triangle[i]]);
        }
        const shader::CertifiedBounds bounds = points.bounds(item_);
        const CellBox box = cellsOf(bounds);
        if (box.empty()) {
            return;
        }
        Run run{number, false, {}, known_.size()};
        if (bounds.usable && run.cells.begin(box)) {
            run.isTested = true;
            testCells(points.hull(bounds.delta), box, run);
            if (run.cells.empty()) {
                return;
            }
        }
        runs_.push_back(run);
        for (std::size_t i = 0; bounds.usable && i < points.count() && goesOn(); ++i) {
            probe(points.triangle(i), points.point(i), bounds.delta);
        }
    }

    /// Calls `visit(x, y, z, cell)` for the cells of a box that a tested run may touch, while `goesOn()`; the delta of
    /// `cell` is at least that of the run's triangles. Expects the box of one of these.
    template <class GoesOn, class Visit>
    void forCells(const Run& run, const CellBox& box, const GoesOn& goesOn, const Visit& visit) const {
        run.cells.forEach(box, goesOn, [&](std::int32_t x, std::int32_t y, std::int32_t z, std::size_t number) {
            visit(x, y, z, known_[run.firstCell + number]);
        });
    }

  private:
    void testCells(const PointHull& hull, const CellBox& box, Run& run) {
        const auto always = [] { return true; };
        cells_.forCells(box, always, [&](std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& brick) {
            const shader::CertifiedCell cell = cells_.cell(x, y, z, brick, hull.delta);
            if (hullMayMeet(opaque_, hull, cell, x, y, z)) {
                here_[run.cells.add(x, y, z)] = cell;
            }
        });
        run.cells.forPlaces([&](std::size_t place) { known_.push_back(here_[place]); });
    }

    const MeshImpl& mesh_;
    shader::CertifiedItem item_;
    shader::OpaqueValues opaque_;
    const VolumeCells<Kept>& cells_;
    PlacedVertices& placed_;
    std::vector<Run> runs_;
    std::vector<shader::CertifiedCell> known_; ///< of runs, in the order of their sets
    std::array<shader::CertifiedCell, CellSet::kMost> here_;
};

} // namespace voxtact::cpu

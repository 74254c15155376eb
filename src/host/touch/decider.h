// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "host/touch/cells/box_cells.h"
#include "host/touch/cells/candidate_runs.h"
#include "host/touch/cells/cell_counter.h"
#include "host/touch/cells/run_counter.h"
#include "host/touch/part_counter.h"
#include "host/touch/precise_fragments.h"
#include "host/touch/vertex_proofs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// Decides a job's fragments. `Mode::kCounts`: only their number is needed. A mode is a type local to the file that
/// instantiates this, so that compilers inline it.
template <class Kept, class Mode> class Decider {
    using CertifiedTriangle = shader::CertifiedTriangle;
    using CertifiedVertex = shader::CertifiedVertex;
    using VoxelPoint = shader::VoxelPoint;

  public:
    Decider(const CertifiedJob& job, const Kept* voxels, const CertifiedSink& sink)
        : job_(job), cells_(job, voxels), sink_(sink), item_(job.occupancy.item()), opaque_(job.occupancy.opaque()),
          precise_(job, cells_), placed_(job.mesh, job.transform), boxes_(item_, job.transform, job.mesh.tree) {
        delta_.delta = boxes_.delta();
        delta_.usable = boxes_.usable();
    }
    // Its parts refer to each other.
    Decider(const Decider&) = delete;
    Decider& operator=(const Decider&) = delete;

    CertifiedTally run() {
        if (job_.stopAtFirst) {
            probeAndDecide();
            decideOpen();
        } else {
            descend([this](std::uint32_t run) {
                decideRun(run);
                return !done();
            });
        }
        if constexpr (Mode::kCounts) {
            if (counting_ && !done()) {
                countParts();
            }
        }
        return tally_;
    }

  private:
    struct Triangle {
        std::uint32_t number = 0;
        std::array<std::size_t, 3> vertices{}; ///< in the mesh's arrays
    };
    struct Open {
        Triangle triangle;
        CellBox cells;
    };

    [[nodiscard]] bool done() const { return (job_.stopAtFirst && tally_.certain > 0) || isCancelled(job_.cancel); }

    template <class Visit> void descend(const Visit& visit) {
        job_.mesh.tree.descend(
            job_.clusterBegin, job_.clusterEnd, [this](const RunBox& box) { return mayTouch(box); }, visit);
    }

    /// Testing a vertex is cheaper than deciding a fragment: probes one vertex of every run, then all vertices of the
    /// runs that pass the bounds test, and then decides these runs.
    void probeAndDecide() {
        std::vector<std::uint32_t> runs;
        descend([&](std::uint32_t run) {
            runs.push_back(run);
            if (delta_.usable) {
                const std::size_t first = placed_.firstTriangle(run);
                probe(job_.mesh.numbers[first], placed_.alone(run, first).point, delta_.delta);
            }
            return !done();
        });
        CandidateRuns<Kept> candidates(job_, cells_, placed_);
        const auto goesOn = [this] { return !done(); };
        for (std::size_t i = 0; i < runs.size() && goesOn(); ++i) {
            candidates.test(runs[i], goesOn, [this](std::uint32_t triangle, const VoxelPoint& vertex, float delta) {
                probe(triangle, vertex, delta);
            });
        }
        for (std::size_t i = 0; i < candidates.all().size() && goesOn(); ++i) {
            const auto& run = candidates.all()[i];
            forTriangles(run.number, [&](const auto&... corners) {
                run.isTested ? decideTested(candidates, run, corners...) : decideTriangle(corners...);
            });
        }
    }

    /// Tells the sink, too.
    void probe(std::uint32_t triangle, const VoxelPoint& vertex, float delta) {
        shader::CertifiedProof proof;
        if (cells_.vertexProves(vertex, delta, sink_ ? &proof : nullptr)) {
            tally_.certain = 1;
            if (sink_) {
                sink_(triangle, proof);
            }
        }
    }

    /// Returns true if the triangles in a box of object space may pass through a cell that may have an opaque point.
    /// Sets `delta_`.
    [[nodiscard]] bool mayTouch(const RunBox& box) {
        if (boxes_.usable()) {
            const CellBox cells = boxes_.cells(box);
            return !cells.empty() && job_.occupancy.mayBeOpaque(job_.volume, cells);
        }
        const shader::CertifiedBounds& bounds = delta_ = shader::certifiedBoxBounds(
            item_, job_.transform, {box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]});
        const CellBox cells = cellsOf(bounds);
        if (cells.empty()) {
            return false;
        }
        // A triangle that is not usable is undecided wherever its bricks may have an opaque point.
        return bounds.usable ? job_.occupancy.mayBeOpaque(job_.volume, cells)
                             : job_.occupancy.mayBeOpaque(cells.bricks());
    }

    void decideRun(std::uint32_t run) {
        if constexpr (Mode::kCounts) {
            countRun(run);
        } else {
            forTriangles(run, [this](const auto&... corners) { decideTriangle(corners...); });
        }
    }

    /// Small triangles together, others one by one.
    void countRun(std::uint32_t run) {
        if (!counting_) {
            counting_.emplace(job_, cells_, placed_, opaque_.bounds, boxes_.delta());
        }
        const auto proves = [this](std::size_t vertex) { return boxes_.usable() && counting_->proofs.prove(vertex); };
        const auto large = [this](std::size_t at) {
            withTriangle(at, [this](const auto&... corners) { decideTriangle(corners...); });
        };
        const auto open = [this](std::size_t at, const FineRun::Small& small, const RunCounter::Left& left) {
            withTriangle(at, [&](const auto&... corners) {
                counting_->triangle = {{corners.point...}, small.delta, triangle_.number, triangle_.vertices};
            });
            for (unsigned cells = left.cells; cells != 0; cells &= cells - 1) {
                const auto number = static_cast<unsigned>(std::countr_zero(cells));
                const auto cell = small.block.at(number);
                countLater(cell, cells_.ofCell(cell), (left.passed >> number & 1U) != 0);
            }
        };
        tally_.certain += counting_->run.count(placed_, run, proves, large, open);
    }

    /// A fragment of the triangle that is counted.
    void countLater(const std::array<std::int32_t, 3>& cell, const BrickCells& known, bool passes) {
        if (counting_->parts.full()) {
            countParts();
        }
        counting_->parts.add(counting_->triangle, cell, known, passes);
    }

    void countParts() {
        const CertifiedTally parts =
            counting_->parts.count([this](const auto& triangle, const std::array<std::int32_t, 3>& cell) {
                precise_.begin(triangle.number, triangle.vertices);
                return precise_.verdict(cell);
            });
        tally_.certain += parts.certain;
        tally_.undecided = tally_.undecided || parts.undecided;
    }

    /// Calls `decide(corner, corner, corner)` for a run's triangles, until it is done.
    template <class Decide> void forTriangles(std::uint32_t run, const Decide& decide) {
        const std::size_t first = placed_.begin(run);
        for (std::size_t at = first; at < first + kRunTriangles && !done(); ++at) {
            if (job_.mesh.numbers[at] == kNoTriangle) {
                return;
            }
            withTriangle(at, decide);
        }
    }

    /// Calls `decide(corner, corner, corner)` for one of the placed cluster; `triangle_` is set.
    template <class Decide> void withTriangle(std::size_t at, const Decide& decide) {
        const MeshImpl& mesh = job_.mesh;
        const std::size_t first = placed_.firstVertex();
        triangle_ = {mesh.numbers[at], {first + mesh.corner0[at], first + mesh.corner1[at], first + mesh.corner2[at]}};
        decide(placed_.at(mesh.corner0[at]), placed_.at(mesh.corner1[at]), placed_.at(mesh.corner2[at]));
    }

    /// Decides a triangle of a tested run: only in the remaining cells of the run, and of the triangle.
    void decideTested(const CandidateRuns<Kept>& candidates, const typename CandidateRuns<Kept>::Run& run,
                      const CertifiedVertex& a, const CertifiedVertex& b, const CertifiedVertex& c) {
        const shader::CertifiedBounds bounds = shader::certifiedBounds(item_, a, b, c);
        const CellBox cells = cellsOf(bounds);
        if (cells.empty()) {
            return;
        }
        const TriangleHull hull(a.point, b.point, c.point, bounds.delta);
        const auto goesOn = [this] { return !done(); };
        candidates.forCells(run, cells, goesOn, [&](std::int32_t x, std::int32_t y, std::int32_t z, const auto& known) {
            if (!hullMayMeetLinearly(opaque_, hull.hull(), known, x, y, z)) {
                return;
            }
            const CertifiedTriangle triangle = shader::certifiedTriangle(a.point, b.point, c.point, bounds.delta);
            if (cells.single() || !shader::certifiedPlaneMisses(triangle, middleOf(x, y, z), 0.5F)) {
                decideCell(triangle, x, y, z, cells_.ofCell({x, y, z}), true);
            }
        });
    }

    [[nodiscard]] static VoxelPoint originOf(std::int32_t x, std::int32_t y, std::int32_t z) {
        return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }

    [[nodiscard]] static VoxelPoint middleOf(std::int32_t x, std::int32_t y, std::int32_t z) {
        return {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, static_cast<float>(z) + 0.5F};
    }

    void decideTriangle(const CertifiedVertex& a, const CertifiedVertex& b, const CertifiedVertex& c) {
        const shader::CertifiedBounds bounds = shader::certifiedBounds(item_, a, b, c);
        const CellBox cells = cellsOf(bounds);
        if (cells.empty()) {
            return;
        }
        const BrickBox bricks = cells.bricks();
        const bool several = bricks.lo != bricks.hi;
        if (several && !job_.occupancy.mayBeOpaque(bricks)) {
            return;
        }
        if (!bounds.usable) {
            open(cells);
            return;
        }
        const CertifiedTriangle triangle = shader::certifiedTriangle(a.point, b.point, c.point, bounds.delta);
        if constexpr (Mode::kCounts) {
            counting_->triangle = {{a.point, b.point, c.point}, bounds.delta, triangle_.number, triangle_.vertices};
            counting_->cubes.begin(triangle);
        }
        const bool large = bricks.volume() >= BrickRows::kLeastBricks;
        const auto decide = [&](const std::array<std::int32_t, 3>& brick) {
            decideBrick(Rounded{*this, triangle, large}, cells, brick, several);
        };
        if (large) {
            cells_.forBricks(
                BrickRows(triangle, bricks), bricks, [this] { return !done(); }, decide);
        } else {
            visitBricks(bricks, decide);
        }
    }

    /// Visits bricks that may have an opaque point, until it is done.
    template <class Visit> void visitBricks(const BrickBox& bricks, const Visit& visit) const {
        cells_.forBricks(
            bricks, [this] { return !done(); }, visit);
    }

    /// A triangle as it is first placed, in single precision.
    struct Rounded {
        Decider& decider;
        const CertifiedTriangle& triangle;
        bool large;

        /// Null: rows are not counted.
        [[nodiscard]] const CertifiedTriangle* counted() const {
            return Mode::kCounts && TriangleCells::mayBeAsked(triangle) ? &triangle : nullptr;
        }
        [[nodiscard]] bool misses(const VoxelPoint& centre, float radius) const {
            return shader::certifiedPlaneMisses(triangle, centre, radius) ||
                   (large && shader::certifiedEdgesMiss(triangle, centre, radius));
        }
        void decideCell(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& known) const {
            decider.decideCell(triangle, x, y, z, known, !decider.job_.stopAtFirst);
        }
    };

    /// A triangle whose float position is too imprecise for any of its cells, transformed precisely.
    struct Precise {
        Decider& decider;
        shader::PrecisePlane plane;

        [[nodiscard]] static const CertifiedTriangle* counted() { return nullptr; }
        [[nodiscard]] bool misses(const VoxelPoint& centre, float radius) const {
            return shader::precisePlaneMisses(plane, centre, radius);
        }
        void decideCell(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& known) const {
            decider.decideAgain(x, y, z, known);
        }
    };

    /// The triangle at hand is undecided in some of these cells: it is placed again, unless a certain fragment that is
    /// found meanwhile makes that needless.
    void open(const CellBox& cells) {
        constexpr std::size_t kMostOpen = 65536;
        if (job_.stopAtFirst && open_.size() < kMostOpen) {
            open_.push_back({triangle_, cells});
        } else {
            decideAgain(cells);
        }
    }

    void decideOpen() {
        for (std::size_t i = 0; i < open_.size() && !done(); ++i) {
            triangle_ = open_[i].triangle;
            decideAgain(open_[i].cells);
        }
    }

    void decideAgain(const CellBox& cells) {
        precise_.begin(triangle_.number, triangle_.vertices);
        const bool isKnown = precise_.known();
        if (isKnown && precise_.outside()) {
            return;
        }
        const BrickBox bricks = cells.bricks();
        const Precise triangle{*this, cells.single() ? shader::PrecisePlane{} : precise_.plane()};
        visitBricks(bricks, [&](const std::array<std::int32_t, 3>& brick) {
            if (isKnown) {
                decideBrick(triangle, cells, brick, bricks.lo != bricks.hi);
            } else {
                tally_.undecided = true;
            }
        });
    }

    void decideAgain(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& known) {
        const auto found = precise_.decide(x, y, z, known);
        if (found.verdict == CERTIFIED_CERTAIN) {
            addCertain(found.corners, found.witness, x, y, z);
        } else if (found.verdict == CERTIFIED_UNDECIDED) {
            tally_.undecided = true;
        }
    }

    void addCertain(const shader::CertifiedCorners& corners, const shader::CertifiedWitness& witness, std::int32_t x,
                    std::int32_t y, std::int32_t z) {
        ++tally_.certain;
        if (sink_) {
            sink_(triangle_.number, shader::certifiedProof(opaque_, item_, corners, witness, x, y, z));
        }
    }

    template <class Placed>
    void decideBrick(const Placed& triangle, const CellBox& cells, const std::array<std::int32_t, 3>& brick,
                     bool several) {
        constexpr float kRadius = 0.5F * kBrickSide;
        const CellBox within = cells.within(brick);
        const BrickCells& known = job_.occupancy.cells(job_.volume, brick);
        if (!known.any(within)) {
            return;
        }
        if (several) {
            const VoxelPoint centre{static_cast<float>((brick[0] << kBrickShift) - 1) + kRadius,
                                    static_cast<float>((brick[1] << kBrickShift) - 1) + kRadius,
                                    static_cast<float>((brick[2] << kBrickShift) - 1) + kRadius};
            if (triangle.misses(centre, kRadius)) {
                return;
            }
        }
        if constexpr (Mode::kCounts) {
            if (const CertifiedTriangle* counted = triangle.counted()) {
                const CellBits& allOpaque = job_.occupancy.allOpaque(job_.volume, brick);
                tally_.certain += counting_->cubes.count(
                    {brick, within, known.mayBeOpaque, allOpaque},
                    [&](const std::array<std::int32_t, 3>& cell, bool passes) { countLater(cell, known, passes); });
                return;
            }
        }
        decideCells(triangle, within, known, brick, cells.single());
    }

    /// `within` is numbered within the brick.
    template <class Placed>
    void decideCells(const Placed& triangle, const CellBox& within, const BrickCells& known,
                     const std::array<std::int32_t, 3>& brick, bool single) {
        const auto cell = [&](std::int32_t number, std::size_t axis) {
            return VolumeCells<Kept>::cellOf(brick, number, axis);
        };
        for (std::int32_t z = within.lo[2]; z <= within.hi[2]; ++z) {
            for (std::int32_t y = within.lo[1]; y <= within.hi[1]; ++y) {
                for (unsigned row = known.row(within, y, z); row != 0; row &= row - 1) {
                    const std::int32_t x = std::countr_zero(row);
                    const VoxelPoint centre = middleOf(cell(x, 0), cell(y, 1), cell(z, 2));
                    if (single || !triangle.misses(centre, 0.5F)) {
                        triangle.decideCell(cell(x, 0), cell(y, 1), cell(z, 2), known);
                        if (done()) {
                            return;
                        }
                    }
                }
            }
        }
    }

    /// `isCandidate`: testing the triangle's bounds in this cell is not worthwhile, or was done already.
    void decideCell(const CertifiedTriangle& triangle, std::int32_t x, std::int32_t y, std::int32_t z,
                    const BrickCells& known, bool isCandidate) {
        const shader::CertifiedCorners corners = cells_.corners(x, y, z, known);
        const shader::CertifiedCell cell = shader::certifiedCell(item_, corners, x, y, z, triangle.delta);
        if (!isCandidate && !hullMayMeetLinearly(opaque_, TriangleHull(triangle).hull(), cell, x, y, z)) {
            return;
        }
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        const int count = shader::certifiedBegin(opaque_, triangle, cell, x, y, z, polygon);
        shader::CertifiedWitness witness{};
        const int verdict = shader::certifiedSettle(opaque_, item_.resolution, cell, polygon, count, witness);
        if (verdict == CERTIFIED_CERTAIN) {
            addCertain(corners, witness, x, y, z);
        } else if (verdict == CERTIFIED_UNDECIDED) {
            open({{x, y, z}, {x, y, z}});
        }
    }

    /// State that only counting needs.
    struct Counting {
        Counting(const CertifiedJob& job, const VolumeCells<Kept>& cells, const PlacedVertices& placed,
                 const shader::OpacityBounds& bounds, float delta)
            : run(job), proofs(cells, placed, bounds, delta), parts(job, cells) {}

        RunCounter run;
        VertexProofs<Kept> proofs;
        PartCounter<Kept> parts;
        typename PartCounter<Kept>::Triangle triangle; ///< at hand
        CellCounter cubes;                             ///< of the same
    };
    const CertifiedJob& job_;
    VolumeCells<Kept> cells_;
    const CertifiedSink& sink_;
    shader::CertifiedItem item_;
    shader::OpaqueValues opaque_;
    CertifiedTally tally_;
    Triangle triangle_;              ///< at hand
    PreciseFragments<Kept> precise_; ///< of a triangle with undecided fragments
    std::vector<Open> open_;
    PlacedVertices placed_;
    BoxCells boxes_;
    std::optional<Counting> counting_; ///< once a run is counted
    shader::CertifiedBounds delta_{};  ///< upper bound for all triangles of the mesh, or of the last box
};

} // namespace voxtact::cpu

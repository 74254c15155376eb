// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "cpu/certified/certified_pair.h"
#include "cpu/certified/row_counter.h"
#include "cpu/scene/stored_voxels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

inline CellBox cellsOf(const shader::CertifiedBounds& bounds) {
    return {{bounds.firstX, bounds.firstY, bounds.firstZ}, {bounds.lastX, bounds.lastY, bounds.lastZ}};
}

static_assert(TriangleCells::kRow == kBrickSide, "a brick's rows are asked as they are");

/// Goes through a job's fragments. `Mode::kCounts`: nothing but how many there are is asked. A mode is a type of the
/// one file that instantiates this with it: compilers put in line what nobody else can call.
template <class Kept, class Mode> class Decider {
    using CertifiedTriangle = shader::CertifiedTriangle;
    using CertifiedVertex = shader::CertifiedVertex;
    using VoxelPoint = shader::VoxelPoint;

  public:
    Decider(const CertifiedJob& job, const Kept* voxels, const CertifiedSink& sink)
        : job_(job), voxels_(voxels), sink_(sink), item_(job.occupancy.item()), table_(job.occupancy.table()) {}

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
        return tally_;
    }

  private:
    /// The most vertices that a cluster has, padding included.
    static constexpr std::size_t kMostVertices = 3 * std::size_t{kClusterTriangles} + kMeshAlignment;

    /// Vertices of a cluster in voxel space.
    struct Vertices {
        float x[kMostVertices];
        float y[kMostVertices];
        float z[kMostVertices];
        float error[kMostVertices];

        [[nodiscard]] CertifiedVertex at(std::size_t i) const { return {{x[i], y[i], z[i]}, error[i]}; }
    };

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

    /// A vertex in opaque matter is found sooner than a fragment is decided, so all runs are probed before any is
    /// decided.
    void probeAndDecide() {
        std::vector<std::uint32_t> runs;
        descend([&](std::uint32_t run) {
            runs.push_back(run);
            probeRun(run);
            return !done();
        });
        for (std::size_t i = 0; i < runs.size() && !done(); ++i) {
            decideRun(runs[i]);
        }
    }

    void probeRun(std::uint32_t run) {
        if (!delta_.usable) {
            return;
        }
        const MeshImpl& mesh = job_.mesh;
        const std::size_t first = beginRun(run);
        for (std::size_t at = first; at < first + kRunTriangles && mesh.numbers[at] != kNoTriangle; ++at) {
            for (const std::uint8_t corner : {mesh.corner0[at], mesh.corner1[at], mesh.corner2[at]}) {
                if (!probed_[corner]) {
                    probed_[corner] = true;
                    if (vertexProves(mesh.numbers[at], vertices_.at(corner).point)) {
                        tally_.certain = 1;
                        return;
                    }
                }
            }
        }
    }

    /// Tells the sink, too.
    [[nodiscard]] bool vertexProves(std::uint32_t triangle, const VoxelPoint& vertex) const {
        const std::array<int, 3> size{item_.sizeX, item_.sizeY, item_.sizeZ};
        std::array<std::int32_t, 3> cell{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float at = voxelAlong(vertex, static_cast<int>(axis));
            if (!(at >= -0.5F && at <= static_cast<float>(size[axis]) - 0.5F)) {
                return false;
            }
            cell[axis] = std::min(at < 0 ? -1 : static_cast<std::int32_t>(at), size[axis] - 1);
        }
        const CellBox box{cell, cell};
        const std::array<std::int32_t, 3> brick = box.bricks().lo;
        if (!job_.occupancy.mayBeOpaque(job_.occupancy.brickNumber(brick))) {
            return false;
        }
        const BrickCells& known = job_.occupancy.cells(job_.volume, brick);
        if (!known.any(box.within(brick))) {
            return false;
        }
        const shader::CertifiedCorners corners = cornersOf(cell[0], cell[1], cell[2], known);
        const shader::CertifiedCell here =
            shader::certifiedCell(item_, corners, cell[0], cell[1], cell[2], delta_.delta);
        shader::CertifiedWitness witness;
        if (!shader::certifiedVertexProves(table_, here, vertex, cell[0], cell[1], cell[2], witness)) {
            return false;
        }
        if (sink_) {
            sink_(triangle, shader::certifiedProof(table_, item_, corners, witness, cell[0], cell[1], cell[2]));
        }
        return true;
    }

    /// Whether the triangles in a box of object space may pass through a brick that may have an opaque point.
    [[nodiscard]] bool mayTouch(const RunBox& box) {
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

    /// The number of the run's first triangle in the mesh's arrays; its vertices are then at hand.
    std::size_t beginRun(std::uint32_t run) {
        const std::uint32_t cluster = run / ClusterTree::kRunsOfCluster;
        const ClusterPlace& place = job_.mesh.clusters[cluster];
        if (cluster != transformed_) {
            transform(place);
            transformed_ = cluster;
            probed_.fill(false);
        }
        return place.firstTriangle + run % ClusterTree::kRunsOfCluster * kRunTriangles;
    }

    void decideRun(std::uint32_t run) {
        const MeshImpl& mesh = job_.mesh;
        const std::size_t first = beginRun(run);
        for (std::size_t at = first; at < first + kRunTriangles && !done(); ++at) {
            if (mesh.numbers[at] == kNoTriangle) {
                return;
            }
            const std::size_t firstVertex = mesh.clusters[transformed_].firstVertex;
            triangle_ = {
                mesh.numbers[at],
                {firstVertex + mesh.corner0[at], firstVertex + mesh.corner1[at], firstVertex + mesh.corner2[at]}};
            decideTriangle(vertices_.at(mesh.corner0[at]), vertices_.at(mesh.corner1[at]),
                           vertices_.at(mesh.corner2[at]));
        }
    }

    void transform(const ClusterPlace& place) {
        const MeshImpl& mesh = job_.mesh;
        const std::size_t first = place.firstVertex;
        for (std::size_t i = 0; i < place.vertexCount; ++i) {
            const CertifiedVertex vertex =
                shader::certifiedVertex(job_.transform, mesh.x[first + i], mesh.y[first + i], mesh.z[first + i]);
            vertices_.x[i] = vertex.point.x;
            vertices_.y[i] = vertex.point.y;
            vertices_.z[i] = vertex.point.z;
            vertices_.error[i] = vertex.error;
        }
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
            rows_.begin();
        }
        visitBricks(bricks, [&](const std::array<std::int32_t, 3>& brick) {
            decideBrick(Rounded{*this, triangle}, cells, brick, several);
        });
    }

    /// Those that may have an opaque point, until it is done.
    template <class Visit> void visitBricks(const BrickBox& bricks, const Visit& visit) const {
        for (std::int32_t z = bricks.lo[2]; z <= bricks.hi[2]; ++z) {
            for (std::int32_t y = bricks.lo[1]; y <= bricks.hi[1]; ++y) {
                for (std::int32_t x = bricks.lo[0]; x <= bricks.hi[0] && !done(); ++x) {
                    if (job_.occupancy.mayBeOpaque(job_.occupancy.brickNumber({x, y, z}))) {
                        visit(std::array<std::int32_t, 3>{x, y, z});
                    }
                }
            }
        }
    }

    /// A triangle as it is first placed, in single precision.
    struct Rounded {
        Decider& decider;
        const CertifiedTriangle& triangle;

        /// Null: rows are not counted.
        [[nodiscard]] const CertifiedTriangle* counted() const {
            return Mode::kCounts && TriangleCells::mayBeAsked(triangle) ? &triangle : nullptr;
        }
        [[nodiscard]] bool planeMisses(const VoxelPoint& centre, float radius) const {
            return shader::certifiedPlaneMisses(triangle, centre, radius);
        }
        void decideCell(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& known) const {
            decider.decideCell(triangle, x, y, z, known);
        }
    };

    /// A triangle whose first place is too uncertain for any cell of it, placed precisely.
    struct Precise {
        Decider& decider;
        shader::PrecisePlane plane;

        [[nodiscard]] static const CertifiedTriangle* counted() { return nullptr; }
        [[nodiscard]] bool planeMisses(const VoxelPoint& centre, float radius) const {
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
        const auto vertex = [&](std::size_t i) {
            const std::size_t at = triangle_.vertices[i];
            return VoxelPoint{job_.mesh.x[at], job_.mesh.y[at], job_.mesh.z[at]};
        };
        if (preciseOf_ != triangle_.number) {
            precise_ = shader::preciseTriangle(job_.transform, item_, vertex(0), vertex(1), vertex(2));
            preciseOf_ = triangle_.number;
        }
        const bool isKnown = shader::preciseKnown(precise_);
        if (isKnown && precise_.outside) {
            return;
        }
        const BrickBox bricks = cells.bricks();
        const Precise triangle{*this, cells.single() ? shader::PrecisePlane{} : shader::precisePlane(item_, precise_)};
        visitBricks(bricks, [&](const std::array<std::int32_t, 3>& brick) {
            if (isKnown) {
                decideBrick(triangle, cells, brick, bricks.lo != bricks.hi);
            } else {
                tally_.undecided = true;
            }
        });
    }

    void decideAgain(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& known) {
        const shader::CertifiedCorners corners = cornersOf(x, y, z, known);
        shader::CertifiedCell cell = shader::preciseCell(item_, precise_, corners, x, y, z);
        shader::CertifiedWitness witness{};
        int verdict = settleAgain(cell, x, y, z, false, witness);
        if (verdict == CERTIFIED_UNDECIDED && shader::preciseCrosses(cell)) {
            cell = shader::preciseWithin(cell);
            const bool certain = settleAgain(cell, x, y, z, true, witness) == CERTIFIED_CERTAIN;
            verdict = certain ? CERTIFIED_CERTAIN : CERTIFIED_UNDECIDED;
        }
        if (verdict == CERTIFIED_CERTAIN) {
            addCertain(corners, witness, x, y, z);
        } else if (verdict == CERTIFIED_UNDECIDED) {
            tally_.undecided = true;
        }
    }

    int settleAgain(const shader::CertifiedCell& cell, std::int32_t x, std::int32_t y, std::int32_t z, bool within,
                    shader::CertifiedWitness& witness) const {
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        const int count = shader::certifiedBeginAgain(precise_, cell, x, y, z, within, polygon);
        return shader::certifiedSettle(table_, shader::certifiedFinest(item_), cell, polygon, count, witness);
    }

    void addCertain(const shader::CertifiedCorners& corners, const shader::CertifiedWitness& witness, std::int32_t x,
                    std::int32_t y, std::int32_t z) {
        ++tally_.certain;
        if (sink_) {
            sink_(triangle_.number, shader::certifiedProof(table_, item_, corners, witness, x, y, z));
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
            if (triangle.planeMisses(centre, kRadius)) {
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
            return (brick[axis] << kBrickShift) - 1 + number;
        };
        const CertifiedTriangle* counted = triangle.counted();
        const CellBits* allOpaque = counted != nullptr ? &job_.occupancy.allOpaque(job_.volume, brick) : nullptr;
        for (std::int32_t z = within.lo[2]; z <= within.hi[2]; ++z) {
            for (std::int32_t y = within.lo[1]; y <= within.hi[1]; ++y) {
                unsigned row = known.row(within, y, z);
                if (Mode::kCounts && counted != nullptr) {
                    const RowCounter::Row counts =
                        rows_.count(*counted, row, (*allOpaque)[static_cast<std::size_t>(y + kBrickSide * z)],
                                    {cell(0, 0), cell(y, 1), cell(z, 2)});
                    tally_.certain += counts.certain;
                    row = counts.left;
                }
                for (; row != 0; row &= row - 1) {
                    const std::int32_t x = std::countr_zero(row);
                    const VoxelPoint centre{static_cast<float>(cell(x, 0)) + 0.5F,
                                            static_cast<float>(cell(y, 1)) + 0.5F,
                                            static_cast<float>(cell(z, 2)) + 0.5F};
                    if (single || !triangle.planeMisses(centre, 0.5F)) {
                        triangle.decideCell(cell(x, 0), cell(y, 1), cell(z, 2), known);
                        if (done()) {
                            return;
                        }
                    }
                }
            }
        }
    }

    [[nodiscard]] shader::CertifiedCorners cornersOf(std::int32_t x, std::int32_t y, std::int32_t z,
                                                     const BrickCells& known) const {
        const auto& stride = job_.volume.image.stride;
        const Kept* at = voxels_ + (x + 1) + (y + 1) * stride[1] + (z + 1) * stride[2];
        const auto stored = [&](std::int64_t offset) { return storedValue(at[offset]); };
        return {stored(0),
                stored(1),
                stored(stride[1]),
                stored(stride[1] + 1),
                stored(stride[2]),
                stored(stride[2] + 1),
                stored(stride[2] + stride[1]),
                stored(stride[2] + stride[1] + 1),
                known.wideLo,
                known.wideHi};
    }

    void decideCell(const CertifiedTriangle& triangle, std::int32_t x, std::int32_t y, std::int32_t z,
                    const BrickCells& known) {
        const shader::CertifiedCorners corners = cornersOf(x, y, z, known);
        const shader::CertifiedCell cell = shader::certifiedCell(item_, corners, x, y, z, triangle.delta);
        if (Mode::kCounts && cornerProves(triangle, cell, x, y, z)) {
            ++tally_.certain;
            return;
        }
        VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
        const int count = shader::certifiedBegin(table_, triangle, cell, x, y, z, polygon);
        shader::CertifiedWitness witness{};
        const int verdict = shader::certifiedSettle(table_, item_.resolution, cell, polygon, count, witness);
        if (verdict == CERTIFIED_CERTAIN) {
            addCertain(corners, witness, x, y, z);
        } else if (verdict == CERTIFIED_UNDECIDED) {
            open({{x, y, z}, {x, y, z}});
        }
    }

    /// Whether a corner of the triangle that is in the cell proves what certifiedSettle() would find.
    [[nodiscard]] bool cornerProves(const CertifiedTriangle& triangle, const shader::CertifiedCell& cell,
                                    std::int32_t x, std::int32_t y, std::int32_t z) const {
        const VoxelPoint origin{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        for (const VoxelPoint& corner : {triangle.corner0, triangle.corner1, triangle.corner2}) {
            const VoxelPoint at = shader::voxelDifference(corner, origin);
            const bool inCell = at.x >= cell.lo.x && at.x <= cell.hi.x && at.y >= cell.lo.y && at.y <= cell.hi.y &&
                                at.z >= cell.lo.z && at.z <= cell.hi.z;
            shader::CertifiedWitness witness{};
            if (inCell && shader::certifiedVertexProves(table_, cell, corner, x, y, z, witness)) {
                return true;
            }
        }
        return false;
    }

    const CertifiedJob& job_;
    const Kept* voxels_;
    const CertifiedSink& sink_;
    shader::CertifiedItem item_;
    shader::OpacityTable table_;
    CertifiedTally tally_;
    Triangle triangle_;                 ///< at hand
    RowCounter rows_;                   ///< of the same
    shader::PreciseTriangle precise_{}; ///< of number `preciseOf_`
    std::uint32_t preciseOf_ = kNoTriangle;
    std::vector<Open> open_;
    Vertices vertices_; ///< of cluster `transformed_`
    std::uint32_t transformed_ = 0xffffffffU;
    std::array<bool, kMostVertices> probed_{}; ///< of the same cluster
    shader::CertifiedBounds delta_{};          ///< of the box that was looked at last; not less than its triangles'
};

} // namespace voxtact::cpu

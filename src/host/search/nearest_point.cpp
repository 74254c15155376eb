// SPDX-License-Identifier: MIT
#include "host/search/nearest_point.h"
#include "core/base/infinity.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace voxtact::cpu {

namespace {

using glm::dot;
using glm::dvec3;

/// A part of a tree, and how near it is.
template <class Node> struct Near {
    double distance = 0;
    Node node{};
};

/// The nearest first.
template <class Node, std::size_t Most> struct NearList {
    std::array<Near<Node>, Most> entries{};
    std::size_t count = 0;

    void add(double distance, const Node& node) {
        std::size_t at = count++;
        for (; at > 0 && distance < entries[at - 1].distance; --at) {
            entries[at] = entries[at - 1];
        }
        entries[at] = {distance, node};
    }
    [[nodiscard]] const Near<Node>* begin() const { return entries.data(); }
    [[nodiscard]] const Near<Node>* end() const { return entries.data() + count; }
};

class MeshSearch {
  public:
    MeshSearch(MeshPlace& mesh, const dvec3& from, double within) : mesh_(mesh), from_(from) {
        best_.distance = within;
    }

    MeshPoint run() {
        const std::uint32_t top = mesh_.mesh().tree.levels() - 1;
        openBoxes(top, 0, static_cast<std::uint32_t>(mesh_.mesh().tree.boxes(top).size()));
        return best_;
    }

  private:
    void openBoxes(std::uint32_t level, std::uint32_t first, std::uint32_t last) {
        NearList<std::uint32_t, ClusterTree::kFanOut> near;
        for (std::uint32_t node = first; node < last; ++node) {
            near.add(distanceTo(mesh_.box(level, node)), node);
        }
        for (const auto& [distance, node] : near) {
            if (distance >= best_.distance) {
                return;
            }
            if (level > 0) {
                const auto below = static_cast<std::uint32_t>(mesh_.mesh().tree.boxes(level - 1).size());
                const std::uint32_t child = node * ClusterTree::kFanOut;
                openBoxes(level - 1, child, std::min(child + ClusterTree::kFanOut, below));
            } else {
                openRun(node);
            }
        }
    }

    void openRun(std::uint32_t run) {
        constexpr std::uint32_t kRuns = ClusterTree::kRunsOfCluster;
        for (std::uint32_t i = 0; i < mesh_.count(run); ++i) {
            const PlacedTriangle triangle = mesh_.triangle(run / kRuns, run % kRuns * kRunTriangles + i);
            const dvec3 point = closestPoint(triangle.corners, from_);
            const double distance = glm::distance(point, from_);
            if (distance < best_.distance) {
                best_ = {point, distance, mesh_.first(run) + i};
            }
        }
    }

    [[nodiscard]] double distanceTo(const PlacedBox& box) const {
        const dvec3 off = from_ - box.middle;
        dvec3 left = off;
        for (const dvec3& side : box.sides) {
            const double square = dot(side, side);
            if (square > 0) {
                left -= std::clamp(dot(off, side) / square, -1.0, 1.0) * side;
            }
        }
        return glm::length(left);
    }

    MeshPlace& mesh_;
    dvec3 from_;
    MeshPoint best_;
};

class OpaqueSearch {
  public:
    OpaqueSearch(const OpaquePart& part, const SearchedPart& searched, const VolumeImpl& volume, const dvec3& from,
                 double within, const NearMemory& memory)
        : part_(part), searched_(searched), volume_(volume), memory_(memory), from_(from),
          voxel_(part.space.toVoxel(from)) {
        best_.distance = within;
    }

    OpaquePoint runIn(const NodePlace& brick) {
        openBrick(brick);
        return best_;
    }

    OpaquePoint run() {
        const std::uint32_t top = searched_.pyramid().levels() - 1;
        if (searched_.pyramid().has(top, {0, 0, 0})) {
            openBox(top + kBrickShift, {0, 0, 0});
        }
        return best_;
    }

  private:
    [[nodiscard]] double distanceTo(std::uint32_t shift, const NodePlace& node) const {
        dvec3 off;
        for (int axis = 0; axis < 3; ++axis) {
            const double lo = (node[static_cast<std::size_t>(axis)] << shift) - 1 - part_.space.centre[axis];
            const double hi = lo + (1 << shift);
            off[axis] = std::max({lo - voxel_[axis], voxel_[axis] - hi, 0.0}) * part_.space.spacing[axis];
        }
        return glm::length(off);
    }

    void openBox(std::uint32_t shift, const NodePlace& node) {
        if (shift == kBrickShift) {
            openBrick(node);
            return;
        }
        NearList<NodePlace, 8> near;
        for (unsigned i = 0; i < 8; ++i) {
            NodePlace child{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                child[axis] = 2 * node[axis] + static_cast<std::int32_t>(i >> axis & 1U);
            }
            const double distance = distanceTo(shift - 1, child);
            if (distance < best_.distance && searched_.pyramid().has(shift - 1 - kBrickShift, child)) {
                near.add(distance, child);
            }
        }
        for (const auto& [distance, child] : near) {
            if (distance >= best_.distance) {
                return;
            }
            openBox(shift - 1, child);
        }
    }

    /// mm^2: cells from this distance on are pruned.
    [[nodiscard]] double worthwhile() const { return best_.distance * best_.distance; }

    /// The nearest cell first, then cells that may be nearer: most bricks have none.
    void openBrick(const NodePlace& brick) {
        const BrickCells& known = part_.cells(volume_, brick);
        const CellSquares squares(*this, brick);
        if (squares.least(known.around) >= worthwhile()) {
            return;
        }
        CellBox cells = known.around;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cells.hi[axis] = std::min(cells.hi[axis], squares.last[axis]);
        }
        cullNear({known, cells, squares.of, worthwhile()}, memory_.cells);
        double least = worthwhile();
        NodePlace nearest{-1, -1, -1};
        forKept(cells, least, [&](double square, const NodePlace& cell) {
            if (square < least) {
                least = square;
                nearest = cell;
            }
        });
        if (nearest[0] < 0) {
            return;
        }
        openCell(squares.padded(nearest));
        forKept(cells, worthwhile(), [&](double /*square*/, const NodePlace& cell) {
            if (cell != nearest) {
                addCell(squares.padded(cell));
            }
        });
        walk();
    }

    /// Calls `visit(square, cell)` for the cells that were kept and are nearer than that, mm^2.
    template <class Visit> void forKept(const CellBox& cells, double within, const Visit& visit) const {
        for (std::int32_t z = cells.lo[2]; z <= cells.hi[2]; ++z) {
            for (std::int32_t y = cells.lo[1]; y <= cells.hi[1]; ++y) {
                const auto number = static_cast<std::size_t>(y + kBrickSide * z);
                for (unsigned row = memory_.cells.kept[number]; row != 0; row &= row - 1) {
                    const std::int32_t x = std::countr_zero(row);
                    const double square = memory_.cells.lo[number * kBrickSide + static_cast<std::size_t>(x)];
                    if (square < within) {
                        visit(square, NodePlace{x, y, z});
                    }
                }
            }
        }
    }

    /// Squared distances of a brick's cells along each axis: mm^2.
    struct CellSquares {
        CellSquares(const OpaqueSearch& search, const NodePlace& brick) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<int>(axis);
                first[axis] = brick[axis] << kBrickShift;
                last[axis] = search.volume_.image.size[axis] - first[axis];
                for (std::int32_t cell = 0; cell < kBrickSide; ++cell) {
                    const double lo = first[axis] + cell - 1 - search.part_.space.centre[at];
                    const double off = std::max({lo - search.voxel_[at], search.voxel_[at] - (lo + 1), 0.0});
                    const double length = off * search.part_.space.spacing[at];
                    of[axis][static_cast<std::size_t>(cell)] = length * length;
                }
            }
        }
        [[nodiscard]] double at(std::size_t axis, std::int32_t cell) const {
            return of[axis][static_cast<std::size_t>(cell)];
        }
        /// Returns the minimum squared distance of some of the brick's cells.
        [[nodiscard]] double least(const CellBox& cells) const {
            double sum = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double square = kInfinity;
                for (std::int32_t cell = cells.lo[axis]; cell <= cells.hi[axis]; ++cell) {
                    square = std::min(square, at(axis, cell));
                }
                sum += square;
            }
            return sum;
        }
        /// A cell of the brick among those of the volume.
        [[nodiscard]] NodePlace padded(const NodePlace& cell) const {
            return {first[0] + cell[0], first[1] + cell[1], first[2] + cell[2]};
        }

        NodePlace first{}; ///< padded cells
        NodePlace last{};  ///< numbered within the brick: the volume has none beyond
        std::array<std::array<double, kBrickSide>, 3> of{};
    };

    void openCell(const NodePlace& node) {
        const PartCell cell = part_.cell(volume_, node);
        searched_.forRegions(cell, node, [&](const CellRegion& region) { look(cell, region); });
    }

    void look(const PartCell& cell, const CellRegion& region) {
        dvec3 at = glm::clamp(2.0 * (voxel_ - cell.middle), region.lo, region.hi);
        if (goToOpaque(part_, cell, region, at)) {
            offer(cell.middle, at);
        }
    }

    void offer(const dvec3& cellMiddle, const dvec3& at) {
        const dvec3 point = part_.space.toWorld(cellMiddle + 0.5 * at);
        const double distance = glm::distance(point, from_);
        if (distance < best_.distance) {
            best_ = {point, distance};
        }
    }

    /// Adds a cell to the walks; walk() may be deferred.
    void addCell(const NodePlace& node) {
        PieceRows& rows = memory_.rows;
        const PartCell place = part_.emptyCell(volume_, node);
        searched_.forRegions(place, node, [&](const CellRegion& region) {
            if (rows.count == PieceRows::kMost) {
                walk();
            }
            part_.addCell(volume_, node, rows);
            rows.setPiece(rows.count - 1, 0.5 * (region.lo + region.hi), 0.5 * (region.hi - region.lo));
        });
    }

    void walk() {
        PieceRows& rows = memory_.rows;
        if (rows.count == 0) {
            return;
        }
        makeTerms(rows);
        walkToOpaque({part_.intervals, part_.space, from_, voxel_}, rows, memory_.walks);
        const double* const distances = memory_.walks.distance.data();
        const auto i = static_cast<std::size_t>(std::min_element(distances, distances + rows.count) - distances);
        if (distances[i] < best_.distance) {
            const auto& at = memory_.walks.at;
            offer({rows.cell[0][i], rows.cell[1][i], rows.cell[2][i]}, {at[0][i], at[1][i], at[2][i]});
        }
        rows.count = 0;
    }

    const OpaquePart& part_;
    const SearchedPart& searched_;
    const VolumeImpl& volume_;
    const NearMemory& memory_;
    dvec3 from_;
    dvec3 voxel_;
    OpaquePoint best_;
};

} // namespace

MeshPoint nearestOnMesh(MeshPlace& mesh, const dvec3& from, double within) {
    return MeshSearch(mesh, from, within).run();
}

OpaquePoint nearestOpaque(const OpaquePart& part, const SearchedPart& searched, const VolumeImpl& volume,
                          const dvec3& from, double within, const NearMemory& memory) {
    return OpaqueSearch(part, searched, volume, from, within, memory).run();
}

OpaquePoint nearestInBrick(const OpaquePart& part, const SearchedPart& searched, const VolumeImpl& volume,
                           const NodePlace& brick, const dvec3& from, double within, const NearMemory& memory) {
    return OpaqueSearch(part, searched, volume, from, within, memory).runIn(brick);
}

bool goToOpaque(const OpaquePart& part, const PartCell& cell, const CellRegion& region, dvec3& at) noexcept {
    constexpr int kMostSteps = 4;
    constexpr double kBeyond = 1.5;
    for (int step = 0;; ++step) {
        const double value = valueAt(cell.terms, at);
        if (part.intervals.contain(value - cell.error, value + cell.error)) {
            return true;
        }
        if (step == kMostSteps || std::isnan(value) || part.intervals.inner().empty()) {
            return false;
        }
        const ValueRange& target = part.intervals.nearest(value);
        const double lowest = target.lo + kBeyond * cell.error;
        const double highest = target.hi - kBeyond * cell.error;
        const double wanted = lowest <= highest ? std::clamp(value, lowest, highest) : 0.5 * (target.lo + target.hi);
        const dvec3 gradient = 2.0 * gradientAt(cell.terms, at);
        const dvec3 direction = part.space.direction_from_gradient * gradient;
        const double slope = dot(gradient, direction);
        if (!(slope > 0)) {
            return false;
        }
        at += (2 * (wanted - value) / slope) * direction;
        at = glm::clamp(at, region.lo, region.hi);
    }
}

} // namespace voxtact::cpu

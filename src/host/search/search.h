// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "host/cancel.h"
#include "host/search/cells/cell_culling.h"
#include "host/search/cells/cell_piece.h"
#include "host/search/cells/piece_distance.h"
#include "host/search/cells/piece_rows.h"
#include "host/search/cells/volume_boxes.h"
#include "host/search/found.h"
#include "host/search/label_part.h"
#include "host/search/mesh_place.h"
#include "host/search/nearest_point.h"
#include "host/search/opaque_part.h"
#include "host/search/pair_heap.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// When a search ends.
struct SearchGoal {
    double tolerance = 0;       ///< mm: the bounds are near enough
    double relative = 0;        ///< of the upper bound: the same
    double maximum = kInfinity; ///< mm: search radius
    double enough = -1;         ///< mm: an opaque point as near as this ends it
    double finest = 0;          ///< mm: stop when upper - lower is at most this
    std::uint64_t maxSteps = 0;
    std::optional<glm::dvec3> known{}; ///< local: a point that certainly is searched for. Not with a sweep
    bool measures = false; ///< a sweep that only shifts: measures the distance instead of testing separation
    bool coarsely = false; ///< boxes below the finest size are not divided, even if undecided
    bool untilMet = false; ///< also searches for a point within `enough` if the lower bound is known to be 0
};

/// Finds the opaque point closest to a mesh, best first (Hart, Nilsson and Raphael, 1968): over pairs of a box of the
/// mesh's tree and a box of the volume's, down to triangles and pieces of cells. For one thread; reused between pairs
/// for its memory.
class ClosestSearch {
  public:
    /// `searched`: of that part. `from`: where to begin, or null: with all of both.
    [[nodiscard]] Found run(MeshPlace& mesh, const VolumeImpl& volume, const OpaquePart& part,
                            const SearchedPart& searched, const SearchGoal& goal, const OpenPairs* from = nullptr,
                            CancelFlag cancel = nullptr);
    /// Returns the open pairs of the last run with a swept mesh: without them it is apart from the opaque region.
    [[nodiscard]] OpenPairs left() const;

  private:
    using Pair = SearchPair;
    static constexpr std::int8_t kTriangles = Pair::kTriangles;
    /// Level 1 of a tree has a box for each cluster; a mesh of one cluster has no such level.
    static constexpr std::int8_t kClusters = 1;
    static constexpr std::uint8_t kMostDepth = 16;
    /// Boxes of this many cells are not halved; their cells are visited. With a sweep, one by one.
    [[nodiscard]] std::uint8_t leastShift() const noexcept { return mesh_->isSwept() ? 2 : 3; }

    void begin(const OpenPairs* from);
    void beginWithAll();
    void drop(const Pair& pair);
    [[nodiscard]] bool mayBeWithin(double distance) const;
    [[nodiscard]] bool goesOn();
    [[nodiscard]] Pair next();
    void open(const Pair& pair);
    void openBox(const Pair& pair);
    void openCluster(const Pair& pair);
    [[nodiscard]] const PlacedBox* boxOf(const Pair& pair);
    void openVolume(const Pair& pair);
    void openCells(const Pair& pair);
    void openLeaf(const Pair& pair);
    void offer(Pair pair);
    void offerBox(Pair pair, const PlacedBox& box, const OpaqueBox& region);
    [[nodiscard]] bool sift(Pair& pair, const OpaqueBox& region);
    void improve();
    void lookInto(const Pair& pair, const OpaqueBox& region);
    /// After gather().
    void offerPiece(Pair pair, const PartCell& cell);
    /// Offers all pieces in `rows_`, whose pairs are `offered_`, and empties the rows.
    void offerRows();
    /// Offers whole cells; may be deferred.
    void addCell(const Pair& pair);
    void offerCells();
    void push(const Pair& pair);

    /// For searches that end before rows and cells are reused.
    [[nodiscard]] NearMemory nearMemory() noexcept { return {rows_, cells_, walks_}; }
    [[nodiscard]] Direction from(const Pair& pair, const glm::dvec3& point);
    /// Sets the triangle of `corners_`.
    void gather(const Pair& pair);
    [[nodiscard]] double cut() const noexcept {
        // A point of a swept mesh shows only that it is not apart.
        if (decides()) {
            return goal_.maximum;
        }
        const double slack = std::max(goal_.tolerance, goal_.relative * found_.hi);
        return std::min(found_.hi - (found_.hi < kInfinity ? slack : 0), goal_.maximum);
    }
    /// Returns true if the only question is whether a sweep is apart.
    [[nodiscard]] bool decides() const noexcept { return mesh_->isSwept() && !goal_.measures; }
    /// Returns true if a lower bound prunes a pair: the answer's lower bound is at most that.
    [[nodiscard]] bool closes(double lo) {
        if (lo < cut()) {
            return false;
        }
        found_.lo = std::min(found_.lo, lo);
        return true;
    }

    /// Calls `visit(number, triangle)` for those of a pair.
    template <class Visit> void forTriangles(const Pair& pair, const Visit& visit);
    /// Keeps those of a pair's triangles whose `bound(triangle)` does not close; false where none is left.
    template <class Bound> bool keep(Pair& pair, const Bound& bound);
    /// Prunes by the distance along a direction whose minimum dot product with opaque points is known.
    bool keepAlong(Pair& pair, const Direction& along, double least);
    /// Prunes by `cull(job)`, which returns the remaining triangles of a pair.
    template <class Culling> bool keepBy(Pair& pair, const Culling& cull);
    bool keepByPiece(Pair& pair, const CellPiece& piece, const PieceBounds& bounds);

    MeshPlace* mesh_ = nullptr;
    const VolumeImpl* volume_ = nullptr;
    const OpaquePart* part_ = nullptr;
    const SearchedPart* searched_ = nullptr;
    SearchGoal goal_;
    CancelFlag cancel_ = nullptr;
    Found found_;
    DistanceError error_;
    VolumeBoxes boxes_;
    std::uint64_t stepsInDoubt_ = 0;     ///< since the lower bound was known
    std::array<double, 32> diameters_{}; ///< mm, of boxes by their shift
    PointList corners_;                  ///< of the triangles at hand
    RemainingCells cells_;
    PieceRows rows_;
    WalkRows walks_;
    std::vector<Pair> offered_;
    PairHeap heap_;
    std::vector<Pair> dropped_; ///< too small to be divided
    std::optional<Pair> dive_;  ///< without a point: the nearest of the last offers
};

} // namespace voxtact::cpu

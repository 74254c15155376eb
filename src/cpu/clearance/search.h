// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/clearance/label_part.h"
#include "cpu/clearance/mesh_place.h"
#include "cpu/clearance/opaque_part.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// When a search ends.
struct SearchGoal {
    double tolerance = 0;                                     ///< mm: the bounds are near enough
    double maximum = std::numeric_limits<double>::infinity(); ///< mm: what is not nearer is not looked for
    double enough = -1;                                       ///< mm: an opaque point as near as this ends it
    double finest = 0;                                        ///< mm: what is known as well is not looked at again
    std::uint64_t mostSteps = 0;
};

/// What a search found. Distances in mm.
struct Found {
    double lo = std::numeric_limits<double>::infinity(); ///< no opaque point is nearer
    double hi = std::numeric_limits<double>::infinity(); ///< some opaque point is no farther
    bool exhausted = false;                              ///< mostSteps ended it
    std::uint32_t triangle = kNoTriangle; ///< the closest one, by its place in the mesh's arrays; with hi finite
    glm::dvec3 onMesh{};                  ///< local
    glm::dvec3 inVolume{};
    std::uint64_t steps = 0;
};

/// Looks for the opaque point that is closest to a mesh, best first (Hart, Nilsson and Raphael, 1968): over pairs of a
/// box of the mesh's tree and a box of the volume's, down to triangles and pieces of cells. One thread's; kept from
/// pair to pair for its memory.
class ClosestSearch {
  public:
    /// `searched`: of that part.
    [[nodiscard]] Found run(MeshPlace& mesh, const VolumeImpl& volume, const OpaquePart& part,
                            const SearchedPart& searched, const SearchGoal& goal);

  private:
    /// A box of the mesh, or some triangles of a cluster, and a box of the volume, or a piece of a cell.
    struct Pair {
        double lo = 0;                        ///< mm: they are no nearer
        std::uint32_t mesh = 0;               ///< box of its level, or cluster
        std::uint64_t triangles = 0;          ///< a bit for each of the cluster's that may be near enough
        std::int8_t meshLevel = kTriangles;   ///< of the mesh's tree
        std::uint8_t nearest = 0;             ///< of the triangles
        std::uint8_t shift = 0;               ///< the box is 2^shift cells a side
        std::uint8_t depth = 0;               ///< the piece is 2^-depth of its cell a side
        bool sifted = false;                  ///< each of the triangles was looked at against this box
        NodePlace node{};                     ///< times 2^shift cells: its first padded cell
        std::array<std::uint16_t, 3> piece{}; ///< times 2^-depth

        [[nodiscard]] PiecePlace place() const noexcept { return {node, depth, piece}; }
        [[nodiscard]] bool isLeaf() const noexcept { return meshLevel == kTriangles && shift == 0; }
    };
    static constexpr std::int8_t kTriangles = -1;
    /// Level 1 of a tree has a box for each cluster; a mesh of one cluster has no such level.
    static constexpr std::int8_t kClusters = 1;
    static constexpr std::uint8_t kMostDepth = 16;
    /// Boxes of so many cells are not halved: their cells are gone through.
    static constexpr std::uint8_t kLeastShift = 2;

    /// A box in centred voxel coordinates, and in bricks and smaller boxes which cells of it may be opaque.
    struct Region {
        glm::dvec3 lo{};
        glm::dvec3 hi{};
        const BrickCells* known = nullptr;
        CellBox cells;       ///< of `known`
        glm::dvec3 corner{}; ///< of the brick's first cell
    };
    /// What is seen of a piece from a triangle.
    struct Seen {
        glm::dvec3 normal{}; ///< from the triangle to about the closest opaque point
        double distance = 0; ///< to it, mm
    };
    struct After {
        bool operator()(const Pair& a, const Pair& b) const noexcept;
    };

    void begin();
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
    [[nodiscard]] bool sift(Pair& pair, const Region& region);
    [[nodiscard]] bool regionOfOpaque(const Pair& pair, Region& region) const;
    void improve();
    /// After gather().
    void offerPiece(Pair pair, const PartCell& cell);
    void push(const Pair& pair);

    void setRegion(const NodePlace& first, const NodePlace& last, Region& region) const;
    [[nodiscard]] bool regionOf(const Pair& pair, Region& region) const;
    [[nodiscard]] bool narrow(const Pair& pair, Region& region) const;
    [[nodiscard]] CellPiece pieceOf(const Pair& pair, const PartCell& cell) const;
    [[nodiscard]] double gap(const Region& region, const glm::dvec3& lo, const glm::dvec3& hi) const;
    [[nodiscard]] double apart(const Region& region, const PlacedBox& box) const;
    [[nodiscard]] double apart(const Region& region, const WorldTriangle& corners) const;
    [[nodiscard]] glm::dvec3 normalFrom(const Pair& pair, const glm::dvec3& middle);
    /// Sets what reach() of `corners_` is about.
    void gather(const Pair& pair);
    [[nodiscard]] double apart(const Region& region, const glm::dvec3& normal, double reach) const;
    [[nodiscard]] double leastOf(const Region& region, const glm::dvec3& normal) const;
    [[nodiscard]] double safe(double distance) const;
    [[nodiscard]] double cut() const noexcept;
    [[nodiscard]] bool closes(double lo);

    [[nodiscard]] Seen look(const Pair& pair, const PartCell& cell, const CellPiece& piece);
    void lookBetween(const Pair& pair, const PartCell& cell, const CellPiece& piece);
    void offerPoint(std::uint32_t triangle, double distance, const glm::dvec3& onMesh, const glm::dvec3& inVolume);

    /// Calls `visit(number, triangle)` for those of a pair.
    template <class Visit> void forTriangles(const Pair& pair, const Visit& visit);
    /// Keeps those of a pair's triangles whose `bound(triangle)` does not close; false where none is left.
    template <class Bound> bool keep(Pair& pair, const Bound& bound);

    MeshPlace* mesh_ = nullptr;
    const VolumeImpl* volume_ = nullptr;
    const OpaquePart* part_ = nullptr;
    const SearchedPart* searched_ = nullptr;
    SearchGoal goal_;
    Found found_;
    double error_ = 0;
    std::uint64_t stepsInDoubt_ = 0;     ///< since the lower bound was known
    std::array<double, 32> diameters_{}; ///< mm, of boxes by their shift
    PointList corners_;                  ///< of the triangles at hand
    std::vector<Pair> heap_;
    std::optional<Pair> dive_; ///< as long as there is no point: the nearest of what was offered last
};

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/volume_boxes.h"
#include "host/search/label_part.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// A box of the mesh, or some triangles of a cluster, and a box of the volume, or a piece of a cell.
struct SearchPair {
    static constexpr std::int8_t kTriangles = -1;

    double lo = 0;                        ///< mm: they are no nearer
    std::uint64_t triangles = 0;          ///< a bit for each of the cluster's that may be near enough
    std::uint32_t mesh = 0;               ///< box of its level, or cluster
    NodePlace node{};                     ///< times 2^shift cells: its first padded cell
    std::array<std::uint16_t, 3> piece{}; ///< times 2^-depth
    std::int8_t meshLevel = kTriangles;   ///< of the mesh's tree
    std::uint8_t nearest = 0;             ///< of the triangles
    std::uint8_t shift = 0;               ///< the box is 2^shift cells per side
    std::uint8_t depth = 0;               ///< the piece is 2^-depth of its cell a side
    bool sifted = false;                  ///< each of the triangles was examined against this box

    [[nodiscard]] CellCube cube() const noexcept { return {node, shift}; }
    [[nodiscard]] PiecePlace place() const noexcept { return {node, depth, piece}; }
    [[nodiscard]] bool isLeaf() const noexcept { return meshLevel == kTriangles && shift == 0; }
    [[nodiscard]] int size() const noexcept { return meshLevel + shift - depth; }
    /// Prefers the smaller of equally near pairs, to find a point early.
    [[nodiscard]] bool isAfter(const SearchPair& other) const noexcept {
        return lo != other.lo ? lo > other.lo : size() > other.size();
    }
};

/// Pairs that a search left open; another search may begin with them, if its mesh is inside that of the first.
using OpenPairs = std::vector<SearchPair>;

/// Pairs by distance, nearest first. Sorts small entries; the pairs themselves do not move.
class PairHeap {
  public:
    void clear() noexcept {
        order_.clear();
        pairs_.clear();
        unused_.clear();
    }
    [[nodiscard]] bool empty() const noexcept { return order_.empty(); }
    /// Returns the distance of the first pair, mm. Expects at least one pair.
    [[nodiscard]] double least() const noexcept { return order_.front().lo; }

    void push(const SearchPair& pair) {
        std::uint32_t at = 0;
        if (unused_.empty()) {
            at = static_cast<std::uint32_t>(pairs_.size());
            pairs_.push_back(pair);
        } else {
            at = unused_.back();
            unused_.pop_back();
            pairs_[at] = pair;
        }
        order_.push_back({pair.lo, pair.size(), at});
        std::push_heap(order_.begin(), order_.end(), After());
    }
    /// Expects some.
    [[nodiscard]] SearchPair pop() {
        std::pop_heap(order_.begin(), order_.end(), After());
        const std::uint32_t at = order_.back().at;
        order_.pop_back();
        unused_.push_back(at);
        return pairs_[at];
    }
    void addTo(OpenPairs& pairs) const {
        for (const Entry& entry : order_) {
            pairs.push_back(pairs_[entry.at]);
        }
    }

  private:
    struct Entry {
        double lo = 0;
        std::int32_t size = 0;
        std::uint32_t at = 0;
    };
    struct After {
        bool operator()(const Entry& a, const Entry& b) const noexcept {
            return a.lo != b.lo ? a.lo > b.lo : a.size > b.size;
        }
    };

    std::vector<Entry> order_;
    std::vector<SearchPair> pairs_;
    std::vector<std::uint32_t> unused_; ///< places in `pairs_`
};

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/methods.h"

#include <array>
#include <string>
#include <vector>

/// Properties of each counting method and projection: one row each, in the order of their numbers. Checks,
/// requirements, options, the program and the lab use it. docs/change.md lists further steps for a new row.
namespace voxtact {

/// Device features of a method, as bits. gpu/requirements.cpp names and tests them.
enum MethodNeed : std::uint32_t {
    kNeedsNothing = 0,
    kNeedsPreciseQuery = 1U << 0U,
    kNeedsFragmentStores = 1U << 1U,
    kNeedsFragmentBallot = 1U << 2U,
    kNeedsComputeBuffers = 1U << 3U,
};

/// Coverage of the pixels of projections with pixels: methods of one kind count the same on every pose.
enum class Coverage {
    Rasteriser, ///< the device's, with its filters
    Computed,   ///< ours, the same bits everywhere
};

struct MethodRow {
    CountingMethod method;
    const char* name;
    bool host;  ///< needs no device
    bool query; ///< an occlusion query counts, so each pair is a draw
    Coverage coverage;
    bool certified; ///< can decide cells: answers the projection certified
    Exactness exactness;
    Filter filter;       ///< the default
    std::uint32_t needs; ///< MethodNeed
};

inline constexpr std::array kMethodTable{
    MethodRow{CountingMethod::Query, "query", false, true, Coverage::Rasteriser, false, Exactness::Exact,
              Filter::Hardware, kNeedsPreciseQuery},
    MethodRow{CountingMethod::QueryAny, "query-any", false, true, Coverage::Rasteriser, false, Exactness::LowerBound,
              Filter::Hardware, kNeedsNothing},
    MethodRow{CountingMethod::Atomic, "atomic", false, false, Coverage::Rasteriser, false, Exactness::Exact,
              Filter::Hardware, kNeedsFragmentStores},
    MethodRow{CountingMethod::Subgroup, "subgroup", false, false, Coverage::Rasteriser, false, Exactness::Exact,
              Filter::Hardware, kNeedsFragmentStores | kNeedsFragmentBallot},
    MethodRow{CountingMethod::Compute, "compute", false, false, Coverage::Computed, true, Exactness::Exact,
              Filter::Exact, kNeedsComputeBuffers},
    MethodRow{CountingMethod::Cpu, "cpu", true, false, Coverage::Computed, true, Exactness::Exact, Filter::Exact,
              kNeedsNothing},
};

struct ProjectionRow {
    Projection projection;
    const char* name;
    bool camera;         ///< looks through the batch's View
    std::uint32_t views; ///< of a pair, one after the other
    bool voxelGrid;      ///< its pixels are the volume's samples; uses samplesPerVoxel
    bool certified;      ///< decides cells with bounds; uses resolution and stopAtFirst
};

inline constexpr std::array kProjectionTable{
    ProjectionRow{Projection::View, "view", true, 1, false, false},
    ProjectionRow{Projection::TwoView, "two-view", true, 2, false, false},
    ProjectionRow{Projection::DominantAxis, "dominant-axis", false, 1, true, false},
    ProjectionRow{Projection::Certified, "certified", false, 1, false, true},
};

namespace detail {
template <class Table, class Key> constexpr bool isInOrder(const Table& table, Key key) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (static_cast<std::size_t>(key(table[i])) != i) {
            return false;
        }
    }
    return true;
}
} // namespace detail
static_assert(detail::isInOrder(kMethodTable, [](const MethodRow& row) { return row.method; }));
static_assert(detail::isInOrder(kProjectionTable, [](const ProjectionRow& row) { return row.projection; }));

/// Returns true if there is a row: the number of an enumeration may be arbitrary.
[[nodiscard]] constexpr bool isKnown(CountingMethod method) noexcept {
    return static_cast<std::size_t>(method) < kMethodTable.size();
}
[[nodiscard]] constexpr bool isKnown(Projection projection) noexcept {
    return static_cast<std::size_t>(projection) < kProjectionTable.size();
}

/// Returns the row of a known number.
[[nodiscard]] constexpr const MethodRow& rowOf(CountingMethod method) noexcept {
    return kMethodTable[static_cast<std::size_t>(method)];
}
[[nodiscard]] constexpr const ProjectionRow& rowOf(Projection projection) noexcept {
    return kProjectionTable[static_cast<std::size_t>(projection)];
}

/// Returns true if a method supports a projection, on a device with the features of both.
[[nodiscard]] constexpr bool answers(CountingMethod method, Projection projection) noexcept {
    return !rowOf(projection).certified || rowOf(method).certified;
}

/// Returns the methods of a kind that count all fragments: they must count the same on every pose.
[[nodiscard]] inline std::vector<CountingMethod> methodsThatCount(Coverage coverage) {
    std::vector<CountingMethod> methods;
    for (const MethodRow& row : kMethodTable) {
        if (row.coverage == coverage && row.exactness == Exactness::Exact) {
            methods.push_back(row.method);
        }
    }
    return methods;
}

/// "query, atomic and subgroup": the names of the methods for which `wanted` holds, with a word before the last.
template <class Wanted> [[nodiscard]] std::string methodNames(Wanted wanted, const std::string& last = " and ") {
    std::string names;
    std::string pending;
    for (const MethodRow& row : kMethodTable) {
        if (wanted(row)) {
            names += (names.empty() || pending.empty() ? "" : ", ") + pending;
            pending = row.name;
        }
    }
    return names.empty() ? pending : names + last + pending;
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/results.h"

#include <bit>
#include <random>
#include <tuple>
#include <vector>

namespace voxtact::test {

/// The vertices of a mesh after a smooth bend with some noise; sometimes everything falls onto one plane.
[[nodiscard]] std::vector<double> bent(std::mt19937_64& random, const MeshData& mesh, double size);
/// A size for it: a quarter of the diagonal.
[[nodiscard]] double bendSize(const Grid& grid);

/// What is in an answer, for comparisons.
[[nodiscard]] inline auto everythingOf(const BatchAnswer& answer) {
    std::vector<std::tuple<bool, bool, std::uint64_t>> pairs;
    for (const PairAnswer& pair : answer.pairs) {
        pairs.emplace_back(pair.hit, pair.possible, pair.count);
    }
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint64_t>> triangles;
    for (const TouchedTriangle& triangle : answer.triangles) {
        triangles.emplace_back(triangle.pair, triangle.triangle, triangle.count);
    }
    // Depths and values by their bits: among infinite voxels they are NaN.
    std::vector<std::tuple<std::uint32_t, std::uint32_t, Vec3, Vec3, std::uint64_t, std::uint64_t, std::int32_t>>
        contacts;
    const bool whole = answer.contactsFound == answer.contacts.size(); // or any may have been kept
    for (const Contact& contact : whole ? answer.contacts : std::vector<Contact>{}) {
        contacts.emplace_back(contact.pair, contact.triangle, contact.position, contact.normal,
                              std::bit_cast<std::uint64_t>(contact.depth), std::bit_cast<std::uint64_t>(contact.value),
                              contact.label);
    }
    std::vector<std::pair<Vec3, Vec3>> bounds;
    for (const std::optional<Box>& box : answer.bounds) {
        bounds.emplace_back(box ? box->lo : Vec3{}, box ? box->hi : Vec3{});
    }
    std::vector<std::tuple<std::uint32_t, std::int32_t, std::uint64_t>> labels;
    for (const LabelCount& label : answer.labels) {
        labels.emplace_back(label.pair, label.label, label.count);
    }
    return std::tuple(pairs, triangles, contacts, answer.contactsFound, bounds, labels);
}

} // namespace voxtact::test

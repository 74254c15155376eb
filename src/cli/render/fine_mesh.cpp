// SPDX-License-Identifier: MIT
#include "cli/render/fine_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace voxtact::app {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

class EdgeHalver {
  public:
    EdgeHalver(MeshData& mesh, double longest) : mesh_(mesh), longest_(longest) {}

    /// Halves long edges once; returns false if there was none, or there would be too many triangles.
    bool halve(std::size_t maxTriangles) {
        middles_.clear();
        std::vector<std::uint32_t> indices;
        for (std::size_t at = 0; at < mesh_.indices.size(); at += 3) {
            add({mesh_.indices[at], mesh_.indices[at + 1], mesh_.indices[at + 2]}, indices);
            if (indices.size() / 3 > maxTriangles) {
                return false;
            }
        }
        const bool halved = indices.size() > mesh_.indices.size();
        mesh_.indices = std::move(indices);
        return halved;
    }

  private:
    using Corners = std::array<std::uint32_t, 3>;

    [[nodiscard]] double lengthOf(std::uint32_t a, std::uint32_t b) const {
        const auto at = [&](std::uint32_t vertex, std::size_t axis) {
            return mesh_.positions[std::size_t{3} * vertex + axis];
        };
        return std::hypot(at(a, 0) - at(b, 0), at(a, 1) - at(b, 1), at(a, 2) - at(b, 2));
    }
    /// Returns the vertex in the middle of an edge; empty if the edge is short enough.
    std::uint32_t middleOf(std::uint32_t a, std::uint32_t b) {
        if (!(lengthOf(a, b) > longest_)) {
            return kNone;
        }
        const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
        const auto [found, isNew] = middles_.try_emplace(edge, static_cast<std::uint32_t>(mesh_.positions.size() / 3));
        if (isNew) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                mesh_.positions.push_back(mesh_.positions[std::size_t{3} * a + axis] / 2 +
                                          mesh_.positions[std::size_t{3} * b + axis] / 2);
            }
        }
        return found->second;
    }
    void add(Corners corners, std::vector<std::uint32_t>& out) {
        Corners middles{};
        std::size_t halved = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            middles[i] = middleOf(corners[i], corners[(i + 1) % 3]);
            halved += middles[i] != kNone ? 1 : 0;
        }
        // The edges to halve first.
        while (halved == 1 ? middles[0] == kNone : halved == 2 && middles[2] != kNone) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            std::rotate(middles.begin(), middles.begin() + 1, middles.end());
        }
        const auto [a, b, c] = corners;
        const auto [ab, bc, ca] = middles;
        const auto triangle = [&out](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
            out.insert(out.end(), {p, q, r});
        };
        switch (halved) {
        case 0:
            triangle(a, b, c);
            break;
        case 1:
            triangle(a, ab, c);
            triangle(ab, b, c);
            break;
        case 2:
            triangle(ab, b, bc);
            if (lengthOf(a, bc) < lengthOf(ab, c)) {
                triangle(a, ab, bc);
                triangle(a, bc, c);
            } else {
                triangle(a, ab, c);
                triangle(ab, bc, c);
            }
            break;
        default:
            triangle(a, ab, ca);
            triangle(ab, b, bc);
            triangle(ca, bc, c);
            triangle(ab, bc, ca);
        }
    }

    MeshData& mesh_;
    double longest_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_; ///< of edges, by their vertices
};

} // namespace

MeshData halveLongEdges(MeshData mesh, double maxLength, std::size_t maxTriangles) {
    EdgeHalver halver(mesh, maxLength);
    std::size_t vertices = mesh.positions.size();
    while (halver.halve(maxTriangles)) {
        vertices = mesh.positions.size();
    }
    // Left by an abandoned round.
    mesh.positions.resize(vertices);
    return mesh;
}

} // namespace voxtact::app

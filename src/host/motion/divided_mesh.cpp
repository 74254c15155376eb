// SPDX-License-Identifier: MIT
#include "host/motion/divided_mesh.h"
#include "core/geometry/recentre.h"
#include "voxtact/data.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

namespace voxtact::cpu {

namespace {

using glm::dvec3;
using Corners = std::array<std::uint32_t, 3>;

/// Maximum side of a piece, relative to its distance from the origin, and relative to the extent of the mesh.
constexpr double kOfDistance = 1.0 / 16;
constexpr double kOfReach = 1.0 / 64;
/// Maximum number of pieces; beyond it, they become larger.
constexpr std::size_t kMostPieces = std::size_t{1} << 18;

class Division {
  public:
    Division(const MeshImpl& mesh, double coarser)
        : offset_(mesh.origin.offset[0], mesh.origin.offset[1], mesh.origin.offset[2]),
          ofDistance_(kOfDistance * coarser) {
        positions_.resize(std::size_t{3} * mesh.facts.vertices);
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const std::size_t to = std::size_t{3} * mesh.vertices[i];
            positions_[to] = mesh.x[i];
            positions_[to + 1] = mesh.y[i];
            positions_[to + 2] = mesh.z[i];
        }
        double square = 0;
        for (std::uint32_t i = 0; i < mesh.facts.vertices; ++i) {
            square = std::max(square, glm::dot(at(i), at(i)));
        }
        least_ = std::sqrt(square) * kOfReach * coarser;
    }

    /// False: there are too many pieces.
    bool run(const std::vector<std::uint32_t>& indices) {
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            waiting_.push_back({indices[i], indices[i + 1], indices[i + 2]});
            while (!waiting_.empty()) {
                const Corners piece = waiting_.back();
                waiting_.pop_back();
                if (!divide(piece)) {
                    pieces_.insert(pieces_.end(), piece.begin(), piece.end());
                }
            }
            if (divided_ && pieces_.size() + indices.size() - i > 3 * kMostPieces) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool isDivided() const noexcept { return divided_; }
    [[nodiscard]] FloatMesh view() const noexcept { return {positions_, pieces_}; }

  private:
    /// In object space.
    [[nodiscard]] dvec3 at(std::uint32_t vertex) const {
        const float* from = positions_.data() + std::size_t{3} * vertex;
        return dvec3(from[0], from[1], from[2]) + offset_;
    }

    /// Splits a triangle at its longest side if that is too long.
    bool divide(const Corners& piece) {
        std::size_t longest = 0;
        double most = 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < 3; ++i) {
            const double side = glm::distance(at(piece[i]), at(piece[(i + 1) % 3]));
            nearest = std::min(nearest, glm::length(at(piece[i])));
            if (side > most) {
                most = side;
                longest = i;
            }
        }
        if (!(most > std::max(least_, (nearest - most) * ofDistance_))) {
            return false;
        }
        const std::uint32_t from = piece[longest];
        const std::uint32_t to = piece[(longest + 1) % 3];
        const std::uint32_t third = piece[(longest + 2) % 3];
        const std::uint32_t middle = middleOf(from, to);
        if (at(middle) == at(from) || at(middle) == at(to)) {
            return false; // floats have none between them
        }
        waiting_.push_back({from, middle, third});
        waiting_.push_back({middle, to, third});
        divided_ = true;
        return true;
    }

    std::uint32_t middleOf(std::uint32_t a, std::uint32_t b) {
        const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
        const auto [found, isNew] = middles_.try_emplace(key, static_cast<std::uint32_t>(positions_.size() / 3));
        if (isNew) {
            const dvec3 middle = at(a) * 0.5 + at(b) * 0.5 - offset_;
            for (int axis = 0; axis < 3; ++axis) {
                positions_.push_back(static_cast<float>(middle[axis]));
            }
        }
        return found->second;
    }

    dvec3 offset_;
    double ofDistance_;
    double least_ = 0;
    bool divided_ = false;
    std::vector<float> positions_;
    std::vector<std::uint32_t> pieces_;
    std::vector<Corners> waiting_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

} // namespace

std::unique_ptr<MeshImpl> dividedMesh(const MeshImpl& mesh) {
    const std::vector<std::uint32_t> indices = mesh.indices();
    for (double coarser = 1; indices.size() / 3 <= kMostPieces; coarser *= 2) {
        Division division(mesh, coarser);
        if (!division.run(indices)) {
            continue;
        }
        if (!division.isDivided()) {
            return nullptr;
        }
        const FloatMesh pieces = division.view();
        MeshFacts facts = mesh.facts;
        facts.vertices = static_cast<std::uint32_t>(pieces.positions.size() / 3);
        facts.triangles = static_cast<std::uint32_t>(pieces.indices.size() / 3);
        return std::make_unique<MeshImpl>(pieces, facts, mesh.origin);
    }
    return nullptr;
}

} // namespace voxtact::cpu

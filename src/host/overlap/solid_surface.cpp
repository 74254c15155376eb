// SPDX-License-Identifier: MIT
#include "host/overlap/solid_surface.h"
#include "core/geometry/holes.h"
#include "host/overlap/solid_triangles.h"
#include "host/overlap/triangle_pieces.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// By place: the triangles that may intersect each triangle.
using Others = std::vector<std::vector<std::size_t>>;

Others othersOf(const SolidTriangles& triangles) {
    Others others(triangles.count());
    for (std::size_t place = 0; place < triangles.count(); ++place) {
        if (triangles.weight(place) == 0) {
            continue;
        }
        const SolidBox box = triangles.box(place);
        triangles.descend([&](const SolidBox& run) { return box.meets(run); },
                          [&](std::size_t other) {
                              if (other > place && box.meets(triangles.box(other)) &&
                                  !certainlyApart(triangles.at(place), triangles.at(other))) {
                                  others[place].push_back(other);
                                  others[other].push_back(place);
                              }
                              return true;
                          });
    }
    return others;
}

/// Triangles that are apart from all others and hang together by sides of two triangles: along all of them the winding
/// numbers of both sides are the same.
class Patches {
  public:
    Patches(const SolidTriangles& triangles, const Others& others) : parents_(triangles.count()) {
        std::iota(parents_.begin(), parents_.end(), std::size_t{0});
        std::vector<Side> sides;
        for (std::size_t place = 0; place < triangles.count(); ++place) {
            if (triangles.weight(place) == 0) {
                continue;
            }
            const auto& v = triangles.at(place).vertices;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t from = v[i];
                const std::uint32_t to = v[(i + 1) % 3];
                sides.push_back({std::min(from, to), std::max(from, to), place, from < to});
            }
        }
        std::ranges::sort(sides, [](const Side& x, const Side& y) {
            return x.a != y.a ? x.a < y.a : (x.b != y.b ? x.b < y.b : x.place < y.place);
        });
        for (std::size_t i = 0; i < sides.size();) {
            std::size_t end = i + 1;
            while (end < sides.size() && sides[end].a == sides[i].a && sides[end].b == sides[i].b) {
                ++end;
            }
            if (end == i + 2 && sides[i].up != sides[i + 1].up && others[sides[i].place].empty() &&
                others[sides[i + 1].place].empty()) {
                parents_[find(sides[i].place)] = find(sides[i + 1].place);
            }
            i = end;
        }
    }

    /// The patch of a triangle, as the place of one in it.
    [[nodiscard]] std::size_t find(std::size_t place) {
        while (parents_[place] != place) {
            parents_[place] = parents_[parents_[place]];
            place = parents_[place];
        }
        return place;
    }

  private:
    struct Side {
        std::uint32_t a = 0;
        std::uint32_t b = 0;
        std::size_t place = 0;
        bool up = false;
    };
    std::vector<std::size_t> parents_;
};

double areaOf(const SolidTriangle& triangle) {
    const auto& c = triangle.corners;
    return glm::length(glm::cross(c[1] - c[0], c[2] - c[0])) / 2;
}

/// The largest triangle of each patch: the best origin of a ray.
std::vector<std::size_t> largestOfPatches(const SolidTriangles& triangles, Patches& patches) {
    std::vector<std::size_t> largest(triangles.count(), triangles.count());
    std::vector<double> area(triangles.count(), -1);
    for (std::size_t place = 0; place < triangles.count(); ++place) {
        const double own = areaOf(triangles.at(place));
        const std::size_t patch = patches.find(place);
        if (triangles.weight(place) != 0 && own > area[patch]) {
            area[patch] = own;
            largest[patch] = place;
        }
    }
    return largest;
}

Jump jumpOf(const SolidTriangles& triangles, std::size_t place) {
    const auto& corners = triangles.at(place).corners;
    const int weight = triangles.weight(place);
    const std::optional<int> front =
        triangles.windingInFront(place, (corners[0] + corners[1] + corners[2]) / 3.0, {{place}}, weight);
    return front ? static_cast<Jump>((*front + weight != 0 ? 1 : 0) - (*front != 0 ? 1 : 0)) : kUnknownJump;
}

void findJumps(const SolidTriangles& triangles, SolidSurface& out) {
    const Others others = othersOf(triangles);
    Patches patches(triangles, others);
    const std::vector<std::size_t> largest = largestOfPatches(triangles, patches);
    std::vector<Jump> ofPatch(triangles.count(), kUnknownJump);
    out.jumps.assign(triangles.count(), 0);
    for (std::size_t place = 0; place < triangles.count(); ++place) {
        if (triangles.weight(place) == 0) {
            continue;
        }
        if (!others[place].empty()) {
            out.jumps[place] = addPieces(triangles, place, others[place], out.pieces) ? kInPieces : kUnknownJump;
            continue;
        }
        const std::size_t patch = patches.find(place);
        if (ofPatch[patch] == kUnknownJump) {
            ofPatch[patch] = jumpOf(triangles, largest[patch]);
        }
        out.jumps[place] = ofPatch[patch];
    }
}

double longestOf(const SolidTriangles& triangles, const SurfaceHoles& holes) {
    std::vector<dvec3> places(3 * triangles.count());
    for (std::size_t place = 0; place < triangles.count(); ++place) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t vertex = triangles.at(place).vertices[i];
            places.resize(std::max<std::size_t>(places.size(), std::size_t{vertex} + 1));
            places[vertex] = triangles.at(place).corners[i];
        }
    }
    double longest = 0;
    for (const HoleLoop& loop : holes.loops) {
        double length = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            length += glm::length(places[loop[(i + 1) % loop.size()]] - places[loop[i]]);
        }
        longest = std::max(longest, length);
    }
    return longest;
}

/// Sums up the volume of a solid from a point near it.
class VolumeSum {
  public:
    explicit VolumeSum(const dvec3& middle) : middle_(middle) {}

    /// `share`: of the triangle's area.
    void add(const SolidTriangle& triangle, Jump jump, double share) {
        const auto& corners = triangle.corners;
        const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double own = share * glm::dot(corners[0] - middle_, normal) / 6;
        magnitudes_ += glm::length(corners[0] - middle_) * glm::length(corners[1] - corners[0]) *
                       glm::length(corners[2] - corners[0]);
        ++count_;
        if (jump == kUnknownJump) {
            unknown_ += std::abs(own);
        } else {
            volume_ += jump * own;
        }
    }
    [[nodiscard]] double volume() const { return volume_; }
    [[nodiscard]] double error() const { return unknown_ + magnitudes_ * (0x1p-46 + 0x1p-52 * count_); }

  private:
    dvec3 middle_;
    double volume_ = 0;
    double unknown_ = 0;
    double magnitudes_ = 0;
    double count_ = 0;
};

} // namespace

SolidSurface::SolidSurface(const MeshImpl& mesh) {
    const SolidTriangles triangles(mesh);
    const SurfaceHoles holes = findHoles(triangles.indices());
    facts.holes = static_cast<std::uint32_t>(holes.loops.size());
    facts.openEdges = holes.openEdges;
    if (facts.holes > 0) {
        facts.longestHole = longestOf(triangles, holes);
        return;
    }
    findJumps(triangles, *this);
    dvec3 middle{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        middle[axis] = (mesh.facts.bounds.lo[at] + mesh.facts.bounds.hi[at]) / 2 - mesh.origin.offset[at];
    }
    VolumeSum sum(middle);
    for (std::uint32_t place = 0; place < triangles.count(); ++place) {
        area += jumps[place] != 0 ? areaOf(triangles.at(place)) : 0;
        if (jumps[place] != kInPieces) {
            sum.add(triangles.at(place), jumps[place], 1);
            continue;
        }
        for (const SolidPiece& piece : piecesOf(place)) {
            sum.add(triangles.at(place), piece.jump, 2 * piece.polygon.area());
        }
    }
    volume = sum.volume();
    volumeError = sum.error();
}

std::span<const SolidPiece> SolidSurface::piecesOf(std::uint32_t place) const noexcept {
    const auto first = std::ranges::lower_bound(pieces, place, {}, &SolidPiece::place);
    return {first, std::ranges::upper_bound(pieces, place, {}, &SolidPiece::place)};
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/holes.h"
#include "core/geometry/recentre.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

Vec3 vertexOf(std::span<const double> positions, std::uint32_t vertex) {
    const std::size_t at = std::size_t{3} * vertex;
    return {positions[at], positions[at + 1], positions[at + 2]};
}

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// From the middle of the box, against cancellation.
double signedVolume(const MeshView& mesh, const Box& bounds) {
    Vec3 middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        middle[axis] = bounds.lo[axis] / 2 + bounds.hi[axis] / 2;
    }
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3 a = minus(vertexOf(mesh.positions, mesh.indices[i]), middle);
        const Vec3 b = minus(vertexOf(mesh.positions, mesh.indices[i + 1]), middle);
        const Vec3 c = minus(vertexOf(mesh.positions, mesh.indices[i + 2]), middle);
        const Vec3 normal = cross(b, c);
        sum += a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2];
    }
    return sum / 6;
}

double lengthOf(const HoleLoop& loop, std::span<const double> positions) {
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3 side = minus(vertexOf(positions, loop[(i + 1) % loop.size()]), vertexOf(positions, loop[i]));
        length += std::hypot(side[0], side[1], side[2]);
    }
    return length;
}

SurfaceHoles holesOf(const MeshView& mesh) {
    const std::vector<std::uint32_t> welded = weldedVertices(mesh.positions);
    std::vector<std::uint32_t> indices(mesh.indices.begin(), mesh.indices.end());
    for (std::uint32_t& index : indices) {
        index = welded[index];
    }
    return findHoles(indices);
}

/// Closes a loop by triangles around the mean of its corners. Returns their area.
double addFan(MeshData& mesh, const HoleLoop& loop) {
    Vec3 mean{};
    for (const std::uint32_t vertex : loop) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            mean[axis] += mesh.positions[std::size_t{3} * vertex + axis] / static_cast<double>(loop.size());
        }
    }
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    mesh.positions.insert(mesh.positions.end(), mean.begin(), mean.end());
    double area = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t from = loop[i];
        const std::uint32_t to = loop[(i + 1) % loop.size()];
        mesh.indices.insert(mesh.indices.end(), {to, from, middle});
        const Vec3 normal =
            cross(minus(vertexOf(mesh.positions, from), mean), minus(vertexOf(mesh.positions, to), mean));
        area += std::hypot(normal[0], normal[1], normal[2]) / 2;
    }
    return area;
}

} // namespace

Result<SolidFacts> checkSolid(const MeshView& mesh) {
    return guard([&]() -> Result<SolidFacts> {
        const Result<MeshFacts> checked = checkMesh(mesh);
        VOXTACT_TRY(checked);
        const SurfaceHoles holes = holesOf(mesh);
        SolidFacts facts;
        facts.holes = static_cast<std::uint32_t>(holes.loops.size());
        facts.openEdges = holes.openEdges;
        facts.nonManifold = holes.nonManifold;
        for (const HoleLoop& loop : holes.loops) {
            facts.longestHole = std::max(facts.longestHole, lengthOf(loop, mesh.positions));
        }
        facts.signedVolume = signedVolume(mesh, checked->bounds);
        facts.inward = facts.signedVolume < 0;
        return facts;
    });
}

std::string holesText(const SolidFacts& facts) {
    if (facts.holes == 0) {
        return {};
    }
    return std::to_string(facts.holes) + (facts.holes == 1 ? " hole" : " holes") + " with " +
           std::to_string(facts.openEdges) + (facts.openEdges == 1 ? " open edge" : " open edges") + " (longest " +
           number(facts.longestHole) + " object units around); fill the holes";
}

Result<FilledMesh> fillHoles(const MeshView& mesh) {
    return guard([&]() -> Result<FilledMesh> {
        VOXTACT_TRY(checkMesh(mesh));
        FilledMesh filled;
        filled.mesh.deflection = mesh.deflection;
        filled.mesh.positions.assign(mesh.positions.begin(), mesh.positions.end());
        filled.mesh.indices.assign(mesh.indices.begin(), mesh.indices.end());
        const SurfaceHoles holes = holesOf(mesh);
        filled.holes = static_cast<std::uint32_t>(holes.loops.size());
        const std::size_t vertices = mesh.positions.size() / 3 + holes.loops.size();
        if (vertices > std::numeric_limits<std::uint32_t>::max() / 3) {
            return refuse("the mesh with its holes filled has too many vertices");
        }
        for (const HoleLoop& loop : holes.loops) {
            filled.area += addFan(filled.mesh, loop);
        }
        return filled;
    });
}

} // namespace voxtact

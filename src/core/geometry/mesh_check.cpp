// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/mesh_vertex.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

/// Twice the area is the length of the cross product. Products of two floats are exact in double, so that a triangle
/// whose corners are in one line in float is found to be so unless their differences round.
bool isDegenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Vec3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2] && u[0] * v[1] == u[1] * v[0];
}

Result<void> checkArrays(const MeshView& mesh) {
    if (mesh.positions.size() % 3 != 0) {
        return refuse("the mesh has " + std::to_string(mesh.positions.size()) + " coordinates, not three a vertex");
    }
    if (mesh.indices.size() % 3 != 0) {
        return refuse("the mesh has " + std::to_string(mesh.indices.size()) + " indices, not three a triangle");
    }
    if (mesh.indices.empty()) {
        return refuse("the mesh has no triangles");
    }
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
    if (mesh.positions.size() / 3 > kMost || mesh.indices.size() / 3 > kMost) {
        return refuse("the mesh has more than " + std::to_string(kMost) + " vertices or triangles");
    }
    return {};
}

} // namespace

Result<MeshFacts> checkMesh(const MeshView& mesh) {
    return guard([&]() -> Result<MeshFacts> {
        VOXTACT_TRY(checkArrays(mesh));
        MeshFacts facts;
        facts.vertices = static_cast<std::uint32_t>(mesh.positions.size() / 3);
        facts.triangles = static_cast<std::uint32_t>(mesh.indices.size() / 3);
        facts.bounds = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const auto coordinate = static_cast<double>(mesh.positions[i]);
            if (!std::isfinite(coordinate)) {
                return refuse("vertex " + std::to_string(i / 3) + " of the mesh has a coordinate that is " +
                              (std::isnan(coordinate) ? "NaN" : "infinite"));
            }
            facts.bounds.lo[i % 3] = std::min(facts.bounds.lo[i % 3], coordinate);
            facts.bounds.hi[i % 3] = std::max(facts.bounds.hi[i % 3], coordinate);
        }
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            if (mesh.indices[i] >= facts.vertices) {
                return refuse("triangle " + std::to_string(i / 3) + " of the mesh uses vertex " +
                              std::to_string(mesh.indices[i]) + ", the mesh has " + std::to_string(facts.vertices) +
                              " vertices");
            }
        }
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            facts.degenerate += isDegenerate(vertexOf(mesh, mesh.indices[i]), vertexOf(mesh, mesh.indices[i + 1]),
                                             vertexOf(mesh, mesh.indices[i + 2]))
                                    ? 1U
                                    : 0U;
        }
        return facts;
    });
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/recentre.h"
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
    if (!(mesh.deflection >= 0) || !std::isfinite(mesh.deflection)) {
        return refuse("the deflection of the mesh is not a number from 0 mm on");
    }
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
    if (mesh.positions.size() / 3 > kMost || mesh.indices.size() / 3 > kMost) {
        return refuse("the mesh has more than " + std::to_string(kMost) + " vertices or triangles");
    }
    return {};
}

Result<MeshFacts> checkVertices(std::span<const double> positions) {
    MeshFacts facts;
    facts.vertices = static_cast<std::uint32_t>(positions.size() / 3);
    facts.bounds = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double coordinate = positions[i];
        if (!std::isfinite(static_cast<float>(coordinate))) {
            const char* wrong = std::isnan(coordinate)   ? "NaN"
                                : std::isinf(coordinate) ? "infinite"
                                                         : "beyond the range of floats";
            return refuse("vertex " + std::to_string(i / 3) + " of the mesh has a coordinate that is " + wrong);
        }
        facts.bounds.lo[i % 3] = std::min(facts.bounds.lo[i % 3], coordinate);
        facts.bounds.hi[i % 3] = std::max(facts.bounds.hi[i % 3], coordinate);
    }
    return facts;
}

std::uint32_t degenerateOf(std::span<const float> positions, std::span<const std::uint32_t> indices) {
    const auto vertex = [&](std::uint32_t index) {
        const float* at = positions.data() + std::size_t{3} * index;
        return Vec3{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
    };
    std::uint32_t degenerate = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        degenerate += isDegenerate(vertex(indices[i]), vertex(indices[i + 1]), vertex(indices[i + 2])) ? 1U : 0U;
    }
    return degenerate;
}

} // namespace

Result<CheckedMesh> checkedMesh(const MeshView& mesh) {
    return guard([&]() -> Result<CheckedMesh> {
        VOXTACT_TRY(checkArrays(mesh));
        Result<MeshFacts> facts = checkVertices(mesh.positions);
        VOXTACT_TRY(facts);
        facts->triangles = static_cast<std::uint32_t>(mesh.indices.size() / 3);
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            if (mesh.indices[i] >= facts->vertices) {
                return refuse("triangle " + std::to_string(i / 3) + " of the mesh uses vertex " +
                              std::to_string(mesh.indices[i]) + ", the mesh has " + std::to_string(facts->vertices) +
                              " vertices");
            }
        }
        Recentred floats = recentred(mesh.positions);
        facts->degenerate = degenerateOf(floats.positions, mesh.indices);
        facts->rounding = floats.origin.rounding;
        facts->deflection = mesh.deflection;
        return CheckedMesh{*facts, floats.origin, std::move(floats.positions)};
    });
}

Result<MeshFacts> checkMesh(const MeshView& mesh) {
    const Result<CheckedMesh> checked = checkedMesh(mesh);
    VOXTACT_TRY(checked);
    return checked->facts;
}

} // namespace voxtact

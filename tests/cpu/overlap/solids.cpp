// SPDX-License-Identifier: MIT
#include "cpu/overlap/solids.h"
#include "core/geometry/vec3.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace voxtact::test {

namespace {

using Corners = std::array<Vec3, 3>;

Vec3 vertexOf(const MeshData& mesh, std::size_t number) {
    const double* at = &mesh.positions[3 * number];
    return {at[0], at[1], at[2]};
}

std::vector<Corners> trianglesOf(const MeshData& mesh, const Mat4& pose) {
    std::vector<Corners> out(mesh.indices.size() / 3);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        out[i / 3][i % 3] = transformPoint(pose, vertexOf(mesh, mesh.indices[i]));
    }
    return out;
}

std::uint32_t addVertex(MeshData& mesh, const Vec3& at) {
    mesh.positions.insert(mesh.positions.end(), at.begin(), at.end());
    return static_cast<std::uint32_t>(mesh.positions.size() / 3 - 1);
}

void addFace(MeshData& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// How much of a tetrahedron is where a linear function with these values at its corners is at least 0. No term is
/// negative, so that nothing cancels out.
long double fractionAbove(std::array<long double, 4> v) {
    std::sort(v.begin(), v.end(), std::greater<>());
    // Of an edge from a corner that is above to one that is below, the part that is above.
    const auto part = [&](std::size_t above, std::size_t below) { return v[above] / (v[above] - v[below]); };
    switch (std::count_if(v.begin(), v.end(), [](long double value) { return value >= 0; })) {
    case 0:
        return 0;
    case 1:
        return part(0, 1) * part(0, 2) * part(0, 3);
    case 2:
        return part(0, 2) * part(0, 3) + part(1, 3) * part(0, 2) * (1 - part(0, 3)) +
               (1 - part(0, 2)) * part(1, 3) * part(1, 2);
    case 3:
        return 1 - (1 - part(0, 3)) * (1 - part(1, 3)) * (1 - part(2, 3));
    default:
        return 1;
    }
}

MeshData noisy(std::mt19937_64& random, const MeshData& mesh, double noise) {
    return mapped(mesh, [&](const Vec3& at) {
        return Vec3{at[0] + uniform(random, -noise, noise), at[1] + uniform(random, -noise, noise),
                    at[2] + uniform(random, -noise, noise)};
    });
}

MeshData randomPiece(std::mt19937_64& random, double size) {
    switch (below(random, 5)) {
    case 0:
        return solidBox({-size, -size * uniform(random, 0.1, 1), -size * uniform(random, 0.1, 1)},
                        {size * uniform(random, 0.1, 1), size * uniform(random, 0.1, 1), size});
    case 1:
        return solidPrism(static_cast<std::uint32_t>(3 + below(random, 8)), size, size * uniform(random, 0.05, 2),
                          chance(random, 0.5));
    case 2: // of which parts are turned inside out
        return noisy(random, solidBall(size, 1), size * uniform(random, 0, 0.6));
    case 3: {
        const double inner = size * uniform(random, 0.3, 0.9);
        MeshData hole = solidBall(inner, 1);
        return joined(solidBall(size, 1), chance(random, 0.7) ? reversed(std::move(hole)) : hole);
    }
    default:
        break;
    }
    return noisy(random, solidBall(size, 2), size * uniform(random, 0, 0.1));
}

} // namespace

MeshData solidBox(const Vec3& lo, const Vec3& hi) {
    MeshData mesh;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        addVertex(mesh, {(corner & 1U) != 0 ? hi[0] : lo[0], (corner & 2U) != 0 ? hi[1] : lo[1],
                         (corner & 4U) != 0 ? hi[2] : lo[2]});
    }
    mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

MeshData solidPrism(std::uint32_t sides, double radius, double height, bool star) {
    MeshData mesh;
    const std::uint32_t corners = star ? 2 * sides : sides;
    const std::uint32_t low = addVertex(mesh, {0, 0, -height / 2});
    const std::uint32_t high = addVertex(mesh, {0, 0, height / 2});
    for (std::uint32_t i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const double from = star && i % 2 == 1 ? 0.4 * radius : radius;
        addVertex(mesh, {from * std::cos(angle), from * std::sin(angle), -height / 2});
        addVertex(mesh, {from * std::cos(angle), from * std::sin(angle), height / 2});
    }
    for (std::uint32_t i = 0; i < corners; ++i) {
        const std::uint32_t a = 2 + 2 * i;
        const std::uint32_t b = 2 + 2 * ((i + 1) % corners);
        addFace(mesh, low, b, a);
        addFace(mesh, high, a + 1, b + 1);
        addFace(mesh, a, b, b + 1);
        addFace(mesh, a, b + 1, a + 1);
    }
    return mesh;
}

MeshData solidBall(double radius, std::uint32_t level) {
    return mapped(take(makeEllipsoid(8U << (2 * level))), [&](const Vec3& at) {
        return Vec3{radius * at[0] / 20, radius * at[1] / 30, radius * at[2] / 40};
    });
}

MeshData reversed(MeshData mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::swap(mesh.indices[i], mesh.indices[i + 1]);
    }
    return mesh;
}

MeshData joined(MeshData mesh, const MeshData& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const std::uint32_t index : other.indices) {
        mesh.indices.push_back(first + index);
    }
    return mesh;
}

MeshData unshared(const MeshData& mesh) {
    MeshData out;
    for (const std::uint32_t index : mesh.indices) {
        out.indices.push_back(addVertex(out, vertexOf(mesh, index)));
    }
    return out;
}

MeshData mapped(MeshData mesh, const std::function<Vec3(const Vec3&)>& map) {
    for (std::size_t i = 0; i < mesh.positions.size() / 3; ++i) {
        const Vec3 at = map(vertexOf(mesh, i));
        std::copy(at.begin(), at.end(), mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return mesh;
}

MeshData transformed(const MeshData& mesh, const Mat4& matrix) {
    return mapped(mesh, [&](const Vec3& at) { return transformPoint(matrix, at); });
}

MeshData randomSolid(std::mt19937_64& random, double size) {
    MeshData mesh;
    for (std::size_t pieces = 1 + below(random, 2) * below(random, 3); pieces > 0; --pieces) {
        const double part = size * uniform(random, 0.4, 1);
        const Vec3 by{uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
        MeshData piece = transformed(randomPiece(random, part), multiply(translation(by), randomRotation(random)));
        mesh = joined(std::move(mesh), chance(random, 0.3) ? reversed(std::move(piece)) : piece);
    }
    return chance(random, 0.3) ? unshared(mesh) : mesh;
}

int windingNumber(const MeshData& mesh, const Mat4& pose, const Vec3& point) {
    double sum = 0;
    for (const Corners& corners : trianglesOf(mesh, pose)) {
        const Vec3 a = minus(corners[0], point);
        const Vec3 b = minus(corners[1], point);
        const Vec3 c = minus(corners[2], point);
        const double x = length(a);
        const double y = length(b);
        const double z = length(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
    }
    return static_cast<int>(std::lround(sum / (4 * std::numbers::pi)));
}

double signedVolume(const MeshData& mesh, const Mat4& pose) {
    long double sum = 0;
    const std::vector<Corners> triangles = trianglesOf(mesh, pose);
    const Vec3 apex = triangles.front()[0];
    for (const Corners& t : triangles) {
        sum += dot(minus(t[0], apex), cross(minus(t[1], apex), minus(t[2], apex)));
    }
    return static_cast<double>(sum / 6);
}

double signedVolumeAbove(const MeshData& mesh, const Mat4& pose, const Vec3& gradient, double offset) {
    long double sum = 0;
    const std::vector<Corners> triangles = trianglesOf(mesh, pose);
    const Vec3 apex = triangles.front()[0];
    const auto value = [&](const Vec3& at) { return static_cast<long double>(dot(gradient, at)) + offset; };
    for (const Corners& t : triangles) {
        const long double volume = dot(minus(t[0], apex), cross(minus(t[1], apex), minus(t[2], apex)));
        sum += volume * fractionAbove({value(apex), value(t[0]), value(t[1]), value(t[2])});
    }
    return static_cast<double>(sum / 6);
}

double lensVolume(double radius, double other, double distance) {
    if (distance >= radius + other) {
        return 0;
    }
    const double least = std::min(radius, other);
    if (distance <= std::abs(radius - other)) {
        return 4 * std::numbers::pi / 3 * least * least * least;
    }
    const double reach = radius + other - distance;
    return std::numbers::pi * reach * reach *
           (distance * distance + 2 * distance * (radius + other) - 3 * (radius - other) * (radius - other)) /
           (12 * distance);
}

} // namespace voxtact::test

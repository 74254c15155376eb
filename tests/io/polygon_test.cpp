// SPDX-License-Identifier: MIT
// Polygons are cut into triangles that do not overlap and are the polygon: none is turned the other way, and their
// areas sum to the polygon's (the shoelace formula).
#include "io_test_support.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace voxtact::test {
namespace {

using Polygon = std::vector<std::array<double, 2>>;

/// As an OBJ file in the plane through three given axes.
std::string objOf(const Polygon& polygon, const Vec3& u, const Vec3& v) {
    std::string text;
    std::string face = "f";
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        char line[128];
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", polygon[i][0] * u[0] + polygon[i][1] * v[0],
                      polygon[i][0] * u[1] + polygon[i][1] * v[1], polygon[i][0] * u[2] + polygon[i][1] * v[2]);
        text += line;
        face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
}

double shoelace(const Polygon& polygon) {
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto& a = polygon[i];
        const auto& b = polygon[(i + 1) % polygon.size()];
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return area;
}

/// Of each triangle, along the normal u x v.
std::vector<double> areas(const MeshData& mesh, const Vec3& u, const Vec3& v) {
    const Vec3 normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    std::vector<double> list;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        std::array<Vec3, 3> p{};
        for (std::size_t i = 0; i < 9; ++i) {
            p[i / 3][i % 3] = static_cast<double>(mesh.positions[std::size_t{3} * mesh.indices[t + i / 3] + i % 3]);
        }
        Vec3 a{};
        Vec3 b{};
        for (std::size_t i = 0; i < 3; ++i) {
            a[i] = p[1][i] - p[0][i];
            b[i] = p[2][i] - p[0][i];
        }
        const Vec3 n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        list.push_back((n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2]) / 2);
    }
    return list;
}

Result<MeshData> cut(const Polygon& polygon, const Vec3& u = {1, 0, 0}, const Vec3& v = {0, 1, 0}) {
    const std::string text = objOf(polygon, u, v);
    return io::readMesh(std::as_bytes(std::span(text)), "polygon.obj");
}

void expectCut(const Polygon& polygon, const Vec3& u = {1, 0, 0}, const Vec3& v = {0, 1, 0}) {
    const auto mesh = cut(polygon, u, v);
    ASSERT_TRUE(isOk(mesh)) << objOf(polygon, u, v);
    ASSERT_EQ(mesh->indices.size(), 3 * (polygon.size() - 2));
    const std::vector<double> parts = areas(*mesh, u, v);
    const double whole = shoelace(polygon);
    double sum = 0;
    for (const double part : parts) {
        EXPECT_GE(part / whole, -1e-5) << objOf(polygon, u, v);
        sum += part;
    }
    EXPECT_NEAR(sum / whole, 1, 1e-4) << objOf(polygon, u, v);
}

TEST(Polygons, Shapes) {
    expectCut({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    expectCut({{0, 0}, {0, 1}, {1, 1}, {1, 0}}); // the other way round
    expectCut({{0, 0}, {4, 0}, {1, 1}, {0, 4}}); // concave at each of its corners in turn
    expectCut({{4, 0}, {1, 1}, {0, 4}, {0, 0}});
    expectCut({{1, 1}, {0, 4}, {0, 0}, {4, 0}});
    expectCut({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}});
    expectCut({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}); // corners on its sides
    expectCut({{0, 0}, {2, 0}, {2, 2}, {2, 2}, {0, 2}, {0, 2}});                 // corners twice
    expectCut(
        {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}); // a hole and its bridge
    Polygon comb{{0, -1}};
    for (int i = 0; i < 100; ++i) {
        comb.insert(comb.begin(), {{1.0 * i, 10.0 * (i % 2)}});
    }
    comb.insert(comb.begin(), {99, -1});
    expectCut(comb, {1, 0, 0}, {0, 1, 0});
}

TEST(Polygons, RandomStarsInRandomPlanes) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
        const std::size_t corners = 3 + random() % 60;
        Polygon star;
        for (std::size_t k = 0; k < corners; ++k) {
            const double angle =
                2 * std::numbers::pi * (static_cast<double>(k) + 0.8 * unit(random)) / static_cast<double>(corners);
            const double radius = 1 + 50 * unit(random) * unit(random);
            star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        }
        const double yaw = 6.3 * unit(random);
        const double pitch = 6.3 * unit(random);
        expectCut(star, {std::cos(yaw), std::sin(yaw), 0},
                  {-std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch)});
    }
}

TEST(Polygons, Refusals) {
    constexpr const char* kCrosses = "a polygon cannot be cut into triangles (it crosses itself?)";
    expectRefused(cut({{0, 0}, {4, 1}, {4, 0}, {0, 2}}), kCrosses);
    expectRefused(cut({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), kCrosses);
    expectRefused(cut({{0, 3}, {2, -3}, {-3, 1}, {3, 1}, {-2, -3}}), kCrosses);
    Polygon saw;
    for (int i = 0; i < 5000; ++i) {
        saw.push_back({1.0 * i, 1.0 * (i % 2)});
    }
    saw.push_back({2500, 1000});
    expectRefused(cut(saw), "a polygon of 5001 corners is too large to be cut");
    const std::string far = "v -1e308 0 0\nv 1e308 0 0\nv 0 1 0\nv 0 2 0\nf 1 2 3 4\n";
    expectRefused(io::readMesh(std::as_bytes(std::span(far)), "m.obj"), "larger than a double");
}

/// Without area: whatever the cut, the triangles lie on the line, and none is dropped.
TEST(Polygons, OnALine) {
    const auto mesh = cut({{0, 0}, {1, 1}, {3, 3}, {2, 2}});
    ASSERT_TRUE(isOk(mesh));
    EXPECT_EQ(mesh->indices.size(), 6U);
    EXPECT_EQ(checkMesh(mesh->view())->degenerate, 2U);
}

/// A large convex polygon is a fan, however many corners it has.
TEST(Polygons, LargeFan) {
    Polygon disc;
    for (int i = 0; i < 20000; ++i) {
        disc.push_back({1000 * std::cos(std::numbers::pi * i / 10000), 1000 * std::sin(std::numbers::pi * i / 10000)});
    }
    expectCut(disc);
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
// Builtin meshes.
#include "core/geometry/vec3.h"
#include "support/refusal.h"
#include "voxtact/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace voxtact::test {
namespace {

constexpr std::uint32_t kSmallestScalpel = 86;

Vec3 vertex(const MeshData& mesh, std::uint32_t index) {
    return {mesh.positions[3 * index], mesh.positions[3 * index + 1], mesh.positions[3 * index + 2]};
}

struct Triangle {
    Vec3 a, b, c;

    Vec3 doubleArea() const { return cross(minus(b, a), minus(c, a)); }
    double longestEdge() const {
        double longest = 0;
        for (const Vec3& edge : {minus(b, a), minus(c, b), minus(a, c)}) {
            longest = std::max(longest, std::sqrt(dot(edge, edge)));
        }
        return longest;
    }
    /// 1 for an equilateral triangle, 0.577 for half a square, 0 for a degenerate one.
    double quality() const {
        const double longest = longestEdge();
        return std::sqrt(dot(doubleArea(), doubleArea())) / (longest * longest) * (2 / std::sqrt(3.0));
    }
};

std::vector<Triangle> triangles(const MeshData& mesh) {
    std::vector<Triangle> all;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        all.push_back(
            {vertex(mesh, mesh.indices[i]), vertex(mesh, mesh.indices[i + 1]), vertex(mesh, mesh.indices[i + 2])});
    }
    return all;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> directedEdges(const MeshData& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.emplace_back(mesh.indices[i + k], mesh.indices[i + (k + 1) % 3]);
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Each directed edge once, and its reverse once.
void expectClosedManifold(const MeshData& mesh) {
    const auto edges = directedEdges(mesh);
    EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end()) << "an edge is used twice in one direction";
    auto reversed = edges;
    for (auto& edge : reversed) {
        std::swap(edge.first, edge.second);
    }
    std::sort(reversed.begin(), reversed.end());
    EXPECT_EQ(edges, reversed) << "an edge has a triangle on one side only";
}

std::size_t componentCount(const MeshData& mesh) {
    std::vector<std::uint32_t> parents(mesh.positions.size() / 3);
    std::iota(parents.begin(), parents.end(), 0U);
    const auto root = [&](std::uint32_t v) {
        while (parents[v] != v) {
            v = parents[v] = parents[parents[v]];
        }
        return v;
    };
    for (const auto& [from, to] : directedEdges(mesh)) {
        parents[root(from)] = root(to);
    }
    std::size_t roots = 0;
    for (std::uint32_t v = 0; v < parents.size(); ++v) {
        roots += parents[v] == v ? 1 : 0;
    }
    return roots;
}

double volumeOf(const MeshData& mesh) {
    double sixfold = 0;
    for (const Triangle& t : triangles(mesh)) {
        sixfold += dot(t.a, cross(t.b, t.c));
    }
    return sixfold / 6;
}

Box boundsOf(const MeshData& mesh) {
    Box box{vertex(mesh, 0), vertex(mesh, 0)};
    for (std::uint32_t v = 0; v < mesh.positions.size() / 3; ++v) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], vertex(mesh, v)[axis]);
            box.hi[axis] = std::max(box.hi[axis], vertex(mesh, v)[axis]);
        }
    }
    return box;
}

void expectGoodSurface(const Result<MeshData>& made, std::uint32_t wanted) {
    ASSERT_TRUE(made.ok()) << made.error().text;
    const MeshData& mesh = *made;
    ASSERT_EQ(mesh.indices.size(), std::size_t{3} * wanted);
    ASSERT_EQ(mesh.positions.size() / 3, wanted / 2 + 2) << "the Euler characteristic is not 2";
    ASSERT_EQ(std::set<std::uint32_t>(mesh.indices.begin(), mesh.indices.end()).size(), mesh.positions.size() / 3);
    expectClosedManifold(mesh);
    EXPECT_EQ(componentCount(mesh), 1U);
    EXPECT_GT(volumeOf(mesh), 0);
    for (const Triangle& t : triangles(mesh)) {
        ASSERT_GT(t.quality(), 1e-4) << "a triangle is degenerate";
    }
}

std::vector<std::uint32_t> counts(std::uint32_t smallest) {
    constexpr std::uint32_t kSeed = 20240611;
    testing::Test::RecordProperty("seed", static_cast<int>(kSeed));
    std::printf("seed %u\n", kSeed);
    std::vector<std::uint32_t> all{smallest, smallest + 2, 100, 102, 3068, 3070, 49998};
    std::mt19937 random(kSeed);
    for (int i = 0; i < 20; ++i) {
        const std::uint32_t span = i < 10 ? 500 : 20000;
        all.push_back(smallest + 2 * (static_cast<std::uint32_t>(random()) % span));
    }
    return all;
}

TEST(BuiltinEllipsoid, HasExactlyAsManyTrianglesAsAsked) {
    for (const std::uint32_t wanted : counts(8)) {
        SCOPED_TRACE(wanted);
        const Result<MeshData> made = makeEllipsoid(wanted);
        expectGoodSurface(made, wanted);
        const Box box = boundsOf(*made);
        EXPECT_EQ(box.lo, (Vec3{-20, -30, -40}));
        EXPECT_EQ(box.hi, (Vec3{20, 30, 40}));
    }
}

TEST(BuiltinEllipsoid, FacesOutwardAndLiesOnTheSurface) {
    const Result<MeshData> made = makeEllipsoid(5000);
    ASSERT_TRUE(made.ok());
    for (const Triangle& t : triangles(*made)) {
        EXPECT_GT(dot(t.doubleArea(), t.a), 0);
        EXPECT_GT(t.quality(), 0.25);
        const Vec3 unit{t.a[0] / 20, t.a[1] / 30, t.a[2] / 40};
        EXPECT_NEAR(dot(unit, unit), 1, 1e-6);
    }
    EXPECT_NEAR(volumeOf(*made), 4.0 / 3 * 3.14159265358979 * 20 * 30 * 40, 300);
}

TEST(BuiltinScalpel, HasExactlyAsManyTrianglesAsAsked) {
    for (const std::uint32_t wanted : counts(kSmallestScalpel)) {
        SCOPED_TRACE(wanted);
        const Result<MeshData> made = makeScalpel(wanted);
        expectGoodSurface(made, wanted);
        const Box box = boundsOf(*made);
        EXPECT_EQ(box.lo, (Vec3{-1.5, -8, 0}));
        EXPECT_EQ(box.hi, (Vec3{1.5, 2, 150}));
    }
}

TEST(BuiltinScalpel, HasItsTipAtTheOriginAndAThinBlade) {
    const Result<MeshData> made = makeScalpel();
    ASSERT_TRUE(made.ok());
    double lowest = 0;
    for (std::uint32_t v = 0; v < made->positions.size() / 3; ++v) {
        const Vec3 p = vertex(*made, v);
        if (p[2] == 0) {
            EXPECT_EQ(p, (Vec3{0, 0, 0}));
        }
        if (p[2] <= 38) {
            EXPECT_LE(std::abs(p[0]), 0.25);
            lowest = std::min(lowest, p[1]);
        }
    }
    EXPECT_NEAR(lowest, -7, 1e-6);
}

// Needles are where the blade is thin; they must not be what the instrument consists of.
TEST(BuiltinScalpel, ConsistsOfDecentTriangles) {
    for (const std::uint32_t wanted : {kScalpelTriangles, 50000U}) {
        const Result<MeshData> made = makeScalpel(wanted);
        ASSERT_TRUE(made.ok());
        std::vector<double> qualities;
        for (const Triangle& t : triangles(*made)) {
            qualities.push_back(t.quality());
        }
        std::sort(qualities.begin(), qualities.end());
        EXPECT_GT(qualities[qualities.size() / 20], 0.25);
        EXPECT_GT(qualities[qualities.size() / 2], 0.55);
    }
}

// A flat side that faced inward anywhere would be an inverted triangle: seen from +x, the blade and the handle are
// covered once by triangles that face +x and once by others that face -x.
TEST(BuiltinScalpel, HasNoInvertedTriangle) {
    const Result<MeshData> made = makeScalpel();
    ASSERT_TRUE(made.ok());
    for (const Triangle& t : triangles(*made)) {
        const Vec3 normal = t.doubleArea();
        const double x = t.a[0] + t.b[0] + t.c[0];
        if (std::abs(normal[0]) > 0.1 * std::sqrt(dot(normal, normal))) {
            EXPECT_GT(normal[0] * x, 0);
        }
    }
}

/// All of its points are as far from the axis' inner piece as half the diameter.
TEST(BuiltinMesh, ANeedleIsRoundStraightAndClosed) {
    for (const auto& [name, radius, length] :
         {std::tuple{"needle", 1.0, 200.0}, {"needle:1.5:80.25", 0.75, 80.25}, {"needle:3:3", 1.5, 3.0}}) {
        SCOPED_TRACE(name);
        const Result<MeshData> made = makeBuiltinMesh(name);
        ASSERT_TRUE(made.ok());
        const Result<MeshFacts> facts = checkMesh(made->view());
        ASSERT_TRUE(facts.ok());
        EXPECT_EQ(facts->degenerate, 0U);
        EXPECT_EQ(facts->bounds.lo[2], 0);
        EXPECT_EQ(facts->bounds.hi[2], length);
        for (std::size_t i = 0; i < made->positions.size(); i += 3) {
            const double x = static_cast<double>(made->positions[i]);
            const double y = static_cast<double>(made->positions[i + 1]);
            const double z = static_cast<double>(made->positions[i + 2]);
            EXPECT_NEAR(std::hypot(x, y, z - std::clamp(z, radius, length - radius)), radius, 1e-5);
        }
        // Outward: the volume is that of a cylinder and a ball, less what 32 corners leave out.
        double volume = 0;
        for (std::size_t i = 0; i < made->indices.size(); i += 3) {
            const auto at = [&](std::size_t corner, std::size_t axis) {
                return static_cast<double>(made->positions[3 * made->indices[i + corner] + axis]);
            };
            volume += (at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) +
                       at(0, 1) * (at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2)) +
                       at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0))) /
                      6;
        }
        const double whole = 3.14159265 * radius * radius * (length - 2 * radius + 4.0 / 3 * radius);
        EXPECT_LT(volume, whole);
        EXPECT_GT(volume, 0.97 * whole);
    }
}

/// By how much of the radius the points of these triangles are inside the round needle, at most and at least.
std::pair<double, double> insideRound(const std::vector<Triangle>& all, double radius, double length) {
    constexpr int kSteps = 12;
    std::pair<double, double> range{1, -1};
    for (const Triangle& triangle : all) {
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; i + j <= kSteps; ++j) {
                Vec3 at{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    at[axis] =
                        (i * triangle.a[axis] + j * triangle.b[axis] + (kSteps - i - j) * triangle.c[axis]) / kSteps;
                }
                const double from = std::hypot(at[0], at[1], at[2] - std::clamp(at[2], radius, length - radius));
                range.first = std::min(range.first, 1 - from / radius);
                range.second = std::max(range.second, 1 - from / radius);
            }
        }
    }
    return range;
}

TEST(BuiltinMesh, ANeedleIsInsideTheRoundOneByWhatItSays) {
    const Result<MeshData> made = makeNeedle(2, 6);
    ASSERT_TRUE(made.ok());
    std::vector<Triangle> shaft;
    std::vector<Triangle> ends;
    for (const Triangle& triangle : triangles(*made)) {
        const auto [lo, hi] = std::minmax({triangle.a[2], triangle.b[2], triangle.c[2]});
        (lo < 1.5 && hi > 4.5 ? shaft : ends).push_back(triangle);
    }
    EXPECT_EQ(shaft.size(), 64U);
    const auto [shaftLeast, shaftMost] = insideRound(shaft, 1, 6);
    EXPECT_GT(shaftLeast, -1e-6);
    EXPECT_GT(shaftMost, 0.0045);
    EXPECT_LE(shaftMost, 0.005);
    const auto [endLeast, endMost] = insideRound(ends, 1, 6);
    EXPECT_GT(endLeast, -1e-6);
    EXPECT_GT(endMost, 0.009);
    EXPECT_LE(endMost, 0.01);
}

TEST(BuiltinMesh, IsTheSameEachTime) {
    for (const char* name : {"scalpel", "scalpel:4000", "ellipsoid:5000", "needle:1:50"}) {
        const Result<MeshData> first = makeBuiltinMesh(name);
        const Result<MeshData> second = makeBuiltinMesh(name);
        ASSERT_TRUE(first.ok() && second.ok());
        EXPECT_EQ(first->positions, second->positions);
        EXPECT_EQ(first->indices, second->indices);
    }
}

TEST(BuiltinMesh, RefusesImpossibleNumbersOfTriangles) {
    const std::map<std::string, std::vector<std::string>> refused{
        {"scalpel:3069", {"scalpel", "3069", "3068", "3070"}},
        {"ellipsoid:9", {"ellipsoid", "9", "8", "10"}},
        {"ellipsoid:7", {"at least 8"}},
        {"ellipsoid:0", {"at least 8"}},
        {"scalpel:84", {"at least " + std::to_string(kSmallestScalpel)}},
        {"ellipsoid:4294967295", {"16777216"}},
        {"needle:2", {"needle:DIAMETER:LENGTH"}},
        {"needle:2:x", {"needle:DIAMETER:LENGTH"}},
        {"needle:0:10", {"diameter 0 mm", "above 0"}},
        {"needle:3:2", {"length 2 mm", "no smaller"}},
        {"needle:nan:2", {"diameter nan mm"}},
    };
    for (const auto& [name, words] : refused) {
        SCOPED_TRACE(name);
        const Result<MeshData> made = makeBuiltinMesh(name);
        ASSERT_FALSE(made.ok());
        expectRefusal(made.error(), words);
    }
}

TEST(BuiltinMesh, RefusesNamesThatItDoesNotKnow) {
    for (const char* name : {"", "foo", "foo:12", "Scalpel", "scalpel "}) {
        SCOPED_TRACE(name);
        const Result<MeshData> made = makeBuiltinMesh(name);
        ASSERT_FALSE(made.ok());
        expectRefusal(made.error(), {"unknown builtin mesh '", "scalpel, ellipsoid"});
    }
    for (const char* name :
         {"scalpel:", "scalpel:x", "scalpel:-2", "scalpel:12 ", "scalpel:1:2", "scalpel:5000000000"}) {
        SCOPED_TRACE(name);
        const Result<MeshData> made = makeBuiltinMesh(name);
        ASSERT_FALSE(made.ok());
        expectRefusal(made.error(), {name, "not a number of triangles"});
    }
}

} // namespace
} // namespace voxtact::test

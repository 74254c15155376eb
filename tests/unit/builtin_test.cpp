// SPDX-License-Identifier: MIT
#include "voxtact/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace voxtact {
namespace {

constexpr std::uint32_t kSmallestScalpel = 86;

Vec3 vertex(const MeshData& mesh, std::uint32_t index) {
    return {mesh.positions[3 * index], mesh.positions[3 * index + 1], mesh.positions[3 * index + 2]};
}

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
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

TEST(BuiltinMesh, IsTheSameEachTime) {
    for (const char* name : {"scalpel", "scalpel:4000", "ellipsoid:5000", "needle:1:50"}) {
        const Result<MeshData> first = makeBuiltinMesh(name);
        const Result<MeshData> second = makeBuiltinMesh(name);
        ASSERT_TRUE(first.ok() && second.ok());
        EXPECT_EQ(first->positions, second->positions);
        EXPECT_EQ(first->indices, second->indices);
    }
}

void expectRefusal(const Error& error, const std::vector<std::string>& words) {
    EXPECT_EQ(error.code, ErrorCode::InvalidArgument);
    EXPECT_EQ(error.text.find('\n'), std::string::npos);
    for (const std::string& word : words) {
        EXPECT_NE(error.text.find(word), std::string::npos) << "'" << word << "' is not in: " << error.text;
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

template <class T> std::vector<T> scalars(const VolumeData& volume) {
    std::vector<T> all(volume.voxels.size() / sizeof(T));
    std::memcpy(all.data(), volume.voxels.data(), volume.voxels.size());
    return all;
}

template <class T> std::pair<T, T> range(const VolumeData& volume) {
    const std::vector<T> all = scalars<T>(volume);
    const auto [lowest, highest] = std::minmax_element(all.begin(), all.end());
    return {*lowest, *highest};
}

VolumeData madeVolume(const std::string& name) {
    Result<VolumeData> made = makeBuiltinVolume(name);
    EXPECT_TRUE(made.ok()) << made.error().text;
    return made.ok() ? *made : VolumeData{};
}

Vec3 worldAt(const Grid& grid, const Vec3& index) {
    Vec3 world = grid.origin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            world[row] += grid.direction[3 * axis + row] * grid.spacing[axis] * index[axis];
        }
    }
    return world;
}

void expectCentred(const Grid& grid) {
    const Vec3 centre = worldAt(grid, {(grid.size[0] - 1) / 2.0, (grid.size[1] - 1) / 2.0, (grid.size[2] - 1) / 2.0});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(centre[axis], 0, 1e-9);
        EXPECT_NEAR(grid.spacing[axis] * grid.size[axis], 200, 1e-9);
    }
}

TEST(BuiltinVolume, HasTheSizeAndTypeOfItsName) {
    const std::map<std::string, ScalarType> types{{"head", ScalarType::UInt8},     {"sphere", ScalarType::UInt8},
                                                  {"noise", ScalarType::UInt16},   {"ct", ScalarType::Int16},
                                                  {"shells", ScalarType::Float32}, {"vessels", ScalarType::UInt8}};
    const std::map<ScalarType, std::size_t> bytes{
        {ScalarType::UInt8, 1}, {ScalarType::UInt16, 2}, {ScalarType::Int16, 2}, {ScalarType::Float32, 4}};
    for (const auto& [stem, type] : types) {
        for (const std::uint32_t size : {4U, 5U, 33U, 64U, 128U}) {
            SCOPED_TRACE(stem + ":" + std::to_string(size));
            const VolumeData volume = madeVolume(size == 128 ? stem : stem + ":" + std::to_string(size));
            const std::uint32_t slices = stem == "ct" ? (size + 2) / 3 : stem == "vessels" ? (size + 1) / 2 : size;
            EXPECT_EQ(volume.grid.size, (std::array<std::uint32_t, 3>{size, size, slices}));
            EXPECT_EQ(volume.type, type);
            EXPECT_EQ(volume.name, stem);
            EXPECT_EQ(volume.voxels.size(), bytes.at(type) * size * size * slices);
            expectCentred(volume.grid);
        }
    }
}

TEST(BuiltinVolume, HeadHasLayersAndATransparentBoundary) {
    for (const char* name : {"head", "head:4", "head:7"}) {
        SCOPED_TRACE(name);
        const VolumeData head = madeVolume(name);
        const std::vector<std::uint8_t> voxels = scalars<std::uint8_t>(head);
        const std::size_t n = head.grid.size[0];
        for (std::size_t i = 0; i < voxels.size(); ++i) {
            const std::array<std::size_t, 3> at{i % n, i / n % n, i / n / n};
            if (std::any_of(at.begin(), at.end(), [&](std::size_t k) { return k == 0 || k == n - 1; })) {
                ASSERT_EQ(voxels[i], 0);
            }
        }
    }
    const std::vector<std::uint8_t> voxels = scalars<std::uint8_t>(madeVolume("head"));
    const std::set<std::uint8_t> tissues(voxels.begin(), voxels.end());
    for (const int tissue : {0, 45, 95, 150, 185, 225, 255}) {
        EXPECT_EQ(tissues.count(static_cast<std::uint8_t>(tissue)), 1U) << tissue;
    }
}

TEST(BuiltinVolume, SphereFallsFromItsCentre) {
    const VolumeData sphere = madeVolume("sphere:65");
    const std::vector<std::uint8_t> voxels = scalars<std::uint8_t>(sphere);
    const auto at = [&](std::size_t x) { return voxels[x + 65 * (32 + 65 * 32)]; };
    EXPECT_EQ(at(32), 255);
    EXPECT_EQ(at(0), 0);
    for (std::size_t x = 32; x < 64; ++x) {
        EXPECT_GE(at(x), at(x + 1));
        EXPECT_EQ(at(x), at(64 - x));
        EXPECT_NEAR(at(x), std::max(0.0, 255 * (1 - (static_cast<double>(x) - 32) / (0.45 * 65))), 0.51);
    }
}

TEST(BuiltinVolume, NoiseReachesBothEndsOfItsRangeAndIsSmooth) {
    EXPECT_EQ(range<std::uint16_t>(madeVolume("noise:4")), (std::pair<std::uint16_t, std::uint16_t>(0, 4095)));
    const VolumeData noise = madeVolume("noise");
    EXPECT_EQ(range<std::uint16_t>(noise), (std::pair<std::uint16_t, std::uint16_t>(0, 4095)));
    const std::vector<std::uint16_t> voxels = scalars<std::uint16_t>(noise);
    int steepest = 0;
    for (std::size_t i = 1; i < voxels.size(); ++i) {
        steepest = i % 128 == 0 ? steepest : std::max(steepest, std::abs(voxels[i] - voxels[i - 1]));
    }
    EXPECT_LT(steepest, 1200);
}

TEST(BuiltinVolume, CtIsObliqueAndAnisotropic) {
    const VolumeData ct = madeVolume("ct");
    EXPECT_EQ(range<std::int16_t>(ct), (std::pair<std::int16_t, std::int16_t>(-1024, 3071)));
    EXPECT_GT(ct.grid.spacing[2], 2.5 * ct.grid.spacing[0]);
    std::array<Vec3, 3> axes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        axes[axis] = {ct.grid.direction[3 * axis], ct.grid.direction[3 * axis + 1], ct.grid.direction[3 * axis + 2]};
        EXPECT_LT(axes[axis][axis], 0.99) << "this axis is hardly oblique";
    }
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(dot(axes[a], axes[b]), a == b ? 1 : 0, 1e-14);
        }
    }
    EXPECT_NEAR(dot(axes[0], cross(axes[1], axes[2])), 1, 1e-14);
}

TEST(BuiltinVolume, ShellsAreThinAndBetweenZeroAndOne) {
    const VolumeData shells = madeVolume("shells");
    const auto [lowest, highest] = range<float>(shells);
    EXPECT_EQ(lowest, 0.0F);
    EXPECT_LE(highest, 1.0F);
    EXPECT_GT(highest, 0.99F);
    const std::vector<float> voxels = scalars<float>(shells);
    const auto filled = std::count_if(voxels.begin(), voxels.end(), [](float v) { return v > 0; });
    EXPECT_LT(static_cast<double>(filled) / static_cast<double>(voxels.size()), 0.15);
}

TEST(BuiltinVolume, VesselsBranchAllOverASparseVolume) {
    const VolumeData vessels = madeVolume("vessels");
    EXPECT_EQ(range<std::uint8_t>(vessels), (std::pair<std::uint8_t, std::uint8_t>(0, 255)));
    EXPECT_GT(vessels.grid.spacing[2], 1.9 * vessels.grid.spacing[0]);
    const std::vector<std::uint8_t> voxels = scalars<std::uint8_t>(vessels);
    const std::size_t slice = 128UL * 128;
    const auto inSlice = [&](std::size_t z) {
        return std::count_if(voxels.begin() + static_cast<std::ptrdiff_t>(z * slice),
                             voxels.begin() + static_cast<std::ptrdiff_t>((z + 1) * slice),
                             [](std::uint8_t v) { return v >= 128; });
    };
    std::ptrdiff_t inside = 0;
    for (std::size_t z = 0; z < 64; ++z) {
        inside += inSlice(z);
    }
    const double share = static_cast<double>(inside) / static_cast<double>(voxels.size());
    EXPECT_GT(share, 0.01);
    EXPECT_LT(share, 0.1);
    // The trunk alone enters: a disc around the middle of the lowest slice, of 15 mm and what is above half of 255.
    const double radius = 15 * 2 * std::sqrt(1 - 127.5 / 255) / vessels.grid.spacing[0];
    EXPECT_NEAR(static_cast<double>(inSlice(0)), M_PI * radius * radius, 0.1 * M_PI * radius * radius);
    EXPECT_GE(voxels[64 + 128 * 64], 250);
    EXPECT_GT(inSlice(52), 50) << "the branches reach the upper part";
}

TEST(BuiltinVolume, IsTheSameEachTime) {
    for (const char* name : {"head:40", "sphere:40", "noise:40", "ct:40", "shells:40", "vessels:40"}) {
        EXPECT_EQ(madeVolume(name).voxels, madeVolume(name).voxels);
    }
}

template <class T> std::uint64_t fnv1a(const std::vector<T>& values, std::uint64_t hash = 0xcbf29ce484222325U) {
    std::vector<unsigned char> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    for (const unsigned char byte : bytes) {
        hash = (hash ^ byte) * 0x100000001b3U;
    }
    return hash;
}

// Measurements are compared between machines: a change here makes the old ones incomparable.
TEST(Builtin, IsTheSameOnEachMachine) {
    const std::map<std::string, std::uint64_t> meshes{{"scalpel", 0x23b61ba9476e1602U},
                                                      {"ellipsoid", 0x04ead59b0f2e2ff5U}};
    for (const auto& [name, hash] : meshes) {
        const Result<MeshData> made = makeBuiltinMesh(name);
        ASSERT_TRUE(made.ok());
        EXPECT_EQ(fnv1a(made->indices, fnv1a(made->positions)), hash) << name;
    }
    const std::map<std::string, std::uint64_t> volumes{
        {"head:40", 0x2b317b477d6a17c4U}, {"sphere:40", 0xba359fd16dcb7addU}, {"noise:40", 0x08a8f81100c95c66U},
        {"ct:40", 0xfe7b246a3738dff2U},   {"shells:40", 0xcf5e7b8b3f6347f5U}, {"vessels:40", 0x9965eaf0fce6a48bU}};
    for (const auto& [name, hash] : volumes) {
        EXPECT_EQ(fnv1a(madeVolume(name).voxels), hash) << name;
    }
}

TEST(BuiltinVolume, RefusesWhatItCannotMake) {
    const std::map<std::string, std::vector<std::string>> refused{
        {"foo", {"unknown builtin volume 'foo'", "head, sphere, noise, ct, shells, vessels"}},
        {"", {"unknown builtin volume ''"}},
        {"head:3", {"head:3", "4 to 1024"}},
        {"head:1025", {"head:1025", "4 to 1024"}},
        {"ct:", {"'ct:'", "not a number of voxels"}},
        {"ct:1e2", {"'ct:1e2'", "not a number of voxels"}},
    };
    for (const auto& [name, words] : refused) {
        SCOPED_TRACE(name);
        const Result<VolumeData> made = makeBuiltinVolume(name);
        ASSERT_FALSE(made.ok());
        expectRefusal(made.error(), words);
    }
}

} // namespace
} // namespace voxtact

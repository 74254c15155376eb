// SPDX-License-Identifier: MIT
// Builtin volumes.
#include "support/refusal.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::test {
namespace {

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
    std::array<glm::dvec3, 3> axes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        axes[axis] = {ct.grid.direction[3 * axis], ct.grid.direction[3 * axis + 1], ct.grid.direction[3 * axis + 2]};
        EXPECT_LT(axes[axis][static_cast<int>(axis)], 0.99) << "this axis is hardly oblique";
    }
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(glm::dot(axes[a], axes[b]), a == b ? 1 : 0, 1e-14);
        }
    }
    EXPECT_NEAR(glm::dot(axes[0], glm::cross(axes[1], axes[2])), 1, 1e-14);
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
        EXPECT_EQ(fnv1a(made->indices, fnv1a(floatsOf(made->positions))), hash) << name;
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
} // namespace voxtact::test

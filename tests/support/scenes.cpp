// SPDX-License-Identifier: MIT
#include "support/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

namespace voxtact::test {

Grid unitGrid(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    Grid grid;
    grid.size = {x, y, z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] = 1.0 / grid.size[axis];
        grid.origin[axis] = 0.5 / grid.size[axis];
    }
    return grid;
}

VolumeData makeBytes(const Grid& grid,
                     const std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)>& value) {
    return makeVolume<std::uint8_t>(grid, ScalarType::UInt8, value);
}

const char* headPath() {
    const char* const named = std::getenv("VOXTACT_TEST_HEAD");
    return named != nullptr && *named != '\0' ? named : "/usr/share/mricron/templates/ch2.nii.gz";
}

namespace {

void addRectangle(MeshData& mesh, const std::array<Vec3, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    for (const Vec3& corner : corners) {
        for (const double coordinate : corner) {
            mesh.positions.push_back(static_cast<float>(coordinate));
        }
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
        mesh.indices.push_back(first + corner);
    }
}

} // namespace

MeshData makeRectangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    MeshData mesh;
    addRectangle(mesh, {a, b, c, d});
    return mesh;
}

MeshData makeFlat(double x0, double x1, double y0, double y1, double z) {
    return makeRectangle({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
}

MeshData makeCube(double lo, double hi) {
    MeshData mesh;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double at : {lo, hi}) {
            std::array<Vec3, 4> corners{};
            constexpr bool kHighU[] = {false, true, true, false};
            constexpr bool kHighV[] = {false, false, true, true};
            for (std::size_t i = 0; i < 4; ++i) {
                corners[i][axis] = at;
                corners[i][(axis + 1) % 3] = kHighU[i] ? hi : lo;
                corners[i][(axis + 2) % 3] = kHighV[i] ? hi : lo;
            }
            addRectangle(mesh, corners);
        }
    }
    return mesh;
}

View flatView(double lo, double hi, std::uint32_t width, std::uint32_t height) {
    Mat4 clip_from_world = identity();
    clip_from_world[0] = 2 / (hi - lo);
    clip_from_world[5] = 2 / (hi - lo);
    clip_from_world[10] = 1.0 / 20;
    clip_from_world[12] = -(hi + lo) / (hi - lo);
    clip_from_world[13] = -(hi + lo) / (hi - lo);
    clip_from_world[14] = 0.5;
    return {clip_from_world, width, height};
}

double uniform(std::mt19937_64& random, double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

Mat4 randomRotation(std::mt19937_64& random) {
    // Shoemake, "Uniform random rotations", Graphics Gems III.
    const double u = uniform(random, 0, 1);
    const double v = uniform(random, 0, 2 * std::numbers::pi);
    const double w = uniform(random, 0, 2 * std::numbers::pi);
    const double x = std::sqrt(1 - u) * std::sin(v);
    const double y = std::sqrt(1 - u) * std::cos(v);
    const double z = std::sqrt(u) * std::sin(w);
    const double s = std::sqrt(u) * std::cos(w);
    return {1 - 2 * (y * y + z * z),
            2 * (x * y + z * s),
            2 * (x * z - y * s),
            0,
            2 * (x * y - z * s),
            1 - 2 * (x * x + z * z),
            2 * (y * z + x * s),
            0,
            2 * (x * z + y * s),
            2 * (y * z - x * s),
            1 - 2 * (x * x + y * y),
            0,
            0,
            0,
            0,
            1};
}

Mat4 randomMotion(std::mt19937_64& random) {
    const Vec3 by{uniform(random, -100, 100), uniform(random, -100, 100), uniform(random, -100, 100)};
    return multiply(translation(by), randomRotation(random));
}

VolumeData moved(VolumeData volume, const Mat4& motion) {
    volume.grid.origin = transformPoint(motion, volume.grid.origin);
    std::array<double, 9> direction{};
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t k = 0; k < 3; ++k) {
                direction[3 * c + r] += motion[4 * k + r] * volume.grid.direction[3 * c + k];
            }
        }
    }
    volume.grid.direction = direction;
    return volume;
}

Mat4 floatPose(const Mat4& pose) {
    Mat4 out{};
    std::ranges::transform(pose, out.begin(),
                           [](double element) { return static_cast<double>(static_cast<float>(element)); });
    return out;
}

std::vector<Mat4> randomPoses(const Grid& grid, std::size_t count, double grow, std::mt19937_64& random) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    std::vector<Mat4> poses;
    for (std::size_t i = 0; i < count; ++i) {
        const double lo = 0.5 - grow / 2;
        const Vec3 texture{uniform(random, lo, 1 - lo), uniform(random, lo, 1 - lo), uniform(random, lo, 1 - lo)};
        poses.push_back(multiply(translation(transformPoint(world_from_texture, texture)), randomRotation(random)));
    }
    return poses;
}

std::uint64_t testSeed() {
    std::uint64_t seed = std::random_device{}();
    if (const char* given = std::getenv("VOXTACT_TEST_SEED"); given != nullptr) {
        seed = std::strtoull(given, nullptr, 10);
    }
    std::cout << "VOXTACT_TEST_SEED=" << seed << "\n";
    return seed;
}

bool longTests() {
    return std::getenv("VOXTACT_TEST_LONG") != nullptr;
}

std::size_t randomCases(std::size_t whole, std::size_t part) {
    return longTests() ? whole : whole / part;
}

std::span<const ControlPoint> byteRamp() {
    static constexpr std::array kRamp{ControlPoint{0, 0}, ControlPoint{255, 1}};
    return kRamp;
}

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/oracle_scenes.h"
#include "support/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace voxtact::test {

/// A ball in the middle of a volume of 140 voxels along each axis and 1 mm each, around the origin; opaque from
/// kBallThreshold on with kBallPoints.
inline constexpr double kBallRadius = 25;
inline constexpr double kBallThreshold = 0.5;
inline constexpr std::array kBallPoints{ControlPoint{0, 0}, ControlPoint{255, 1}};

inline VolumeData makeBall() {
    constexpr std::uint32_t kSide = 140;
    constexpr double kMiddle = kSide / 2.0;
    Grid grid;
    grid.size = {kSide, kSide, kSide};
    grid.origin = {0.5 - kMiddle, 0.5 - kMiddle, 0.5 - kMiddle};
    return makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const double from = std::hypot(x + 0.5 - kMiddle, y + 0.5 - kMiddle, z + 0.5 - kMiddle);
        return std::clamp(128 + 20 * (kBallRadius - from), 0.0, 255.0);
    });
}

/// From the object's origin up along z, 12 triangles: of 2 * half a side, and as long as `length`.
inline MeshData makeBoxTool(double half, double length) {
    MeshData cube = makeCube(0, 1);
    for (std::size_t i = 0; i < cube.positions.size(); ++i) {
        const double at = static_cast<double>(cube.positions[i]);
        cube.positions[i] = static_cast<float>(i % 3 == 2 ? at * length : (2 * at - 1) * half);
    }
    return cube;
}

/// Beside the ball, up to `farthest` from it, any side and any part of it.
inline std::vector<Mat4> posesOfBoxTool(std::mt19937_64& random, double half, double length, double farthest,
                                        int number) {
    std::vector<Mat4> poses;
    for (int i = 0; i < number; ++i) {
        const Vec3 off{kBallRadius + half + uniform(random, 1, farthest), 0, -uniform(random, 0, length)};
        poses.push_back(multiply(randomRotation(random), translation(off)));
    }
    return poses;
}

/// One triangle with the object's origin in it or at its end, and the ways around z at which it has something.
struct TurnedTriangle {
    MeshData mesh;
    std::vector<double> ways;

    static TurnedTriangle plane() {
        TurnedTriangle made{{}, {0, 1, 2.5, 4}};
        addTriangle(made.mesh, {-600, -600, 0}, {600, -600, 0}, {0, 800, 0});
        return made;
    }
    /// Along x, so wide at the origin.
    static TurnedTriangle rod(double width) {
        TurnedTriangle made{{}, {0}};
        addTriangle(made.mesh, {300, 0, 0}, {0, -width / 2, 0}, {0, width / 2, 0});
        return made;
    }
    static std::vector<TurnedTriangle> all() { return {plane(), rod(2), rod(0.02), rod(1e-3), rod(1e-5)}; }

    /// It touches the ball where it is turned by `angle` degrees, from the first reached() of them.
    [[nodiscard]] std::vector<Mat4> poses(double angle) const {
        constexpr double kFar = 200;
        std::vector<Mat4> out;
        for (const double part : {0.5, 0.8, 0.95, 1.5, 2.0}) {
            const double rise = part * angle * std::numbers::pi / 180 + std::asin(kBallRadius / kFar);
            for (const double way : ways) {
                out.push_back(translation({-kFar * std::cos(rise) * std::cos(way),
                                           -kFar * std::cos(rise) * std::sin(way), -kFar * std::sin(rise)}));
            }
        }
        return out;
    }
    [[nodiscard]] std::size_t reached() const { return 3 * ways.size(); }
};

} // namespace voxtact::test

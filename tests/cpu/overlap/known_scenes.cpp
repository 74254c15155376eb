// SPDX-License-Identifier: MIT
#include "cpu/overlap/known_scenes.h"
#include "core/geometry/vec3.h"
#include "cpu/overlap/overlap_held.h"
#include "cpu/overlap/solids.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"
#include "support/take.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace voxtact::test {

namespace {

int wholeNumber(std::mt19937_64& random, int lo, int hi) {
    return lo + static_cast<int>(below(random, static_cast<std::size_t>(hi - lo + 1)));
}

/// Of a function of index space, in world space.
Vec3 worldGradient(const Grid& grid, const std::array<int, 3>& gradient) {
    const Mat4 index_from_world = take(inverse(worldFromIndex(grid)));
    Vec3 out{};
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            out[column] += gradient[row] * index_from_world[4 * column + row];
        }
    }
    return out;
}

MeshData randomSimpleSolid(std::mt19937_64& random, double radius) {
    switch (below(random, 4)) {
    case 0: {
        const double side = radius / 1.8;
        return solidBox({-side * uniform(random, 0.2, 1), -side * uniform(random, 0.2, 1), -side},
                        {side * uniform(random, 0.2, 1), side * uniform(random, 0.2, 1), side});
    }
    case 1:
        return solidPrism(static_cast<std::uint32_t>(wholeNumber(random, 3, 9)), 0.7 * radius,
                          radius * uniform(random, 0.1, 1.4), chance(random, 0.5));
    case 2:
        return solidBall(radius, 2);
    default:
        break;
    }
    const Mat4 stretch{uniform(random, 0.2, 1), 0, 0, 0, 0, uniform(random, 0.2, 1), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    return transformed(mapped(solidBall(radius, 2),
                              [&](const Vec3& at) {
                                  const double inwards = uniform(random, 0.6, 1);
                                  return Vec3{inwards * at[0], inwards * at[1], inwards * at[2]};
                              }),
                       stretch);
}

double voxelVolumeOf(const Grid& grid) {
    return std::abs(signedVolume(solidBox({0, 0, 0}, {1, 1, 1}), worldFromIndex(grid)));
}

} // namespace

std::vector<ControlPoint> opaqueFrom(double value) {
    return {{value, 0}, {value, 1}};
}

Grid randomSmallGrid(std::mt19937_64& random) {
    Grid grid;
    const Mat4 turn = chance(random, 0.3) ? identity() : randomRotation(random);
    const double shear = chance(random, 0.3) ? uniform(random, -0.5, 0.5) : 0;
    const double mirror = chance(random, 0.4) ? -1 : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(wholeNumber(random, 5, 16));
        grid.spacing[axis] = uniform(random, 0.4, 2);
        grid.origin[axis] = uniform(random, -60, 60);
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = (axis == 1 ? mirror : 1) * turn[4 * axis + row];
        }
    }
    const Vec3 along = unit({turn[8] + shear * turn[0], turn[9] + shear * turn[1], turn[10] + shear * turn[2]});
    std::copy(along.begin(), along.end(), grid.direction.begin() + 6);
    return grid;
}

VolumeData linearImage(const Grid& grid, const std::array<int, 3>& gradient, int offset) {
    return makeVolume<std::int16_t>(grid, ScalarType::Int16, [&](auto x, auto y, auto z) {
        return gradient[0] * static_cast<double>(x) + gradient[1] * static_cast<double>(y) +
               gradient[2] * static_cast<double>(z) + offset;
    });
}

double linearRadius(const Grid& grid) {
    const Mat4 index_from_world = take(inverse(worldFromIndex(grid)));
    double radius = 1e300;
    for (std::size_t row = 0; row < 3; ++row) {
        const Vec3 steepness{index_from_world[row], index_from_world[4 + row], index_from_world[8 + row]};
        radius = std::min(radius, (grid.size[row] - 1.0) / 2 / length(steepness));
    }
    return radius;
}

Vec3 middleOf(const Grid& grid) {
    return transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
}

KnownScene halfSpaceScene(std::mt19937_64& random) {
    const Grid grid = randomSmallGrid(random);
    const std::array<int, 3> gradient{wholeNumber(random, -20, 20), wholeNumber(random, -20, 20),
                                      wholeNumber(random, 1, 20)};
    const int offset = wholeNumber(random, -100, 100);
    KnownScene out{"half space", {}, 0, 0};
    out.scene.volume = linearImage(grid, gradient, offset);
    const double radius = linearRadius(grid);
    out.scene.mesh = randomSimpleSolid(random, 0.99 * radius);
    if (chance(random, 0.3)) {
        out.scene.mesh = reversed(out.scene.mesh);
    }
    out.scene.world_from_object = multiply(translation(middleOf(grid)), randomRotation(random));
    double value = offset;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        value += gradient[axis] * uniform(random, 0.2, 0.8) * (grid.size[axis] - 1);
    }
    value = chance(random, 0.5) ? std::floor(value) : value;
    out.scene.points = opaqueFrom(value);
    const Vec3 slope = worldGradient(grid, gradient);
    const double atZero = offset - dot(slope, grid.origin);
    out.wanted = std::abs(signedVolumeAbove(out.scene.mesh, out.scene.world_from_object, slope, atZero - value));
    out.slack = 1e-9 * radius * radius * radius;
    return out;
}

KnownScene boxScene(std::mt19937_64& random) {
    Grid grid = randomSmallGrid(random);
    const std::size_t axis = below(random, 3);
    grid.size[(axis + 1) % 3] = chance(random, 0.3) ? 1 : grid.size[(axis + 1) % 3];
    const auto last = static_cast<int>(grid.size[axis]) - 1;
    const int from = chance(random, 0.5) ? last : wholeNumber(random, 0, last);
    const bool isFlat = chance(random, 0.5);
    KnownScene out{isFlat ? "box in one value" : "box at a border", {}, 0, 0};
    std::array<int, 3> gradient{};
    gradient[axis] = isFlat ? 0 : 10;
    out.scene.volume = linearImage(grid, gradient, -40);
    out.scene.points = opaqueFrom(isFlat ? -40 : 10 * from - 40);
    const double voxel = voxelVolumeOf(grid);
    out.wanted = voxel;
    Vec3 lo{};
    Vec3 hi{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double side = grid.size[i];
        lo[i] = uniform(random, -1.5 * side, side);
        hi[i] = lo[i] + uniform(random, 0.1 * side, 2.5 * side);
        if (chance(random, 0.3)) { // in faces of voxels and cells
            lo[i] = std::floor(2 * lo[i]) / 2;
            hi[i] = std::ceil(2 * hi[i]) / 2;
        }
        const double begin = i == axis && !isFlat && from > 0 ? from : -0.5;
        out.wanted *= std::max(0.0, std::min(hi[i], side - 0.5) - std::max(lo[i], begin));
    }
    out.scene.mesh = solidBox(lo, hi);
    out.scene.world_from_object = worldFromIndex(grid);
    out.slack = 1e-9 * voxel * static_cast<double>(voxelCount(grid));
    return out;
}

KnownScene saddleScene(std::mt19937_64& random) {
    const Grid grid = randomSmallGrid(random);
    const int a = wholeNumber(random, -4, 12);
    const int b = wholeNumber(random, -4, 12);
    KnownScene out{"saddle", {}, 0, 0};
    out.scene.volume = makeVolume<std::int16_t>(grid, ScalarType::Int16, [&](auto x, auto y, auto) {
        return (static_cast<double>(x) - a) * (static_cast<double>(y) - b);
    });
    const double least = chance(random, 0.3) ? 0 : uniform(random, -20, 30);
    out.scene.points = opaqueFrom(least);
    Vec3 lo{};
    Vec3 hi{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double end = grid.size[axis] - 1;
        lo[axis] = uniform(random, 0, end - 1);
        hi[axis] = uniform(random, lo[axis] + 0.5, end);
    }
    out.scene.mesh = solidBox(lo, hi);
    out.scene.world_from_object = worldFromIndex(grid);
    // Along each line of the same x the function is linear.
    constexpr int kLines = 20000;
    double area = 0;
    for (int i = 0; i < kLines; ++i) {
        const double u = lo[0] + (hi[0] - lo[0]) * (i + 0.5) / kLines - a;
        const double v = std::clamp(b + least / u, lo[1], hi[1]);
        area += (hi[0] - lo[0]) / kLines * (u > 0 ? hi[1] - v : v - lo[1]);
    }
    out.wanted = voxelVolumeOf(grid) * area * (hi[2] - lo[2]);
    out.slack = 1e-6 * voxelVolumeOf(grid) * static_cast<double>(voxelCount(grid));
    return out;
}

KnownScene lensScene(std::mt19937_64& random) {
    Grid grid;
    grid.size = {40, 40, 40};
    grid.spacing = {0.5, 0.5, 0.5};
    grid.origin = {-9.75, -9.75, -9.75};
    KnownScene out{"lens", {}, 0, 0};
    out.scene.volume = makeVolume<float>(grid, ScalarType::Float32, [](auto x, auto y, auto z) {
        return 7 - 0.5 * std::hypot(x - 19.5, y - 19.5, z - 19.5);
    });
    out.scene.points = opaqueFrom(1); // a ball of 6 mm
    const double radius = uniform(random, 2, 8);
    const double distance = uniform(random, 0, 9);
    out.scene.mesh = solidBall(radius, 3);
    const Vec3 by = transformPoint(randomRotation(random), {distance, 0, 0});
    out.scene.world_from_object = multiply(translation(by), randomRotation(random));
    out.wanted = lensVolume(radius, 6, distance);
    // The octahedron's faces lie within a fortieth of the radius below the sphere, where there is a surface of the
    // lens; the image's ball is off by less than a hundredth of a millimetre.
    const double area = 4 * 3.14159265 * std::min(radius, 6.0) * std::min(radius, 6.0);
    out.slack = area * (0.025 * radius + 0.01);
    return out;
}

double valueAt(const VolumeData& volume, const Vec3& index) {
    const auto& size = volume.grid.size;
    std::array<std::size_t, 3> first{};
    Vec3 part{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double inside = std::clamp(index[axis], 0.0, size[axis] - 1.0);
        first[axis] = static_cast<std::size_t>(inside);
        part[axis] = inside - std::floor(inside);
    }
    std::array<double, 8> values{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        std::size_t at = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
            at = at * size[axis] + std::min<std::size_t>(first[axis] + (corner >> axis & 1U), size[axis] - 1);
        }
        std::int16_t voxel = 0;
        std::memcpy(&voxel, volume.voxels.data() + 2 * at, 2);
        values[corner] = voxel;
    }
    // Of equal values nothing rounds.
    for (std::size_t axis = 3; axis-- > 0;) {
        for (std::size_t i = 0; i < std::size_t{1} << axis; ++i) {
            values[i] += part[axis] * (values[i + (std::size_t{1} << axis)] - values[i]);
        }
    }
    return values[0];
}

OracleScene opaqueScene(const MeshData& mesh, std::uint32_t side) {
    OracleScene scene;
    Grid grid;
    grid.size = {side, side, side};
    scene.volume = makeBytes(grid, [](auto...) { return 255; });
    scene.mesh = mesh;
    return scene;
}

} // namespace voxtact::test

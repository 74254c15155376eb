// SPDX-License-Identifier: MIT
#include "cpu/scenes/margin_cases.h"
#include "core/geometry/vec3.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::test {

namespace {

void scale(Grid& grid, double by) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] *= by;
        grid.origin[axis] *= by;
    }
}

template <class Scalar> VolumeData ramp(const Grid& grid, ScalarType type, const Vec3& slope, double at0) {
    return makeVolume<Scalar>(grid, type, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return at0 + slope[0] * x + slope[1] * y + slope[2] * z;
    });
}

VolumeData rampOf(ScalarType type, const Grid& grid, const Vec3& slope, double at0) {
    switch (type) {
    case ScalarType::UInt8:
        return ramp<std::uint8_t>(grid, type, slope, at0);
    case ScalarType::Int16:
        return ramp<std::int16_t>(grid, type, slope, at0);
    case ScalarType::UInt16:
        return ramp<std::uint16_t>(grid, type, slope, at0);
    default:
        return ramp<float>(grid, type, slope, at0);
    }
}

/// A voxel's place of index space from the world's.
Vec3 indexAt(const Grid& grid, const Vec3& world) {
    const Vec3 texture = transformPoint(take(textureFromWorld(grid)), world);
    Vec3 index{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        index[axis] = texture[axis] * grid.size[axis] - 0.5;
    }
    return index;
}

Grid skewGrid(std::mt19937_64& random) {
    Grid grid = obliqueGrid(random, chance(random, 0.5));
    grid.size = {10, 12, 11};
    grid.spacing = {uniform(random, 0.3, 1), uniform(random, 0.8, 2), uniform(random, 0.5, 3)};
    return grid;
}

} // namespace

CertifiedCase makeClearanceCase(std::uint64_t seed, std::uint64_t number) {
    CertifiedCase c = makeCertifiedCase(seed, number);
    std::mt19937_64 random(seed ^ (number * 0x9e3779b97f4a7c15ULL));
    Grid& grid = c.scene.volume.grid;
    if (chance(random, 0.2)) {
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 + row] += uniform(random, -0.6, 0.6) * grid.direction[row];
            grid.direction[6 + row] += uniform(random, -0.6, 0.6) * grid.direction[3 + row];
        }
    }
    if (chance(random, 0.8)) {
        const Mat4 turn = randomRotation(random);
        const double by = std::pow(10, uniform(random, -2, 1));
        c.scene.world_from_object =
            multiply(translation({by * turn[0], by * turn[1], by * turn[2]}), c.scene.world_from_object);
    }
    return c;
}

MarginCase makeMarginCase(std::uint64_t seed, std::uint64_t number, cpu::ClearanceMeter& meter) {
    MarginCase c{makeClearanceCase(seed, number).scene};
    std::mt19937_64 random(seed ^ (number * 0xbf58476d1ce4e5b9ULL));
    const cpu::Mesh mesh = take(cpu::Mesh::create(c.scene.mesh.view()));
    const cpu::Volume volume = take(cpu::Volume::create(c.scene.volume.view()));
    const cpu::TransferFunction function =
        take(cpu::TransferFunction::create({c.scene.points, c.scene.domain, c.scene.tableSize}));
    const cpu::BatchItem item{&mesh, &volume, &function, {&c.scene.world_from_object, 1}};
    const ClearanceBounds found = take(meter.measure({{&item, 1}, {}, c.scene.threshold})).pairs.at(0).bounds;
    constexpr std::array kOf{0.5, 0.9, 0.99, 0.9999, 1.0001, 1.01, 1.1, 2.0};
    c.margin = found.lo > 0 && std::isfinite(found.hi) ? found.hi * kOf[below(random, kOf.size())]
                                                       : std::pow(10, uniform(random, -3, 1));
    return c;
}

void scaleTo(MarginCase& c, double margin) {
    const double by = margin / c.margin;
    c.margin = margin;
    scale(c.scene.volume.grid, by);
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            c.scene.world_from_object[4 * column + row] *= by;
        }
    }
}

KnownPlane makeKnownPlane(std::mt19937_64& random, int number, std::span<const ScalarType> types) {
    const bool sheet = number / 4 % 2 == 1;
    const int flat = number / 8 % 3; // the tip, an edge, or all of the triangle is nearest
    KnownPlane known;
    const ScalarType type = types[static_cast<std::size_t>(number) % types.size()];
    const double base = type == ScalarType::Int16 ? -70 : 10;
    const Vec3 slope{7, 3, 2};
    known.domain = {base, base + 256};
    known.points = sheet ? std::vector<ControlPoint>{{base + 89.5, 0}, {base + 90.5, 1}, {base + 91.5, 0}}
                         : std::vector<ControlPoint>{{base + 40.5, 0}, {base + 140.5, 1}};
    known.threshold = sheet ? 0.98 : 0.5;
    const double begins = base + (sheet ? 90.48 : 90.5);
    for (;;) {
        const Grid grid = skewGrid(random);
        const Mat4 world_from_index = worldFromIndex(grid);
        // Index space moves by `index` where the world moves along the gradient: what a millimetre adds there.
        const Mat4 texture_from_world = take(textureFromWorld(grid));
        Vec3 gradient{};
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                gradient[column] += slope[row] * grid.size[row] * texture_from_world[4 * column + row];
            }
        }
        const double steepness = std::sqrt(dot(gradient, gradient));
        const Vec3 normal = unit(gradient);
        const Vec3 first = unit(cross(normal, std::abs(normal[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
        const Vec3 second = cross(normal, first);
        const Vec3 foot =
            transformPoint(world_from_index, {uniform(random, 3, 6), uniform(random, 4, 7), uniform(random, 4, 7)});
        const Vec3 index = indexAt(grid, foot);
        // The foot is moved into the plane.
        const double there = base + slope[0] * index[0] + slope[1] * index[1] + slope[2] * index[2];
        const Vec3 onPlane = step(foot, normal, (begins - there) / steepness);
        known.distance = uniform(random, 0.2, 4);
        const Vec3 tip = step(onPlane, normal, -known.distance);
        const Vec3 a = tip;
        const Vec3 b = step(step(tip, first, 0.5), normal, flat > 0 ? 0 : -2);
        const Vec3 c = step(step(tip, second, 0.5), normal, flat > 1 ? 0 : -2);
        bool inside = true;
        for (const Vec3& near : {onPlane, step(onPlane, first, 0.5), step(onPlane, second, 0.5)}) {
            const Vec3 at = indexAt(grid, near);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                inside = inside && at[axis] > 0.5 && at[axis] < grid.size[axis] - 1.5;
            }
        }
        if (!inside) {
            continue;
        }
        known.volume = rampOf(type, grid, slope, base);
        known.mesh = MeshData{};
        addTriangle(known.mesh, a, b, c);
        // A thousandth of an entry, and roundings of coordinates of a hundred voxels.
        known.slack = 2e-3 * std::max({1 / steepness, grid.spacing[0], grid.spacing[1], grid.spacing[2]});
        return known;
    }
}

void scaleTo(KnownPlane& known, double distance) {
    const double by = distance / known.distance;
    known.distance = distance;
    known.slack *= by;
    scale(known.volume.grid, by);
    for (float& coordinate : known.mesh.positions) {
        coordinate = static_cast<float>(coordinate * by);
    }
}

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
// What the certified answer starts from (src/exact/pair_setup.h) against the same in quadruple precision: no place is
// off by more than it is said to be, on whatever grid and at whatever pose.
#include "core/geometry/projection.h"
#include "core/method/certified_constants.h"
#include "support/scenes.h"
#include "support/take.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace voxtact::test {
namespace {

#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;
#else
using Quad = long double;
#endif

using Quads = std::array<Quad, 3>;

Quad sizeOf(Quad value) {
    return value < 0 ? -value : value;
}

struct PairCase {
    Grid grid;
    Mat4 pose{};
};

/// Most spacings are usual; some are a million times as large as others, where inverse matrices have few good digits.
PairCase drawnPairCase(std::mt19937_64& random) {
    PairCase out;
    const bool extreme = random() % 2 == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.grid.size[axis] = static_cast<std::uint32_t>(1 + random() % 600);
        out.grid.spacing[axis] =
            extreme ? std::ldexp(uniform(random, 1, 2), static_cast<int>(random() % 40) - 20) : uniform(random, 0.3, 2);
        out.grid.origin[axis] = random() % 2 == 0 ? 0 : uniform(random, -300, 300);
    }
    if (random() % 4 != 0) {
        const Mat4 turned = randomRotation(random);
        for (std::size_t i = 0; i < 9; ++i) {
            out.grid.direction[i] = turned[4 * (i / 3) + i % 3];
        }
    }
    out.pose = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.pose[12 + axis] = random() % 2 == 0 ? 0 : uniform(random, -300, 300);
    }
    if (random() % 2 == 0) { // flat, so that no point of it comes to the volume's centre for certain
        const std::size_t column = random() % 3;
        for (std::size_t row = 0; row < 3; ++row) {
            out.pose[4 * column + row] = 0;
        }
    }
    return out;
}

/// Where something is, and the sum of its terms' magnitudes.
struct QuadPlace {
    Quads at{};
    Quads size{};
};

/// As the index of a voxel, as the grid says it: the inverse of spacing and direction, by minors.
QuadPlace voxelOf(const Grid& grid, const QuadPlace& world) {
    const auto m = [&](std::size_t row, std::size_t column) {
        return Quad(grid.direction[3 * column + row]) * Quad(grid.spacing[column]);
    };
    const auto minor = [&](std::size_t row, std::size_t column) {
        const std::size_t r1 = (row + 1) % 3;
        const std::size_t r2 = (row + 2) % 3;
        const std::size_t c1 = (column + 1) % 3;
        const std::size_t c2 = (column + 2) % 3;
        return m(r1, c1) * m(r2, c2) - m(r1, c2) * m(r2, c1);
    };
    const Quad determinant = m(0, 0) * minor(0, 0) + m(0, 1) * minor(0, 1) + m(0, 2) * minor(0, 2);
    QuadPlace found;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Quad by = minor(k, axis) / determinant;
            found.at[axis] += by * (world.at[k] - Quad(grid.origin[k]));
            found.size[axis] += sizeOf(by) * (world.size[k] + sizeOf(Quad(grid.origin[k])));
        }
    }
    return found;
}

/// A vertex, where it is, and what the pair says of that.
void lookAtVertex(const PairCase& of, const shader::PairGrid& grid, const shader::CertifiedPair& pair,
                  const std::array<float, 3>& at) {
    QuadPlace world;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 4; ++k) {
            const Quad term = Quad(of.pose[4 * k + row]) * Quad(k < 3 ? at[k] : 1.0F);
            world.at[row] += term;
            world.size[row] += sizeOf(term);
        }
    }
    const QuadPlace truth = voxelOf(of.grid, world);
    Quads apart{};
    Quad error = pair.error[3];
    for (std::size_t k = 0; k < 3; ++k) {
        apart[k] = Quad(at[k]) - Quad(pair.reference[k]);
        error += Quad(pair.error[k]) * sizeOf(apart[k]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Quad voxel = pair.voxel_from_reference[axis][3];
        Quad place = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            voxel += Quad(pair.voxel_from_reference[axis][k]) * apart[k];
        }
        for (std::size_t part = 0; part < 3; ++part) {
            const auto& row = pair.place[3 * part + axis];
            place +=
                Quad(row[3]) + Quad(row[0]) * Quad(at[0]) + Quad(row[1]) * Quad(at[1]) + Quad(row[2]) * Quad(at[2]);
        }
        const Quad unit = grid.aligned != 0 ? Quad(of.grid.spacing[axis]) : Quad(1);
        // Less what the truth itself is rounded by.
        const Quad rounding = Quad(1e-31) * (truth.size[axis] + 1);
        const Quad offVoxel = sizeOf(voxel - truth.at[axis]) - rounding;
        const Quad offPlace = sizeOf(place - (truth.at[axis] + Quad(0.5)) * unit) - rounding * unit;
        EXPECT_TRUE(offVoxel <= error) << "axis " << axis << ": " << static_cast<double>(offVoxel) << " of "
                                       << static_cast<double>(error);
        EXPECT_TRUE(offPlace <= Quad(pair.reference[3]) * error)
            << "axis " << axis << ": " << static_cast<double>(offPlace) << " of "
            << static_cast<double>(Quad(pair.reference[3]) * error);
    }
}

TEST(PairBounds, HoldOnEveryGridAtEveryPose) {
    std::mt19937_64 random(testSeed());
    for (std::uint64_t i = 0; i < randomCases(1'000'000, 50) && !HasFailure(); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const PairCase one = drawnPairCase(random);
        const Result<Mat4> texture_from_world = textureFromWorld(one.grid);
        if (!texture_from_world.ok()) {
            continue; // too oblong for double precision
        }
        const shader::PairGrid grid = pairGrid(one.grid, *texture_from_world);
        const shader::CertifiedPair pair = certifiedPair(grid, one.pose);
        const auto far = [&] { return static_cast<float>(uniform(random, -300, 300)); };
        lookAtVertex(one, grid, pair, {0, 0, 0});
        lookAtVertex(one, grid, pair, {pair.reference[0], pair.reference[1], pair.reference[2]});
        lookAtVertex(one, grid, pair, {far(), far(), far()});
    }
}

} // namespace
} // namespace voxtact::test

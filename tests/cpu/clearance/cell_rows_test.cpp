// SPDX-License-Identifier: MIT
// Cells and pieces of cells in rows, for vectors: against what does the same one by one, and against points.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/search/cells/cell_culling.h"
#include "host/search/cells/cell_walk.h"
#include "host/search/cells/piece_rows.h"
#include "host/search/closest_point.h"
#include "host/search/mesh_place.h"
#include "host/search/nearest_point.h"
#include "support/scenes.h"
#include "support/special.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iostream>
#include <limits>

namespace voxtact::test {
namespace {

using glm::dvec3;

/// A random scene as a search sees it.
struct Part {
    explicit Part(std::mt19937_64& random)
        : scene(makeRandomScene(random, 1)), mesh(take(cpu::Mesh::create(scene.mesh.view()))),
          volume(take(cpu::Volume::create(scene.volume.view()))),
          function(take(cpu::TransferFunction::create({scene.points, scene.domain, scene.tableSize}))),
          part(volume.impl(), function.impl(), scene.threshold, kDefaultResolution) {}

    [[nodiscard]] cpu::NodePlace randomCell(std::mt19937_64& random) const {
        cpu::NodePlace padded{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            padded[axis] = static_cast<std::int32_t>(
                below(random, static_cast<std::uint32_t>(volume.impl().image.size[axis]) + 1));
        }
        return padded;
    }
    /// Centred voxel coordinates, in the volume and around it.
    [[nodiscard]] dvec3 randomPlace(std::mt19937_64& random) const {
        return part.space.reach * dvec3(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2));
    }

    RandomScene scene;
    cpu::Mesh mesh;
    cpu::Volume volume;
    cpu::TransferFunction function;
    cpu::OpaquePart part;
};

/// Calls `visit` with each instruction set by itself.
template <class Visit> void byEveryInstructionSet(const Visit& visit) {
    for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
        hwy::SetSupportedTargetsForTest(rest & -rest);
        visit(hwy::TargetName(rest & -rest));
        hwy::SetSupportedTargetsForTest(0);
    }
}

TEST(CellWalk, EndsWhereGoToOpaqueDoes) {
    std::mt19937_64 random(testSeed());
    std::size_t arrived = 0;
    std::size_t walks = 0;
    for (int round = 0; round < 60; ++round) {
        const Part held(random);
        const cpu::OpaquePart& part = held.part;
        const dvec3 voxel = held.randomPlace(random);
        const dvec3 from = part.space.toWorld(voxel);
        cpu::PieceRows rows;
        std::vector<cpu::NodePlace> cells(1 + below(random, cpu::PieceRows::kMost));
        std::vector<cpu::CellRegion> regions;
        for (cpu::NodePlace& cell : cells) {
            cell = held.randomCell(random);
            const cpu::PartCell place = part.emptyCell(held.volume.impl(), cell);
            cpu::CellRegion region{place.domain - place.half, place.domain + place.half};
            if (chance(random, 0.3)) {
                region.lo.x = 0;
            }
            part.addCell(held.volume.impl(), cell, rows);
            rows.setPiece(rows.count - 1, 0.5 * (region.lo + region.hi), 0.5 * (region.hi - region.lo));
            regions.push_back(region);
        }
        cpu::makeTerms(rows);
        byEveryInstructionSet([&](const char* name) {
            cpu::WalkRows walks_;
            cpu::walkToOpaque({part.intervals, part.space, from, voxel}, rows, walks_);
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const cpu::PartCell cell = part.cell(held.volume.impl(), cells[i]);
                dvec3 at = glm::clamp(2.0 * (voxel - cell.middle), regions[i].lo, regions[i].hi);
                const bool there = cpu::goToOpaque(part, cell, regions[i], at);
                const double distance = glm::distance(part.space.toWorld(cell.middle + 0.5 * at), from);
                ++walks;
                EXPECT_EQ(walks_.distance[i] < kInfinity, there) << name << ", round " << round << ", cell " << i;
                if (there) {
                    ++arrived;
                    EXPECT_EQ(walks_.distance[i], distance) << name << ", round " << round << ", cell " << i;
                    EXPECT_EQ(dvec3(walks_.at[0][i], walks_.at[1][i], walks_.at[2][i]), at) << name;
                }
            }
        });
    }
    std::cout << arrived << " of " << walks << " walks arrive\n";
    EXPECT_GT(arrived, walks / 20);
    EXPECT_LT(arrived, walks);
}

TEST(NearCells, AreThoseThatMayBeOpaqueAndAreNearer) {
    std::mt19937_64 random(testSeed());
    std::size_t kept = 0;
    std::size_t all = 0;
    for (int round = 0; round < 300; ++round) {
        cpu::BrickCells known;
        for (std::uint8_t& row : known.mayBeOpaque) {
            row = static_cast<std::uint8_t>(chance(random, 0.3) ? 0 : below(random, 256));
        }
        cpu::CellBox box;
        std::array<std::array<double, cpu::kBrickSide>, 3> squares{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = static_cast<std::int32_t>(below(random, 8));
            box.hi[axis] = box.lo[axis] + static_cast<std::int32_t>(below(random, 8 - box.lo[axis]));
            for (double& square : squares[axis]) {
                square = uniform(random, 0, 1);
            }
        }
        const double within = uniform(random, 0, 3);
        byEveryInstructionSet([&](const char* name) {
            cpu::RemainingCells out;
            cpu::cullNear({known, box, squares, within}, out);
            for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
                for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
                    const auto number = static_cast<std::size_t>(y + cpu::kBrickSide * z);
                    for (std::int32_t x = 0; x < cpu::kBrickSide; ++x) {
                        const auto at = static_cast<std::size_t>(x);
                        const double square = squares[1][static_cast<std::size_t>(y)] +
                                              squares[2][static_cast<std::size_t>(z)] + squares[0][at];
                        const bool wanted = x >= box.lo[0] && x <= box.hi[0] && square < within &&
                                            (known.mayBeOpaque[number] >> at & 1U) != 0;
                        const bool found = (out.kept[number] >> at & 1U) != 0;
                        ++all;
                        ASSERT_EQ(found, wanted) << name << ": " << x << ", " << y << ", " << z;
                        if (found) {
                            ++kept;
                            EXPECT_EQ(out.lo[number * cpu::kBrickSide + at], square);
                        }
                    }
                }
            }
        });
    }
    EXPECT_GT(kept, all / 50); // one seed had 4.7 % of them
}

/// The least distance of some triangles to points of a piece that certainly are opaque.
double leastSampled(const Part& held, const cpu::PartCell& cell, const cpu::PiecePlace& place,
                    std::span<const cpu::PlacedTriangle> triangles, std::mt19937_64& random) {
    double least = kInfinity;
    const double scale = std::ldexp(1.0, -place.depth);
    for (int sample = 0; sample < 60; ++sample) {
        dvec3 at;
        for (int axis = 0; axis < 3; ++axis) {
            const double middle = (2.0 * place.piece[static_cast<std::size_t>(axis)] + 1) * scale - 1;
            at[axis] = cell.domain[axis] + cell.half[axis] * (middle + scale * uniform(random, -1, 1));
        }
        const double value = cpu::valueAt(cell.terms, at);
        if (!held.part.intervals.contain(value - cell.error, value + cell.error)) {
            continue;
        }
        const dvec3 point = held.part.space.toWorld(cell.middle + 0.5 * at);
        for (const cpu::PlacedTriangle& triangle : triangles) {
            least = std::min(least, glm::distance(point, triangle.near(point)));
        }
    }
    return least;
}

TEST(PieceRows, AreNoNearerThanTheirBounds) {
    std::mt19937_64 random(testSeed());
    std::size_t sampled = 0;
    std::size_t apart = 0;
    for (int round = 0; round < 400; ++round) {
        const Part held(random);
        const cpu::OpaquePart& part = held.part;
        cpu::MeshPlace mesh;
        const dvec3 off = 0.4 * part.space.toWorld(held.randomPlace(random));
        mesh.begin(held.mesh.impl(), part.space, multiply(translation({off.x, off.y, off.z}), held.scene.poses[0]));
        const std::uint32_t count = mesh.countOfCluster(0);
        std::uint64_t some = 0;
        std::vector<cpu::PlacedTriangle> triangles;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i == count - 1 || chance(random, 0.5)) {
                some |= std::uint64_t{1} << i;
                triangles.push_back(mesh.triangle(0, i));
            }
        }
        cpu::PointList corners;
        const cpu::PlacedCluster& cluster = mesh.cluster(0);
        mesh.addCorners(0, some, corners);
        cpu::PieceRows rows;
        std::vector<cpu::PartCell> cells;
        std::vector<cpu::PiecePlace> places;
        while (rows.count < 24) {
            cpu::PiecePlace place{held.randomCell(random), static_cast<std::uint8_t>(below(random, 4)), {}};
            for (std::uint16_t& at : place.piece) {
                at = static_cast<std::uint16_t>(below(random, std::uint32_t{1} << place.depth));
            }
            cells.push_back(part.cell(held.volume.impl(), place.cell));
            places.push_back(place);
            rows.add(cells.back(), place);
        }
        cpu::findRanges(rows);
        std::vector<bool> opaque;
        for (std::size_t i = 0; i < rows.count; ++i) {
            ValueRange hull;
            opaque.push_back(part.intervals.meet(rows.lo[i], rows.hi[i], hull));
            rows.hullLo[i] = hull.lo;
            rows.hullHi[i] = hull.hi;
        }
        const auto nearest = static_cast<std::size_t>(std::countr_zero(some));
        cpu::findApart({cluster, nearest, corners, part.space, kInfinity, mesh.error()}, rows);
        for (std::size_t i = 0; i < rows.count; ++i) {
            const double least = leastSampled(held, cells[i], places[i], triangles, random);
            if (least < kInfinity) {
                ++sampled;
                ASSERT_TRUE(opaque[i]) << "round " << round << ", piece " << i;
                ASSERT_LE(rows.apart[i], least * (1 + 1e-12) + mesh.error()) << "round " << round << ", piece " << i;
                apart += rows.apart[i] > 0.5 * least ? 1 : 0;
            }
        }
    }
    std::cout << sampled << " pieces with opaque points, " << apart << " with a bound of more than half\n";
    EXPECT_GT(sampled, 500U);
    EXPECT_GT(apart, sampled / 4);
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
// A look at many fragments together, against what is decided of each by itself.
#include "host/touch/fragment_filter.h"

#include "cpu/scenes/look_scene.h"
#include "cpu/scenes/random_scene.h"
#include "exact/certified_overlap.h"
#include "support/scenes.h"

#include <hwy/targets.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

namespace voxtact::test {
namespace {

using cpu::FragmentFilter;
using shader::CertifiedVertex;

/// A fragment, and the vertices of its triangle.
struct DrawnFragment {
    std::array<CertifiedVertex, 3> vertices{};
    FragmentFilter::Fragment look;
};

/// A cell, more often than not on a face of the domain where `atFace` is set.
std::array<std::int32_t, 3> drawnCell(std::mt19937_64& random, bool atFace) {
    std::array<std::int32_t, 3> cell{};
    for (std::int32_t& place : cell) {
        place = 20;
        if (atFace && chance(random, 0.5)) {
            place = chance(random, 0.5) ? -1 : LookScene::kSide - 1;
        }
    }
    return cell;
}

/// Around a cell, far larger than it and far smaller, flat, thin, or with corners on the planes of voxels.
std::array<CertifiedVertex, 3> drawnTriangle(std::mt19937_64& random, const std::array<std::int32_t, 3>& cell) {
    const float error = drawn(random, 0, chance(random, 0.2) ? 3e-2 : 1e-4);
    const double size = std::pow(10, uniform(random, -2, 1));
    const bool onPlanes = chance(random, 0.2);
    const std::size_t thin = below(random, 6);
    std::array<CertifiedVertex, 3> vertices{};
    const std::array<double, 3> middle{uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2),
                                       uniform(random, -0.2, 1.2)};
    for (CertifiedVertex& vertex : vertices) {
        std::array<float, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double reach = axis == thin ? 1e-6 : size;
            at[axis] = static_cast<float>(cell[axis] + middle[axis] + uniform(random, -reach, reach));
            at[axis] = onPlanes && chance(random, 0.5) ? std::round(at[axis]) : at[axis];
        }
        vertex = {{at[0], at[1], at[2]}, error};
    }
    return vertices;
}

DrawnFragment drawnFragment(std::mt19937_64& random, const LookScene& scene) {
    DrawnFragment out;
    const bool atFace = chance(random, 0.1);
    out.look.cell = drawnCell(random, atFace);
    out.vertices = drawnTriangle(random, out.look.cell);
    const auto& [a, b, c] = out.vertices;
    out.look.triangle = {a.point, b.point, c.point};
    out.look.delta = shader::certifiedBounds(scene.item(), a, b, c).delta;
    out.look.corners = scene.corners(random);
    if (chance(random, 0.3)) {
        // Of other voxels of the brick.
        out.look.corners.wideLo -= drawn(random, 0, 300);
        out.look.corners.wideHi += drawn(random, 0, 300);
    }
    if (chance(random, 0.02)) {
        (chance(random, 0.5) ? out.look.corners.s110 : out.look.corners.s000) = std::numeric_limits<float>::quiet_NaN();
    }
    const auto [x, y, z] = out.look.cell;
    out.look.passes = shader::certifiedOverlap(shader::certifiedTriangle(a.point, b.point, c.point, out.look.delta), x,
                                               y, z) == CERTIFIED_CERTAIN;
    return out;
}

std::vector<DrawnFragment> drawnFragments(std::mt19937_64& random, const LookScene& scene) {
    std::vector<DrawnFragment> all(1 + below(random, FragmentFilter::kMost));
    std::ranges::generate(all, [&] { return drawnFragment(random, scene); });
    return all;
}

void look(const LookScene& scene, const std::vector<DrawnFragment>& fragments, FragmentFilter& out) {
    for (const DrawnFragment& fragment : fragments) {
        out.add(fragment.look);
    }
    EXPECT_EQ(out.count(), fragments.size());
    EXPECT_EQ(out.full(), fragments.size() == FragmentFilter::kMost);
    out.test(scene.item(), scene.opaque().bounds);
    EXPECT_EQ(out.count(), 0U);
}

/// Of each verdict: how many fragments have it, and how many of them the look has decided.
struct LookTally {
    std::array<std::size_t, 3> all{};
    std::array<std::size_t, 3> decided{};
};

void expectVerdict(const LookScene& scene, const DrawnFragment& fragment, bool isNone, bool isCertain,
                   LookTally& tally) {
    const int verdict = scene.verdict(fragment.look.corners, fragment.vertices, fragment.look.cell);
    EXPECT_TRUE(!isNone || verdict == CERTIFIED_NONE) << verdict;
    EXPECT_TRUE(!isCertain || verdict == CERTIFIED_CERTAIN) << verdict;
    ++tally.all[static_cast<std::size_t>(verdict)];
    tally.decided[static_cast<std::size_t>(verdict)] += isNone || isCertain ? 1 : 0;
}

TEST(FragmentFilterTest, SaysWhatIsFoundOfEachAlone) {
    std::mt19937_64 random(testSeed());
    FragmentFilter looked;
    LookTally tally;
    for (std::size_t round = 0; round < randomCases(20000, 10) && !HasFailure(); ++round) {
        const LookScene scene(random);
        const std::vector<DrawnFragment> fragments = drawnFragments(random, scene);
        look(scene, fragments, looked);
        for (std::size_t i = 0; i < fragments.size(); ++i) {
            SCOPED_TRACE("round " + std::to_string(round) + ", fragment " + std::to_string(i));
            expectVerdict(scene, fragments[i], looked.isNone(i), looked.isCertain(i), tally);
        }
    }
    const auto said = [&](std::size_t verdict) {
        std::cout << tally.decided[verdict] << " of " << tally.all[verdict];
        return static_cast<double>(tally.decided[verdict]) / static_cast<double>(tally.all[verdict]);
    };
    const double none = said(CERTIFIED_NONE);
    std::cout << " that are none, ";
    const double certain = said(CERTIFIED_CERTAIN);
    std::cout << " that are certain\n";
    EXPECT_GT(none, 0.5);
    EXPECT_GT(certain, 0.5);
}

TEST(FragmentFilterTest, IsTheSameByEveryInstructionSet) {
    std::mt19937_64 random(testSeed());
    const auto saidOf = [](const LookScene& scene, const std::vector<DrawnFragment>& fragments) {
        FragmentFilter looked;
        look(scene, fragments, looked);
        std::vector<int> said;
        for (std::size_t i = 0; i < fragments.size(); ++i) {
            said.push_back((looked.isNone(i) ? 1 : 0) + (looked.isCertain(i) ? 2 : 0));
        }
        return said;
    };
    for (int round = 0; round < 50; ++round) {
        const LookScene scene(random);
        const std::vector<DrawnFragment> fragments = drawnFragments(random, scene);
        const std::vector<int> said = saidOf(scene, fragments);
        for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
            hwy::SetSupportedTargetsForTest(rest & -rest);
            EXPECT_EQ(saidOf(scene, fragments), said) << hwy::TargetName(rest & -rest) << ", round " << round;
        }
        hwy::SetSupportedTargetsForTest(0);
    }
}

} // namespace
} // namespace voxtact::test

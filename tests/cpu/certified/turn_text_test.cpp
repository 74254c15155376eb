// SPDX-License-Identifier: MIT
// What turns of up to an angle bring about: shaders/certified_turn.h, against turns of the host's.
#include "support/scenes.h"

#include "certified_margin.h"
#include "certified_turn.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

namespace voxtact::test {
namespace {

using glm::dvec3;

dvec3 wide(const shader::VoxelPoint& v) {
    return {v.x, v.y, v.z};
}

shader::VoxelPoint narrow(const dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

shader::TurnLimit limitOf(double angle) {
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
            static_cast<float>(2 * std::sin(angle / 2) * (1 + 0x1p-22))};
}

dvec3 anyVector(std::mt19937_64& random, double size) {
    return size * dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
}

/// Angles from nearly none to a half turn, and vectors that are nearly along each other, or against.
struct TurnCase {
    double angle;
    shader::TurnLimit limit;
    shader::VoxelPoint arm;
    shader::VoxelPoint other;

    explicit TurnCase(std::mt19937_64& random) {
        constexpr std::array kSome{1e-6, 1e-3, 0.02, 0.5, std::numbers::pi / 2, 2.0, std::numbers::pi};
        angle = random() % 2 == 0 ? kSome[random() % kSome.size()] : uniform(random, 0, std::numbers::pi);
        limit = limitOf(angle);
        const dvec3 first = anyVector(random, std::exp2(uniform(random, -3, 8)));
        const std::uint64_t kind = random() % 4;
        const dvec3 second = anyVector(random, std::exp2(uniform(random, -3, 8)));
        arm = narrow(first);
        other = narrow(kind == 0 ? first + 1e-3 * second : kind == 1 ? -first + 1e-3 * second : second);
    }
};

/// Turned about any axis by no more than the angle, and often by all of it.
dvec3 anyTurn(std::mt19937_64& random, double angle, const dvec3& arm) {
    const dvec3 axis = anyVector(random, 1);
    const double by = random() % 2 == 0 ? angle : uniform(random, 0, angle);
    return glm::length(axis) > 1e-6 ? glm::mat3_cast(glm::angleAxis(by, glm::normalize(axis))) * arm : arm;
}

/// Of MARGIN_ROUNDING of the arm, as marginMovedSlack() has it, what is left to these two is a quarter.
double slackOf(const dvec3& arm) {
    return 0.5 * MARGIN_ROUNDING * std::max({std::abs(arm.x), std::abs(arm.y), std::abs(arm.z)}) + 1e-6;
}

TEST(TurnText, NoTurnGetsFarther) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    for (int number = 0; number < 4000 && !HasFailure(); ++number) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(number));
        const TurnCase c(random);
        const dvec3 arm = wide(c.arm);
        const dvec3 direction = wide(c.other);
        const double surplus = static_cast<double>(shader::turnSurplus(c.limit, c.other, c.arm));
        const double slack = slackOf(arm) * glm::length(direction);
        EXPECT_GE(surplus, 0);
        double farthest = 0;
        for (int turn = 0; turn < 50; ++turn) {
            farthest = std::max(farthest, glm::dot(direction, anyTurn(random, c.angle, arm) - arm));
        }
        // In the plane of the two, by all of it or until it is there.
        const double between =
            std::acos(std::clamp(glm::dot(arm, direction) / (glm::length(arm) * glm::length(direction)), -1.0, 1.0));
        const double best = glm::length(arm) * glm::length(direction) * std::cos(std::max(between - c.angle, 0.0)) -
                            glm::dot(arm, direction);
        EXPECT_LE(farthest, surplus + slack);
        EXPECT_LE(best, surplus + slack);
        EXPECT_NEAR(surplus, best, 16 * slack); // and no more than that
    }
}

TEST(TurnText, IsATurnTowardsTheOther) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t moved = 0;
    for (int number = 0; number < 4000 && !HasFailure(); ++number) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(number));
        const TurnCase c(random);
        const dvec3 arm = wide(c.arm);
        const dvec3 wanted = wide(c.other);
        const dvec3 turned = wide(shader::turnTowards(c.limit, c.arm, c.other));
        const double slack = slackOf(arm);
        // The nearest of all turns that are allowed: as long, and no farther off than the angle.
        EXPECT_NEAR(glm::length(turned), glm::length(arm), slack);
        const double by = 2 * std::asin(std::min(glm::length(turned - arm) / (2 * glm::length(arm)), 1.0));
        // Near a half turn a chord says less of an angle.
        EXPECT_LE(std::sin(by / 2) - std::sin(c.angle / 2), slack / glm::length(arm));
        EXPECT_LE(glm::length(wanted - turned), glm::length(wanted - arm) + slack);
        const double between =
            std::acos(std::clamp(glm::dot(arm, wanted) / (glm::length(arm) * glm::length(wanted)), -1.0, 1.0));
        const double left = std::max(between - c.angle, 0.0);
        const double nearest = std::hypot(glm::length(arm) - glm::length(wanted),
                                          2 * std::sqrt(glm::length(arm) * glm::length(wanted)) * std::sin(left / 2));
        if (between < std::numbers::pi - 1e-5) { // there any way is as good as another, and none is told
            EXPECT_NEAR(glm::length(wanted - turned), nearest, 1e-3 * (glm::length(arm) + glm::length(wanted)));
        }
        moved += turned != arm ? 1U : 0U;
    }
    EXPECT_GT(moved, 3000U);
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#include "viewer/model/document/curve.h"

#include "viewer/model/document/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace voxtact {

static bool operator==(const ControlPoint& a, const ControlPoint& b) {
    return a.value == b.value && a.opacity == b.opacity;
}

} // namespace voxtact

namespace voxtact::test {

using namespace voxtact::view;

namespace {

constexpr ValueRange kDomain{0, 100};

Curve ramp() {
    return {{20, 0}, {60, 1}};
}

} // namespace

TEST(ViewCurve, OpacityIsLinearBetweenPointsAndConstantOutside) {
    for (const auto& [value, opacity] : {std::pair(-5.0, 0.0), {20.0, 0.0}, {30.0, 0.25}, {60.0, 1.0}, {1e6, 1.0}}) {
        EXPECT_DOUBLE_EQ(opacityAt(ramp(), value), opacity) << value;
    }
}

TEST(ViewCurve, AStepHasItsRightSide) {
    EXPECT_DOUBLE_EQ(opacityAt({{20, 0}, {20, 1}}, 20), 1);
    EXPECT_DOUBLE_EQ(opacityAt({{20, 0}, {20, 1}}, 19.999), 0);
}

TEST(ViewCurve, APointIsAddedWhereItsValueBelongs) {
    Curve curve = ramp();
    EXPECT_EQ(addPoint(curve, {40, 0.9}), 1U);
    EXPECT_EQ(addPoint(curve, {5, -3}), 0U);
    EXPECT_EQ(addPoint(curve, {70, 7}), 4U);
    EXPECT_EQ(curve, (Curve{{5, 0}, {20, 0}, {40, 0.9}, {60, 1}, {70, 1}}));
}

TEST(ViewCurve, APointMovesBetweenItsNeighboursAndWithinTheDomain) {
    Curve curve{{20, 0}, {40, 0.5}, {60, 1}};
    movePoint(curve, 1, {10, 2}, kDomain);
    EXPECT_EQ(curve[1], (ControlPoint{20, 1}));
    movePoint(curve, 1, {99, 0.5}, kDomain);
    EXPECT_EQ(curve[1], (ControlPoint{60, 0.5}));
    movePoint(curve, 0, {-10, 0}, kDomain);
    EXPECT_EQ(curve[0], (ControlPoint{0, 0}));
    movePoint(curve, 2, {300, 1}, kDomain);
    EXPECT_EQ(curve[2], (ControlPoint{100, 1}));
}

TEST(ViewCurve, APointBeyondTheDomainIsNotPulledBack) {
    Curve curve{{-50, 0}, {150, 1}};
    movePoint(curve, 0, {-50, 0.5}, kDomain);
    movePoint(curve, 1, {150, 0.75}, kDomain);
    EXPECT_EQ(curve, (Curve{{-50, 0.5}, {150, 0.75}}));
}

TEST(ViewCurve, TheLastPointStays) {
    Curve curve = ramp();
    EXPECT_FALSE(removePoint(curve, 2));
    EXPECT_TRUE(removePoint(curve, 0));
    EXPECT_FALSE(removePoint(curve, 0));
    EXPECT_EQ(curve, (Curve{{60, 1}}));
}

TEST(ViewCurve, RoundedHasFewDigits) {
    EXPECT_EQ(rounded({44.4444, 0.33333}, {0, 255}), (ControlPoint{44.4, 0.333}));
    EXPECT_EQ(rounded({-876.54321, 0.5}, {-1024, 3071}), (ControlPoint{-877, 0.5}));
    EXPECT_EQ(rounded({0.123456, 1}, {0, 1}), (ControlPoint{0.123, 1}));
}

TEST(ViewCurve, OpaqueRangesOfARampBeginAtTheThreshold) {
    const auto ranges = opaqueRanges(ramp(), 0.25, kDomain);
    ASSERT_EQ(ranges.size(), 1U);
    EXPECT_DOUBLE_EQ(ranges[0].lo, 30);
    EXPECT_DOUBLE_EQ(ranges[0].hi, 100);
}

TEST(ViewCurve, TwoPeaksAreTwoRanges) {
    const auto ranges = opaqueRanges({{10, 0}, {20, 1}, {30, 0}, {50, 0}, {60, 1}, {70, 0}}, 0.5, kDomain);
    ASSERT_EQ(ranges.size(), 2U);
    EXPECT_DOUBLE_EQ(ranges[0].lo, 15);
    EXPECT_DOUBLE_EQ(ranges[0].hi, 25);
    EXPECT_DOUBLE_EQ(ranges[1].lo, 55);
    EXPECT_DOUBLE_EQ(ranges[1].hi, 65);
}

TEST(ViewCurve, OpaqueRangesAreWhereTheOpacityIs) {
    const std::uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 200; ++round) {
        Curve curve;
        for (int i = 0; i < 6; ++i) {
            addPoint(curve, {100 * unit(random), unit(random)});
        }
        const double threshold = unit(random);
        const auto ranges = opaqueRanges(curve, threshold, kDomain);
        for (int i = 0; i < 100; ++i) {
            const double value = 100 * unit(random);
            const double opacity = opacityAt(curve, value);
            if (std::abs(opacity - threshold) < 1e-9) {
                continue; // either way
            }
            const bool in = std::ranges::any_of(
                ranges, [value](const ValueRange& range) { return value >= range.lo && value <= range.hi; });
            ASSERT_EQ(in, opacity > threshold) << value;
        }
    }
}

TEST(ViewHistory, GivesBackWhatWasBefore) {
    History<int> history;
    int value = 2;
    EXPECT_FALSE(history.canUndo());
    history.add(1, 2, "");
    value = 3;
    history.add(2, 3, "");
    history.undo(value);
    EXPECT_EQ(value, 2);
    history.undo(value);
    EXPECT_EQ(value, 1);
    history.undo(value);
    EXPECT_EQ(value, 1);
    history.redo(value);
    history.redo(value);
    EXPECT_EQ(value, 3);
    EXPECT_FALSE(history.canRedo());
}

TEST(ViewHistory, ADragIsOneCommand) {
    History<int> history;
    int value = 4;
    for (int i = 1; i < 4; ++i) {
        history.add(i, i + 1, "drag");
    }
    history.end();
    history.add(4, 5, "drag");
    value = 5;
    history.undo(value);
    EXPECT_EQ(value, 4);
    history.undo(value);
    EXPECT_EQ(value, 1);
    EXPECT_FALSE(history.canUndo());
}

TEST(ViewHistory, ANewCommandEndsWhatCouldBeRedone) {
    History<int> history;
    int value = 2;
    history.add(1, 2, "");
    history.undo(value);
    history.add(1, 9, "");
    EXPECT_FALSE(history.canRedo());
}

TEST(ViewHistory, NoChangeIsNoCommand) {
    History<int> history;
    history.add(1, 1, "");
    EXPECT_FALSE(history.canUndo());
}

} // namespace voxtact::test

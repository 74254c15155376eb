// SPDX-License-Identifier: MIT
#include "support/special.h"
#include "viewer/model/answers/live_measures.h"
#include "viewer/model/answers/report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

PairDistance distance(double lo, double hi) {
    PairDistance out;
    out.bounds = {lo, hi};
    if (hi < kInfinity) {
        out.closest = WitnessPoints{.triangle = 4, .mesh = {1, 2, 3}, .volume = {1, 2, 3 + hi}};
    }
    return out;
}

MeshMeasures measured(double lo, double hi) {
    return {0, distance(lo, hi), {}};
}

/// One that touches.
MeshMeasures touching(double lo, double hi) {
    MeshMeasures out = measured(0, 0);
    out.area = PairArea{.bounds = {lo, hi}, .end = StopReason::Budget};
    return out;
}

nlohmann::json allReported(const LiveMeasures& live, std::uint64_t answered) {
    LiveAnswer answer;
    answer.revision = answered;
    answer.meshes.resize(1);
    const Times times;
    const Document document;
    StateReport report;
    report.answer = &answer;
    report.times = &times;
    report.frameTimes = report.times;
    report.document = &document;
    report.measures = &live;
    return nlohmann::json::parse(reportText(report));
}

nlohmann::json reported(const LiveMeasures& live, std::uint64_t answered) {
    return allReported(live, answered)["distance"];
}

} // namespace

TEST(ViewMeasures, IsSaidInWords) {
    EXPECT_EQ(measuresText(measured(12.341, 12.349)), "12.34 to 12.35 mm away");
    EXPECT_EQ(measuresText(measured(0, 0)), "touches");
    EXPECT_EQ(measuresText(measured(0, 0.004)), "0.00 to 0.0040 mm away");
    EXPECT_EQ(measuresText(measured(kInfinity, kInfinity)), "nothing is opaque");
    EXPECT_EQ(measuresText(measured(5, kInfinity)), "at least 5.00 mm away");
}

TEST(ViewMeasures, BoundsAreRoundedOutward) {
    EXPECT_EQ(measuresText(measured(18.3569, 18.3649)), "18.35 to 18.37 mm away");
    EXPECT_EQ(measuresText(measured(18.3534, 18.36345)), "18.35 to 18.37 mm away");
    EXPECT_EQ(measuresText(measured(123.456789, kInfinity)), "at least 123.45 mm away");
    EXPECT_EQ(lowerText(0.029999), "0.029");
    EXPECT_EQ(upperText(0.00120001), "0.0013");
    EXPECT_EQ(upperText(1e-12), "0.000001");
    EXPECT_EQ(lowerText(1e-12), "0.000000");
    EXPECT_EQ(lowerText(0.25), "0.25") << "what is exact stays so";
    EXPECT_EQ(upperText(0.25), "0.25");
}

TEST(ViewMeasures, HasASegmentOnlyWhereThereIsAGap) {
    const auto segment = closestSegment(distance(7, 7.5));
    ASSERT_TRUE(segment.has_value());
    EXPECT_EQ((*segment)[0], (Vec3{1, 2, 3}));
    EXPECT_EQ((*segment)[1], (Vec3{1, 2, 10.5}));
    EXPECT_FALSE(closestSegment(distance(0, 0)).has_value());
    EXPECT_FALSE(closestSegment(distance(kInfinity, kInfinity)).has_value());
}

TEST(ViewMeasures, APlaneIsAsFarAsTheNearerEnd) {
    const std::array<Vec3, 2> segment{{{0, 5, 0}, {0, 2, 0}}};
    EXPECT_EQ(distanceOfPlane(segment, 1, 3), 0);
    EXPECT_EQ(distanceOfPlane(segment, 1, 7), 2);
    EXPECT_EQ(distanceOfPlane(segment, 1, -1), 3);
    EXPECT_EQ(distanceOfPlane(segment, 0, -1), 1);
}

TEST(ViewMeasures, IsReportedWithItsPointsAndOnlyForTheSameQuestion) {
    const LiveMeasures live{3, {measured(7, 7.5)}, 1};
    const nlohmann::json json = reported(live, 3);
    EXPECT_EQ(json["lo"], 7);
    EXPECT_EQ(json["hi"], 7.5);
    EXPECT_EQ(json["end"], "closed");
    EXPECT_EQ(json["triangle"], 4);
    EXPECT_EQ(json["mesh"], (nlohmann::json{1, 2, 3}));
    EXPECT_EQ(json["volume"], (nlohmann::json{1, 2, 10.5}));
    EXPECT_TRUE(reported(live, 4).is_null());
    EXPECT_TRUE(reported(live, 2).is_null());
}

TEST(ViewMeasures, WhatJsonHasNoNumberForIsAWord) {
    const nlohmann::json json = reported({1, {measured(kInfinity, kInfinity)}, 1}, 1);
    EXPECT_EQ(json["lo"], "inf");
    EXPECT_EQ(json["hi"], "inf");
    EXPECT_FALSE(json.contains("mesh"));
}

TEST(ViewMeasures, SaysHowMuchIsInside) {
    MeshMeasures inside = touching(820, 821);
    EXPECT_EQ(overlapText(inside), "");
    inside.overlap = PairOverlap{.bounds = {33.421, 33.509}, .solid = {130, 131}, .end = StopReason::Closed};
    EXPECT_EQ(overlapText(inside), "33.42 to 33.51 mm\u00b3 inside, at least 25 %");
    const nlohmann::json json = allReported({3, {inside}, 1}, 3)["overlap"];
    EXPECT_EQ(json["hi"], 33.509);
    EXPECT_EQ(json["end"], "closed");
    inside.overlap->bounds = {0, 0};
    EXPECT_EQ(overlapText(inside), "nothing opaque inside");
}

TEST(ViewMeasures, SaysHowMuchTouches) {
    EXPECT_EQ(measuresText(touching(820.051, 820.149)), "820.05 to 820.15 mm\u00b2 touch");
    EXPECT_EQ(measuresText(touching(0.001, 0.1)), "0.0010 to 0.10 mm\u00b2 touch");
    EXPECT_EQ(measuresText(touching(0, 0)), "touches") << "at a point";
    EXPECT_EQ(measuresText(touching(0, kInfinity)), "touches");
    MeshMeasures apart = touching(0, 0);
    apart.pair = distance(5, 6);
    EXPECT_EQ(measuresText(apart), "5.00 to 6.00 mm away");

    const nlohmann::json json = allReported({1, {touching(7, 7.5)}, 1}, 1)["area"];
    EXPECT_EQ(json["lo"], 7);
    EXPECT_EQ(json["hi"], 7.5);
    EXPECT_EQ(json["end"], "budget");
    EXPECT_EQ(allReported({1, {touching(0, kInfinity)}, 1}, 1)["area"]["hi"], "inf");
    EXPECT_TRUE(allReported({1, {touching(7, 7.5)}, 1}, 2)["area"].is_null());
    EXPECT_TRUE(allReported({1, {measured(0, 0)}, 1}, 1)["area"].is_null());
    EXPECT_TRUE((LiveMeasures{1, {touching(7, 7.5)}, 1}).hasAreas());
    EXPECT_FALSE((LiveMeasures{1, {touching(7, 7.5), measured(0, 0)}, 1}).hasAreas());
}

} // namespace voxtact::test

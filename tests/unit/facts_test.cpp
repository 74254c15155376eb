// SPDX-License-Identifier: MIT
// The table of facts: what the options, the checks and the errors are made from.
#include "core/facts/facts.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace voxtact {
namespace {

TEST(Facts, AreEachThereOnceWithARangeThatHoldsTheDefault) {
    std::set<std::pair<std::string_view, std::string_view>> names;
    for (const Fact& fact : kFacts) {
        SCOPED_TRACE(std::string(fact.question) + " " + std::string(fact.name));
        EXPECT_TRUE(names.insert({fact.question, fact.name}).second) << "twice";
        EXPECT_TRUE(!fact.standard || isInRange(fact, *fact.standard));
        EXPECT_LT(fact.min, fact.max);
        EXPECT_LE(fact.text.size(), 70U) << "a line of --help";
    }
    EXPECT_GT(names.size(), 10U);
}

/// The double next to the ends of a range, to each side.
TEST(Facts, RangesEndWhereTheySay) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Fact& fact : kFacts) {
        SCOPED_TRACE(std::string(fact.question) + " " + std::string(fact.name));
        EXPECT_EQ(isInRange(fact, fact.min), fact.isMinAllowed);
        EXPECT_FALSE(isInRange(fact, std::nextafter(fact.min, -kInfinity)));
        const bool isWhole = fact.kind == FactKind::Whole || fact.kind == FactKind::Flag;
        EXPECT_EQ(isInRange(fact, std::nextafter(fact.min, kInfinity)), !isWhole);
        EXPECT_TRUE(isInRange(fact, fact.min + 1) || fact.max < fact.min + 1);
        EXPECT_EQ(isInRange(fact, fact.max), fact.max < kInfinity || fact.isInfinityAllowed);
        EXPECT_FALSE(isInRange(fact, nan));
        EXPECT_FALSE(isInRange(fact, -kInfinity));
    }
    EXPECT_TRUE(isInRange(factOf("distance", "max"), kInfinity));
    EXPECT_FALSE(isInRange(factOf("distance", "tolerance"), kInfinity));
}

TEST(Facts, ErrorsNameTheValueAndTheRange) {
    EXPECT_EQ(checkFact(factOf("distance", "tolerance"), 0).error().text,
              "the tolerance 0 mm is not a number from 1e-06 mm on");
    EXPECT_EQ(checkFact(factOf("plan", "max_angle"), 91).error().text,
              "the max angle 91 degrees is not a number from 0 to 90 degrees");
    EXPECT_EQ(checkFact(factOf("distance", "max"), -1).error().text, "the max -1 mm is not a number above 0 mm");
    EXPECT_EQ(checkFact(factOf("touch", "solid"), 2).error().text, "the solid 2 is not 0 or 1");
    EXPECT_EQ(checkFact(factOf("touch", "max_steps"), 0.5).error().text,
              "the max steps 0.5 is not a whole number from 1 on");
    EXPECT_EQ(checkFact(factOf("count", "samples_per_voxel"), 17).error().text,
              "the samples per voxel 17 is not a whole number from 1 to 16");
    EXPECT_EQ(checkFact(factOf("scene", "opacity_threshold"), 1.5).error().code, ErrorCode::InvalidArgument);
    EXPECT_TRUE(checkFact(factOf("scene", "opacity_threshold"), 1).ok());
}

} // namespace
} // namespace voxtact

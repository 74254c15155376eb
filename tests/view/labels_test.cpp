// SPDX-License-Identifier: MIT
#include "viewer/model/answers/live_answer.h"
#include "viewer/model/answers/report.h"
#include "viewer/model/document/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

/// Two voxels along x, of 2 mm: the first has label 0, the second 7.
struct Pair {
    std::vector<std::uint8_t> voxels{0, 7};
    VolumeView view{{{2, 1, 1}, {2, 2, 2}, {10, 0, 0}}, ScalarType::UInt8, std::as_bytes(std::span(voxels))};
    Labels labels{makeLabels(view).value(), {{7, "skull"}}};
    Mat4 texture_from_world = textureFromWorld(view.grid).value();
};

LabelCount count(std::int32_t label, std::uint64_t survivors) {
    return {0, label, survivors};
}

} // namespace

TEST(ViewLabels, TheNearestVoxelHasTheLabelAndOutsideIsNone) {
    const Pair pair;
    EXPECT_EQ(labelOf(pair.labels, {10, 0, 0}), 0);
    EXPECT_EQ(labelOf(pair.labels, {12.5, 0, 0}), 7);
    EXPECT_EQ(labelOf(pair.labels, {14, 0, 0}), 0);
}

TEST(ViewLabels, NamesAreSaidWhereThereAreSome) {
    const Pair pair;
    EXPECT_EQ(labelText(pair.labels, 7), "7 skull");
    EXPECT_EQ(labelText(pair.labels, 9), "9");
    EXPECT_EQ(nameOf(pair.labels, 9), "");
}

TEST(ViewLabels, APlaceIsToldWithValueAndLabel) {
    const Pair pair;
    EXPECT_EQ(placeText(pair.view, pair.texture_from_world, &pair.labels, {12, 0, 0}),
              "12.0, 0.0, 0.0 mm: 7   label 7 skull");
    EXPECT_EQ(placeText(pair.view, pair.texture_from_world, nullptr, {12, 0, 0}), "12.0, 0.0, 0.0 mm: 7");
    EXPECT_EQ(placeText(pair.view, pair.texture_from_world, nullptr, {12, -0.01, 0}), "12.0, 0.0, 0.0 mm: 7");
    EXPECT_EQ(placeText(pair.view, pair.texture_from_world, &pair.labels, {20, 0, 0}),
              "20.0, 0.0, 0.0 mm: outside the volume   label 0");
}

TEST(ViewLabels, TheMostTouchedComesFirstAndTheBackgroundOnlyAlone) {
    const auto labels = [](const std::vector<LabelCount>& counts) {
        std::vector<std::int32_t> out;
        for (const LabelCount& entry : touchedLabels(counts)) {
            out.push_back(entry.label);
        }
        return out;
    };
    EXPECT_THAT(labels({count(0, 99), count(3, 2), count(5, 8), count(-4, 2)}), testing::ElementsAre(5, -4, 3));
    EXPECT_THAT(labels({count(0, 99)}), testing::ElementsAre(0));
    EXPECT_THAT(labels({}), testing::ElementsAre());
}

TEST(ViewLabels, AreInTheReportWhereThereIsAMap) {
    const Pair pair;
    BatchAnswer batch;
    batch.pairs.resize(1);
    batch.labels = {count(3, 2), count(7, 5)};
    const Document document;
    const LiveAnswer answer = liveAnswer(batch, 1, document.edit.instruments, 0);
    const Times times;
    StateReport report;
    report.answer = &answer;
    report.times = &times;
    report.frameTimes = report.times;
    report.document = &document;
    EXPECT_FALSE(nlohmann::json::parse(reportText(report)).contains("labels"));
    report.labels = &pair.labels;
    EXPECT_EQ(
        nlohmann::json::parse(reportText(report))["labels"],
        (nlohmann::json{{{"label", 7}, {"name", "skull"}, {"count", 5}}, {{"label", 3}, {"name", ""}, {"count", 2}}}));
}

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#include "view/state.h"

#include "view/model/histogram.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

State makeState() {
    Given given;
    given.volume = makeBuiltinVolume("head:16").value();
    given.mesh = makeBuiltinMesh("scalpel:300").value();
    given.values = checkVolume(given.volume.view()).value();
    given.document.edit.curve = {{40, 0}, {80, 1}};
    given.document.poses = {identity(), translation({0, 0, 50})};
    return State(std::move(given));
}

} // namespace

TEST(ViewState, ACommandIsANewQuestionAndUndoAnother) {
    State state = makeState();
    state.update();
    EXPECT_EQ(state.revision, 1U);
    state.command([](Edit& edit) { edit.threshold = 0.5; });
    state.update();
    EXPECT_EQ(state.revision, 2U);
    state.undo();
    state.update();
    EXPECT_EQ(state.revision, 3U);
    EXPECT_EQ(state.document.edit.threshold, kDefaultThreshold);
    state.redo();
    state.update();
    EXPECT_EQ(state.document.edit.threshold, 0.5);
}

TEST(ViewState, ACameraAsksForAPictureAndNoAnswer) {
    State state = makeState();
    state.update();
    const std::uint64_t picture = state.pictureRevision;
    state.camera.halfHeight *= 2;
    state.update();
    EXPECT_EQ(state.revision, 1U);
    EXPECT_EQ(state.pictureRevision, picture + 1);
    state.update();
    EXPECT_EQ(state.pictureRevision, picture + 1);
    EXPECT_FALSE(state.atRest());
}

TEST(ViewState, AnotherMethodIsAnotherQuestion) {
    State state = makeState();
    state.update();
    state.method = {CountingMethod::Query, Projection::View};
    state.update();
    EXPECT_EQ(state.revision, 2U);
}

TEST(ViewState, IsSettledWithTheAnswerOfWhatIsShownAndTheFinePicture) {
    State state = makeState();
    state.update();
    EXPECT_FALSE(state.settled());
    state.answer = LiveAnswer{};
    state.answer->revision = state.revision;
    state.update();
    state.fineShare = 1;
    EXPECT_TRUE(state.settled());
    state.command([](Edit& edit) { edit.world_from_object = translation({1, 2, 3}); });
    state.update();
    EXPECT_FALSE(state.settled());
    EXPECT_EQ(state.fineShare, 0);
}

TEST(ViewState, PosesOfTheListAreTaken) {
    State state = makeState();
    state.takePose(1);
    EXPECT_EQ(state.document.edit.world_from_object, translation({0, 0, 50}));
    EXPECT_EQ(state.document.pose, 1U);
    state.takePose(7);
    EXPECT_EQ(state.document.pose, 1U);
    EXPECT_TRUE(state.history.canUndo());
}

TEST(ViewState, WhatIsSavedHasCameraMethodAndCursor) {
    State state = makeState();
    state.cursor = {1, 2, 3};
    const Document saved = state.saved();
    EXPECT_EQ(saved.cursor, (Vec3{1, 2, 3}));
    EXPECT_TRUE(saved.camera.has_value());
    EXPECT_EQ(saved.method, state.method);
}

TEST(ViewHistogram, CountsEveryVoxelInItsBin) {
    std::vector<std::uint8_t> voxels(2 * 3 * 4);
    std::iota(voxels.begin(), voxels.end(), std::uint8_t{0}); // 0..23
    const VolumeView view{{{2, 3, 4}}, ScalarType::UInt8, std::as_bytes(std::span(voxels))};
    EXPECT_THAT(histogram(view, {0, 24}, 4), testing::ElementsAre(6, 6, 6, 6));
    EXPECT_THAT(histogram(view, {20, 23}, 3), testing::ElementsAre(1, 1, 2)); // the end is in the last
}

TEST(ViewHistogram, TellsTheValueOfTheNearestVoxel) {
    std::vector<std::int16_t> voxels{-5, 1, 2, 3, 4, 5, 6, 7};
    const VolumeView view{{{2, 2, 2}, {2, 2, 2}, {10, 0, 0}}, ScalarType::Int16, std::as_bytes(std::span(voxels))};
    const Mat4 texture_from_world = textureFromWorld(view.grid).value();
    EXPECT_EQ(valueAt(view, texture_from_world, {10, 0, 0}), -5);
    EXPECT_EQ(valueAt(view, texture_from_world, {12.9, 0.5, 0}), 1);
    EXPECT_EQ(valueAt(view, texture_from_world, {12, 2.5, 2.5}), 7);
    EXPECT_EQ(valueAt(view, texture_from_world, {8.9, 0, 0}), std::nullopt);
}

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#include "viewer/state.h"

#include "viewer/model/document/pose.h"
#include "viewer/model/shown/histogram.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <thread>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

State makeState() {
    Given given;
    given.volume = makeBuiltinVolume("head:16").value();
    given.meshes = {makeBuiltinMesh("scalpel:300").value()};
    given.values = checkVolume(given.volume.view()).value();
    given.document.sources.meshes = {{"tool.stl"}};
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

TEST(ViewState, StepsThatFollowCloselyAreOneForUndo) {
    State state = makeState();
    const auto step = [&state](const Vec3& by, bool held = false) {
        state.step([&by](Edit& edit) { edit.pose() = moved(edit.pose(), by, Axes::World); }, "nudge", held);
    };
    const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1050)); };
    step({1, 0, 0});
    step({1, 0, 0});
    wait();
    step({0, 3, 0});
    wait();
    step({0, 3, 0}, true); // a key that is held, by frames that are slow
    EXPECT_EQ(originOf(state.document.edit.pose()), (Vec3{2, 6, 0}));
    state.undo();
    EXPECT_EQ(originOf(state.document.edit.pose()), (Vec3{2, 0, 0}));
    state.undo();
    EXPECT_EQ(originOf(state.document.edit.pose()), (Vec3{0, 0, 0}));
    EXPECT_FALSE(state.history.canUndo());
}

TEST(ViewState, ColoursAreOfACommandToo) {
    State state = makeState();
    const std::vector<ColourPoint> blue{{0, {0, 0, 1}}};
    state.command([&](Edit& edit) { edit.colours = blue; });
    EXPECT_TRUE(sameColours(state.document.edit.colours, blue));
    state.undo();
    EXPECT_TRUE(state.document.edit.colours.empty());
    state.redo();
    EXPECT_TRUE(sameColours(state.document.edit.colours, blue));
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
    state.command([](Edit& edit) { edit.pose() = translation({1, 2, 3}); });
    state.update();
    EXPECT_FALSE(state.settled());
    EXPECT_EQ(state.fineShare, 0);
}

TEST(ViewState, PosesOfTheListAreTaken) {
    State state = makeState();
    state.takePose(1);
    EXPECT_EQ(state.document.edit.pose(), translation({0, 0, 50}));
    EXPECT_EQ(state.document.pose, 1U);
    state.takePose(7);
    EXPECT_EQ(state.document.pose, 1U);
    EXPECT_TRUE(state.history.canUndo());
}

TEST(ViewState, EachMeshHasAPoseOfItsOwnThatUndoGivesBack) {
    State state = makeState();
    state.document.edit.instruments.push_back({1, identity(), true});
    state.update();
    const std::uint64_t revision = state.revision;
    state.choose(1);
    state.update();
    EXPECT_EQ(state.revision, revision); // all are answered for anyway
    EXPECT_FALSE(state.history.canUndo());
    // The same kind of move of one and of the other are two commands.
    state.command([](Edit& edit) { edit.pose() = translation({1, 0, 0}); }, "nudge");
    state.choose(0);
    state.command([](Edit& edit) { edit.pose() = translation({2, 0, 0}); }, "nudge");
    state.update();
    EXPECT_EQ(state.revision, revision + 1);
    EXPECT_EQ(state.document.edit.instruments[0].world_from_object, translation({2, 0, 0}));
    EXPECT_EQ(state.document.edit.instruments[1].world_from_object, translation({1, 0, 0}));
    state.undo();
    EXPECT_EQ(state.document.edit.instruments[0].world_from_object, identity());
    EXPECT_EQ(state.document.edit.instruments[1].world_from_object, translation({1, 0, 0}));
    state.undo();
    EXPECT_EQ(state.document.edit.instruments[1].world_from_object, identity());
    state.choose(2);
    EXPECT_LT(state.document.edit.chosen, 2U);
}

TEST(ViewState, TheLastMeshIsNotRemovedAndUndoBringsTheOthersBack) {
    State state = makeState();
    state.document.edit.instruments = {
        {0, identity(), true}, {1, translation({1, 0, 0}), true}, {2, identity(), false}};
    state.choose(1);
    state.remove(0);
    EXPECT_EQ(state.document.edit.instrument().mesh, 1U); // the choice goes with its mesh
    state.remove(0);
    EXPECT_EQ(state.document.edit.instrument().mesh, 2U);
    state.remove(0);
    EXPECT_EQ(state.document.edit.instruments.size(), 1U);
    state.undo();
    EXPECT_EQ(state.document.edit.instruments.size(), 2U);
    EXPECT_EQ(state.document.edit.instrument().mesh, 1U);
    EXPECT_EQ(state.document.edit.pose(), translation({1, 0, 0}));
    state.undo();
    EXPECT_EQ(state.document.edit.instruments.size(), 3U);
    state.choose(2);
    state.remove(2);
    EXPECT_EQ(state.document.edit.instrument().mesh, 1U);
}

TEST(ViewState, NotesAreOfTheDocumentAsItStands) {
    State state = makeState();
    state.document.edit.instruments = {{0, identity(), true}, {1, identity(), true}};
    state.notesOf = [](const State& of) {
        std::vector<std::string> notes;
        if (of.document.edit.threshold > 0.5) {
            notes.emplace_back("high");
        }
        for (const Instrument& instrument : of.document.edit.instruments) {
            notes.push_back("mesh " + std::to_string(instrument.mesh));
        }
        return notes;
    };
    state.itemHeld = true; // whatever is held when it is opened
    const auto notes = [&state] {
        state.update();
        return state.notes;
    };
    using testing::ElementsAre;
    EXPECT_THAT(notes(), ElementsAre("mesh 0", "mesh 1"));
    state.itemHeld = false;
    state.command([](Edit& edit) { edit.threshold = 0.75; });
    EXPECT_THAT(notes(), ElementsAre("high", "mesh 0", "mesh 1"));
    state.remove(0);
    EXPECT_THAT(notes(), ElementsAre("high", "mesh 1"));
    state.undo();
    state.undo();
    EXPECT_THAT(notes(), ElementsAre("mesh 0", "mesh 1"));
    // What is dragged is not to go from under the pointer by a line more.
    state.itemHeld = true;
    state.command([](Edit& edit) { edit.threshold = 0.75; });
    EXPECT_THAT(notes(), ElementsAre("mesh 0", "mesh 1"));
    state.itemHeld = false;
    EXPECT_THAT(notes(), ElementsAre("high", "mesh 0", "mesh 1"));
}

TEST(ViewState, OffersAreMadeOnceAndGoWhenAnInstrumentMoves) {
    State state = makeState();
    int made = 0;
    state.offersOf = [&made](const State& of) {
        ++made;
        return std::vector<Offer>{{"far", "--mesh-space ras", {FileKind::Session, of.saved(), "tool.stl"}}};
    };
    state.update();
    state.command([](Edit& edit) { edit.threshold = 0.75; });
    state.update();
    EXPECT_EQ(state.offers.size(), 1U);
    state.command([](Edit& edit) { edit.pose() = moved(edit.pose(), {1, 0, 0}, Axes::World); });
    state.update();
    EXPECT_TRUE(state.offers.empty());
    EXPECT_EQ(made, 1);
    State next = makeState();
    state.passOn(next, FileKind::Session);
    next.update();
    EXPECT_EQ(next.offers.size(), 1U);
}

TEST(ViewState, NotesAreMadeAnewForWhatIsShownInstead) {
    State state = makeState();
    state.notesOf = [](const State& of) {
        return std::vector<std::string>{of.document.sources.meshes.back().path + " " +
                                        std::to_string(of.bounds[0].hi[0] > 0)};
    };
    state.update();
    EXPECT_THAT(state.notes, testing::ElementsAre("tool.stl 1"));
    State next = makeState();
    next.document.sources.meshes[0].path = "other.stl";
    state.passOn(next, FileKind::Session);
    next.update();
    EXPECT_THAT(next.notes, testing::ElementsAre("other.stl 1"));
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
    const Histogram some = histogramOf(view, {19.5, 22});
    EXPECT_THAT(some.counts, testing::ElementsAre(1, 1, 1));
    EXPECT_EQ(some.range.lo, 19.5);
    EXPECT_EQ(some.range.hi, 22.5);
    EXPECT_THAT(histogramOf(view, {0, 23}).counts, testing::Each(1));
    // More values than there are parts: a part has several.
    const Histogram all = histogramOf(view, {0, 1e6});
    EXPECT_EQ(std::accumulate(all.counts.begin(), all.counts.end(), std::uint64_t{0}), 24U);
    EXPECT_EQ(all.counts[0], 16U); // 0 to 15: a part is 1e6 / 65536, which is 15.3
}

TEST(ViewHistogram, OfFloatsIsInEqualParts) {
    const std::vector<float> voxels{0, 0.25F, 0.5F, 0.75F, 1, 2, -1, std::numeric_limits<float>::quiet_NaN()};
    const VolumeView view{{{2, 2, 2}}, ScalarType::Float32, std::as_bytes(std::span(voxels))};
    const Histogram all = histogramOf(view, {0, 1});
    EXPECT_EQ(all.counts.size(), 65536U);
    EXPECT_EQ(all.counts.front(), 1U);
    EXPECT_EQ(all.counts[16384], 1U);
    EXPECT_EQ(all.counts.back(), 1U); // the end is in the last
    EXPECT_EQ(std::accumulate(all.counts.begin(), all.counts.end(), std::uint64_t{0}), 5U);
}

TEST(ViewHistogram, BarsAreOfWhatIsShown) {
    Histogram whole{{-0.5, 99.5}, {}};
    for (std::uint64_t value = 0; value < 100; ++value) {
        whole.counts.push_back(value);
    }
    // Four values a bar.
    const Bars all = barsOf(whole, whole.range, 25);
    EXPECT_EQ(all.width, 4);
    EXPECT_EQ(all.first, -0.5);
    EXPECT_EQ(all.counts.size(), 25U);
    EXPECT_EQ(all.counts[2], 8U + 9 + 10 + 11);
    // Some of them: one value a bar, and what is beyond the ends is not there.
    const Bars some = barsOf(whole, {9.6, 13.2}, 25);
    EXPECT_EQ(some.width, 1);
    EXPECT_EQ(some.first, 9.5);
    EXPECT_THAT(some.counts, testing::ElementsAre(10, 11, 12, 13));
    // Moved: the same bars, though they begin outside.
    const Bars moved = barsOf(whole, {3, 99.5}, 25);
    EXPECT_EQ(moved.first, -0.5);
    EXPECT_EQ(moved.counts[2], all.counts[2]);
    EXPECT_THAT(barsOf(whole, {-8, -2}, 25).counts, testing::IsEmpty());
    EXPECT_THAT(barsOf(whole, {200, 300}, 25).counts, testing::IsEmpty());
    EXPECT_EQ(barsOf(whole, {-1000, 1000}, 25).counts.size(), 25U);
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

TEST(ViewState, GivesBackAllThatItShows) {
    State state = makeState();
    state.update();
    state.drillRadius = 30;
    state.drill({0, 0, 0});
    state.update();
    state.drill({0, 0, 40});
    state.update();
    state.undo();
    state.command([](Edit& edit) { edit.threshold = 0.5; });
    state.update();
    state.gizmoAxes = GizmoAxes::Own;
    state.window = {10, 20};
    const std::vector<std::byte> drilled = state.volume.voxels;
    Given given = state.giveBack();
    EXPECT_TRUE(state.blank);
    EXPECT_EQ(given.volume.voxels, makeState().volume.voxels);
    State again(std::move(given));
    EXPECT_FALSE(again.blank);
    EXPECT_EQ(again.volume.voxels, drilled);
    EXPECT_EQ(again.document.edit.holes, 1U);
    EXPECT_EQ(again.document.edit.threshold, 0.5);
    EXPECT_EQ(again.gizmoAxes, GizmoAxes::Own);
    EXPECT_EQ(again.window.hi, 20);
    EXPECT_EQ(again.writes.end(), 0U);
}

TEST(ViewState, WhatIsDoneWhileAMeshIsLoadedStays) {
    State state = makeState();
    state.update();
    state.drillRadius = 30;
    state.drill({0, 0, 0});
    state.update();
    Given given;
    given.volume = makeBuiltinVolume("head:16").value();
    given.meshes = {makeBuiltinMesh("scalpel:600").value()};
    given.values = state.values;
    given.document = state.saved();
    given.document.sources.meshes.push_back({"other.stl"});
    given.meshes = {state.meshes.front(), given.meshes.front()};
    State next(std::move(given));
    ASSERT_EQ(next.volume.voxels, state.volume.voxels);
    // Meanwhile: the hole is filled, another one drilled, and the instrument moved.
    state.undo();
    state.update();
    state.drill({0, 0, 40});
    state.command([](Edit& edit) { edit.pose() = translation({7, 0, 0}); });
    state.update();
    state.stepMillimetres = 3;
    const std::vector<std::byte> drilled = state.volume.voxels;
    state.passOn(next, FileKind::Mesh);
    EXPECT_EQ(next.volume.voxels, drilled);
    EXPECT_FALSE(next.writes.kept() == 0); // the copy on the device is that of before
    EXPECT_EQ(next.document.sources.meshes.at(1).path, "other.stl");
    EXPECT_EQ(next.document.edit.instrument().mesh, 1U);
    EXPECT_EQ(next.document.edit.pose(), translation({7, 0, 0}));
    EXPECT_EQ(next.stepMillimetres, 3);
    next.undo(); // of the mesh, which redo brings back
    EXPECT_EQ(next.document.edit.instruments.size(), 1U);
    next.redo();
    EXPECT_EQ(next.document.edit.instruments.size(), 2U);
    next.undo();
    next.undo();
    next.undo();
    next.update();
    EXPECT_EQ(next.document.edit.holes, 0U);
    EXPECT_EQ(next.volume.voxels, makeState().volume.voxels);
}

TEST(ViewState, AnotherVolumeHasItsOwnCurveAndNoHoles) {
    State state = makeState();
    state.drillRadius = 30;
    state.drill({0, 0, 0});
    state.update();
    state.command([](Edit& edit) { edit.pose() = translation({7, 0, 0}); });
    Given given;
    given.volume = makeBuiltinVolume("head:16").value();
    given.meshes = {makeBuiltinMesh("scalpel:300").value()};
    given.values = state.values;
    given.document.sources = state.document.sources;
    given.document.edit.curve = {{1, 0}, {2, 1}};
    State next(std::move(given));
    state.passOn(next, FileKind::Volume);
    EXPECT_EQ(next.document.edit.curve.front().value, 1);
    EXPECT_EQ(next.document.edit.holes, 0U);
    EXPECT_TRUE(next.saved().holes.empty());
    EXPECT_EQ(next.document.edit.pose(), translation({7, 0, 0}));
    EXPECT_FALSE(next.history.canUndo());
}

} // namespace voxtact::test

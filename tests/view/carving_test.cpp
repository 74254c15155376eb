// SPDX-License-Identifier: MIT
#include "viewer/model/answers/command_text.h"
#include "viewer/model/document/carving.h"
#include "viewer/model/shown/histogram.h"
#include "viewer/state.h"

#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

VolumeData head() {
    return makeBuiltinVolume("head:16").value();
}

Vec3 middleOf(const Grid& grid) {
    return transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
}

State makeState() {
    Given given;
    given.volume = head();
    given.meshes = {makeBuiltinMesh("scalpel:300").value()};
    given.document.sources.meshes = {{"builtin:scalpel:300"}};
    given.values = checkVolume(given.volume.view()).value();
    given.document.edit.curve = {{40, 0}, {80, 1}};
    return State(std::move(given));
}

} // namespace

TEST(ViewCarving, ChangesTheVoxelsWhoseCentresAreInTheBallAndNoOthers) {
    VolumeData volume = head();
    const VolumeData before = volume;
    const Vec3 middle = middleOf(volume.grid);
    const double radius = 3.3 * volume.grid.spacing[0];
    Result<Hole> hole = holeOf(volume.view(), {middle, radius}, 7);
    ASSERT_TRUE(hole.ok()) << hole.error().text;
    Holes holes;
    holes.add(std::move(*hole));
    EXPECT_EQ(holes.bring(volume, 1).size(), 1U);
    const auto [nx, ny, nz] = volume.grid.size;
    const std::size_t bytes = bytesPerVoxel(volume.type);
    std::size_t inside = 0;
    for (std::uint32_t i = 0; i < nx * ny * nz; ++i) {
        const std::array at{i % nx, i / nx % ny, i / nx / ny};
        const Vec3 texture{(at[0] + 0.5) / nx, (at[1] + 0.5) / ny, (at[2] + 0.5) / nz};
        const Vec3 centre = transformPoint(worldFromTexture(volume.grid), texture);
        const bool in = std::hypot(centre[0] - middle[0], centre[1] - middle[1], centre[2] - middle[2]) <= radius;
        inside += in ? 1 : 0;
        const std::size_t first = i * bytes;
        ASSERT_EQ(std::to_integer<int>(volume.voxels[first]), in ? 7 : std::to_integer<int>(before.voxels[first])) << i;
    }
    EXPECT_GT(inside, 20U);
}

TEST(ViewCarving, FillingInReverseOrderGivesTheVolumeBack) {
    VolumeData volume = head();
    const VolumeData before = volume;
    const Vec3 middle = middleOf(volume.grid);
    Holes holes;
    for (const double off : {0.0, 10.0, -12.0}) { // they overlap
        Result<Hole> hole = holeOf(volume.view(), {{middle[0] + off, middle[1], middle[2]}, 30}, 0);
        ASSERT_TRUE(hole.ok());
        holes.add(std::move(*hole));
        (void)holes.bring(volume, holes.drilled() + 1);
    }
    const VolumeData drilled = volume;
    EXPECT_NE(drilled.voxels, before.voxels);
    const std::vector<HoleWrite> done = holes.bring(volume, 0);
    EXPECT_EQ(done.size(), 3U);
    EXPECT_TRUE(done.front().filled);
    EXPECT_EQ(volume.voxels, before.voxels);
    (void)holes.bring(volume, 3);
    EXPECT_EQ(volume.voxels, drilled.voxels);
    EXPECT_TRUE(holes.bring(volume, 9).empty());
}

TEST(ViewCarving, OutsideOfTheVolumeIsNothingAndNonsenseIsRefused) {
    const VolumeData volume = head();
    const Result<Hole> outside = holeOf(volume.view(), {{1e6, 0, 0}, 3}, 0);
    ASSERT_TRUE(outside.ok());
    EXPECT_TRUE(outside->after.empty());
    EXPECT_FALSE(holeOf(volume.view(), {{0, 0, 0}, -1}, 0).ok());
    EXPECT_FALSE(holeOf(volume.view(), {{0, 0, 0}, 3}, 0.5).ok());
}

TEST(ViewCarving, WritesAreForgottenWhenAllHaveThem) {
    HoleWrites writes;
    for (const bool filled : {false, true, false}) {
        writes.add({nullptr, filled});
    }
    EXPECT_EQ(writes.from(0).size(), 3U);
    writes.forget(1);
    EXPECT_EQ(writes.kept(), 2U);
    EXPECT_EQ(writes.end(), 3U);
    EXPECT_TRUE(writes.from(1).front().filled);
    writes.forget(0); // one has not more than the other
    EXPECT_EQ(writes.from(2).size(), 1U);
    writes.forget(7);
    EXPECT_EQ(writes.kept(), 0U);
    writes.add({nullptr, true});
    EXPECT_EQ(writes.end(), 4U);
    EXPECT_TRUE(writes.from(3).front().filled);
    EXPECT_TRUE(writes.from(4).empty());
}

TEST(ViewCarving, IsACommandThatUndoTakesBack) {
    State state = makeState();
    const std::vector<std::byte> before = state.volume.voxels;
    state.drillRadius = 30;
    state.update();
    const std::uint64_t revision = state.revision;
    state.drill(middleOf(state.volume.grid));
    state.update();
    EXPECT_EQ(state.document.edit.holes, 1U);
    EXPECT_EQ(state.revision, revision + 1);
    ASSERT_EQ(state.writes.kept(), 1U);
    const std::vector<std::byte> drilled = state.volume.voxels;
    EXPECT_NE(drilled, before);
    state.undo();
    state.update();
    EXPECT_EQ(state.volume.voxels, before);
    ASSERT_EQ(state.writes.kept(), 2U);
    EXPECT_TRUE(state.writes.from(1).front().filled);
    state.redo();
    state.update();
    EXPECT_EQ(state.volume.voxels, drilled);
    // What was undone is forgotten by the next hole.
    state.undo();
    state.drill({1e6, 0, 0});
    EXPECT_EQ(state.document.edit.holes, 0U);
    EXPECT_NE(state.status, "");
    state.drillRadius = 20;
    state.drill(middleOf(state.volume.grid));
    state.update();
    EXPECT_NE(state.volume.voxels, drilled);
    state.undo();
    state.update();
    EXPECT_EQ(state.volume.voxels, before);
}

TEST(ViewCarving, TheHistogramIsThatOfWhatIsLeft) {
    State state = makeState();
    const auto counted = [&] { return histogramOf(state.volume.view(), state.document.domain); };
    ASSERT_EQ(state.histogram, counted());
    const Histogram whole = state.histogram;
    state.drillRadius = 30;
    state.drill(middleOf(state.volume.grid));
    state.drillRadius = 45;
    state.drill(middleOf(state.volume.grid));
    state.update();
    EXPECT_EQ(state.histogram, counted());
    EXPECT_FALSE(state.histogram == whole);
    state.undo();
    state.undo();
    state.update();
    EXPECT_EQ(state.histogram, whole);
}

TEST(ViewCarving, ACopiedCommandSaysThatItHasNoHoles) {
    State state = makeState();
    EXPECT_EQ(copyAsCommand(state.document, {}, "").find('#'), std::string::npos);
    state.document.edit.holes = 2;
    EXPECT_THAT(copyAsCommand(state.document, {}, ""),
                testing::StartsWith("# for the volume in the file, without the 2 drilled holes\necho "));
}

} // namespace voxtact::test

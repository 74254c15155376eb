// SPDX-License-Identifier: MIT
#include "viewer/model/files/open_file.h"
#include "viewer/model/files/save_file.h"
#include "viewer/model/files/session_file.h"

#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include <unistd.h>

namespace voxtact::test {

using namespace voxtact::view;
using testing::HasSubstr;

namespace {

class ViewOpen : public testing::Test {
  protected:
    ViewOpen()
        : folder_(std::filesystem::path(testing::TempDir()) / ("voxtact_open_" + std::to_string(getpid()))),
          state_(given()) {
        std::filesystem::create_directories(folder_);
    }
    ~ViewOpen() override { std::filesystem::remove_all(folder_); }

    static Given given() {
        Given out;
        out.volume = makeBuiltinVolume("head:16").value();
        out.meshes = {makeBuiltinMesh("scalpel:300").value()};
        out.values = checkVolume(out.volume.view()).value();
        out.document.sources = {"builtin:head:16", {{"builtin:scalpel:300", "ras", 2}}, "atlas.nii", "names.txt", 1};
        out.document.edit.curve = {{40, 0}, {80, 1}};
        return out;
    }
    std::filesystem::path file(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }

    std::filesystem::path folder_;
    State state_;
};

} // namespace

TEST_F(ViewOpen, TheEndingSaysWhatItIs) {
    EXPECT_EQ(kindOfFile("a.STL").value(), FileKind::Mesh);
    EXPECT_EQ(kindOfFile("a.glb").value(), FileKind::Mesh);
    EXPECT_EQ(kindOfFile("a.txt").value(), FileKind::Poses);
    EXPECT_EQ(kindOfFile("a.nii.gz").value(), FileKind::Volume);
    EXPECT_EQ(kindOfFile(folder_).value(), FileKind::Volume);
    EXPECT_EQ(kindOfFile(file("f.json", "{\"points\": [[0, 0], [1, 1]]}")).value(), FileKind::Function);
    EXPECT_EQ(kindOfFile(file("s.json", "{\"voxtact_session\": 1}")).value(), FileKind::Session);
    EXPECT_EQ(kindOfFile(file("bad.json", "{")).value(), FileKind::Function); // whose reader says what is wrong
    const Result<FileKind> none = kindOfFile(folder_ / "nowhere.json");
    ASSERT_FALSE(none.ok());
    EXPECT_THAT(none.error().text, HasSubstr("nowhere.json"));
}

TEST_F(ViewOpen, PosesAndFunctionsAreCommands) {
    ASSERT_TRUE(openFile(file("p.txt", "1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1\n"), state_).ok());
    EXPECT_EQ(state_.document.edit.pose(), translation({5, 6, 7}));
    ASSERT_TRUE(openFile(file("f.json", "{\"points\": [[10, 0], [20, 0.5], [30, 1]]}"), state_).ok());
    EXPECT_EQ(state_.document.edit.curve.size(), 3U);
    EXPECT_FALSE(state_.wanted.has_value());
    state_.undo();
    EXPECT_EQ(state_.document.edit.curve.size(), 2U);
}

TEST_F(ViewOpen, AMeshMoreKeepsTheRest) {
    state_.drillRadius = 40;
    state_.drill({0, 0, 0});
    state_.update();
    ASSERT_TRUE(openFile("/data/tool.stl", state_).ok());
    ASSERT_TRUE(state_.wanted.has_value());
    EXPECT_EQ(state_.wanted->kind, FileKind::Mesh);
    const Sources& sources = state_.wanted->document.sources;
    ASSERT_EQ(sources.meshes.size(), 2U);
    EXPECT_EQ(sources.meshes[0].path, "builtin:scalpel:300");
    EXPECT_EQ(sources.meshes[0].space, "ras");
    EXPECT_EQ(sources.meshes[1].path, "/data/tool.stl");
    EXPECT_EQ(sources.meshes[1].space, "lps");
    EXPECT_EQ(sources.meshes[1].scale, 1);
    EXPECT_EQ(sources.volume, "builtin:head:16");
    EXPECT_EQ(sources.labels, "atlas.nii");
    EXPECT_TRUE(state_.wanted->document.camera.has_value());
    EXPECT_EQ(state_.wanted->document.edit.holes, 1U);
    EXPECT_EQ(state_.wanted->document.holes.size(), 1U);
}

TEST_F(ViewOpen, AnotherVolumeHasNotTheLabelsAndHolesOfTheOneBefore) {
    state_.document.edit.holes = 3;
    ASSERT_TRUE(openFile("/data/other.nrrd", state_).ok());
    ASSERT_TRUE(state_.wanted.has_value());
    EXPECT_EQ(state_.wanted->document.sources.volume, "/data/other.nrrd");
    EXPECT_EQ(state_.wanted->document.sources.labels, "");
    EXPECT_EQ(state_.wanted->document.sources.labelNames, "");
    EXPECT_EQ(state_.wanted->document.edit.holes, 0U);
    EXPECT_FALSE(state_.wanted->document.camera.has_value());
}

TEST_F(ViewOpen, ASessionIsReadWhole) {
    Document other = state_.saved();
    other.sources.volume = "builtin:ct:16";
    ASSERT_TRUE(writeSession(folder_ / "s.json", other).ok());
    ASSERT_TRUE(openFile(folder_ / "s.json", state_).ok());
    ASSERT_TRUE(state_.wanted.has_value());
    EXPECT_EQ(state_.wanted->document.sources.volume, "builtin:ct:16");
}

TEST_F(ViewOpen, WhatIsWrongChangesNothing) {
    const Edit before = state_.document.edit;
    EXPECT_FALSE(openFile(file("p.txt", "1 2 3\n"), state_).ok());
    EXPECT_FALSE(openFile(file("f.json", "{"), state_).ok());
    EXPECT_FALSE(openFile(file("s.json", "{\"voxtact_session\": 1}"), state_).ok());
    EXPECT_EQ(state_.document.edit, before);
    EXPECT_FALSE(state_.wanted.has_value());
}

TEST_F(ViewOpen, WhatIsDroppedIsOpenedOneAfterTheOther) {
    const std::string poses = file("poses.txt", "1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n").string();
    const std::string curve = file("curve.json", R"({"points": [[1, 0], [2, 1]]})").string();
    const std::array<const char*, 2> first{poses.c_str(), "/data/tool.stl"};
    const char* const second = curve.c_str();
    state_.drop(2, first.data());
    state_.drop(1, &second);
    takeDropped(state_);
    EXPECT_EQ(state_.document.edit.pose(), translation({5, 0, 0}));
    EXPECT_EQ(state_.document.edit.curve.front().value, 1);
    ASSERT_TRUE(state_.wanted.has_value());
    EXPECT_EQ(state_.wanted->path, "/data/tool.stl");
    EXPECT_THAT(state_.taken, testing::ElementsAre(poses, curve));
    EXPECT_EQ(state_.error, "");
    EXPECT_TRUE(state_.dropped.empty());
    // What cannot be opened changes nothing, and is told of.
    const std::string broken = file("broken.json", R"({"points": [[2, 0], [1, 1]]})").string();
    const char* const third = broken.c_str();
    state_.drop(1, &third);
    takeDropped(state_);
    EXPECT_THAT(state_.error, HasSubstr("broken.json"));
    EXPECT_EQ(state_.document.edit.curve.front().value, 1);
}

TEST_F(ViewOpen, OfSeveralFilesAtOnceNoneIsLost) {
    const std::array<const char*, 3> paths{"/data/a.stl", "/data/other.nrrd", "/data/b.stl"};
    state_.drop(3, paths.data());
    takeDropped(state_);
    ASSERT_TRUE(state_.wanted.has_value());
    EXPECT_EQ(state_.wanted->kind, FileKind::Volume);
    const Sources& sources = state_.wanted->document.sources;
    EXPECT_EQ(sources.volume, "/data/other.nrrd");
    ASSERT_EQ(sources.meshes.size(), 3U);
    EXPECT_EQ(sources.meshes[1].path, "/data/a.stl");
    EXPECT_EQ(sources.meshes[2].path, "/data/b.stl");
}

TEST_F(ViewOpen, WithNothingToShowItNeedsAVolume) {
    State blank;
    EXPECT_FALSE(openFile("/data/tool.stl", blank).ok());
    EXPECT_FALSE(openFile(file("poses.txt", "1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n"), blank).ok());
    ASSERT_TRUE(openFile("/data/head.nii", blank).ok());
    EXPECT_EQ(blank.wanted->document.sources.volume, "/data/head.nii");
}

TEST_F(ViewOpen, WhatIsReadIsNotWrittenOver) {
    using Save = Result<void> (*)(const std::filesystem::path&, const State&);
    const std::filesystem::path poses = file("poses.txt", "1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n");
    const std::filesystem::path curve = file("curve.json", R"({"points": [[1, 0], [2, 1]]})");
    ASSERT_TRUE(openFile(poses, state_).ok());
    ASSERT_TRUE(openFile(curve, state_).ok());
    std::vector<std::string> asked;
    state_.mayWrite = [&asked](const std::filesystem::path& output, const std::vector<std::string>& inputs) {
        asked = inputs;
        const bool reads = std::ranges::find(inputs, output.string()) != inputs.end();
        return reads ? Result<void>(Error{ErrorCode::InvalidArgument, 0, "it is read"}) : Result<void>();
    };
    EXPECT_EQ(savePose(poses, state_).error().text, "it is read");
    EXPECT_EQ(saveFunction(curve, state_).error().text, "it is read");
    EXPECT_THAT(asked, testing::UnorderedElementsAre(poses.string(), curve.string(), "builtin:head:16",
                                                     "builtin:scalpel:300", "atlas.nii", "names.txt"));
    for (const Save save : {&saveSession, &saveFunction, &savePose}) {
        EXPECT_EQ(save("atlas.nii", state_).error().text, "it is read");
    }
    EXPECT_EQ(io::readPoses(poses).value().size(), 1U);
    State next(given()); // after another volume was opened
    state_.passOn(next, FileKind::Volume);
    EXPECT_EQ(savePose(poses, next).error().text, "it is read");
}

TEST_F(ViewOpen, WhatIsOfAnotherKindIsNotWrittenOver) {
    const std::filesystem::path other = file("notes.md", "keep me");
    EXPECT_THAT(saveSession(other, state_).error().text, HasSubstr("exists and is no session"));
    EXPECT_THAT(saveFunction(other, state_).error().text, HasSubstr("is no transfer function"));
    EXPECT_THAT(savePose(other, state_).error().text, HasSubstr("is no file of poses"));
    // And before anybody is asked whether it is to be replaced.
    EXPECT_THAT(checkSession(other, state_).error().text, HasSubstr("exists and is no session"));
    EXPECT_THAT(checkFunction(other, state_).error().text, HasSubstr("is no transfer function"));
    EXPECT_THAT(checkPose(other, state_).error().text, HasSubstr("is no file of poses"));
    EXPECT_THAT(checkPicture(other, state_).error().text, HasSubstr("the ending must be .png"));
    EXPECT_THAT(checkPicture(file("text.png", "no picture"), state_).error().text, HasSubstr("is no picture"));
    EXPECT_TRUE(checkPicture(folder_ / "new.PNG", state_).ok());
    std::ifstream kept(other);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), "keep me");
    for (int again = 0; again < 2; ++again) {
        EXPECT_TRUE(saveSession(folder_ / "s.json", state_).ok());
        EXPECT_TRUE(saveFunction(folder_ / "c.json", state_).ok());
        EXPECT_TRUE(savePose(folder_ / "p.txt", state_).ok());
    }
    EXPECT_TRUE(isSession(folder_ / "s.json").value());
    EXPECT_EQ(io::readPoses(folder_ / "p.txt").value().size(), 1U);
}

} // namespace voxtact::test

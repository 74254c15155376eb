// SPDX-License-Identifier: MIT
#include "viewer/model/files/missing_files.h"
#include "viewer/model/files/progress.h"
#include "viewer/model/files/state_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include <unistd.h>

namespace voxtact::test {

using namespace voxtact::view;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

class ViewKeptFiles : public testing::Test {
  protected:
    ViewKeptFiles()
        : folder_(std::filesystem::path(testing::TempDir()) / ("voxtact_kept_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~ViewKeptFiles() override { std::filesystem::remove_all(folder_); }

    std::string file(const std::string& name, const std::string& text = "x") const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
};

} // namespace

TEST_F(ViewKeptFiles, RecentFilesAreKeptTheLastFirstEachOnce) {
    const std::filesystem::path path = folder_ / "deeper" / "recent.json";
    RecentFiles recent(path);
    EXPECT_THAT(recent.paths(), IsEmpty());
    recent.add("/a.nii");
    recent.add("builtin:head");
    recent.add("/folder/../b \"quoted\".stl");
    recent.add("/a.nii");
    EXPECT_THAT(recent.paths(), ElementsAre("/a.nii", "/b \"quoted\".stl"));
    EXPECT_EQ(RecentFiles(path).paths(), recent.paths());
    for (int i = 0; i < 20; ++i) {
        recent.add("/" + std::to_string(i));
    }
    EXPECT_EQ(RecentFiles(path).paths().size(), RecentFiles::kMost);
    EXPECT_EQ(RecentFiles(path).paths().front(), "/19");
}

TEST_F(ViewKeptFiles, WhatIsNoListOfFilesIsNone) {
    for (const char* text : {"", "{", "{\"a\": 1}", "[1, null, {}]", "\xFF\xFE"}) {
        EXPECT_THAT(RecentFiles(file("recent.json", text)).paths(), IsEmpty()) << text;
    }
    EXPECT_THAT(RecentFiles(folder_).paths(), IsEmpty());
    // Nowhere to keep it: of this run it is known nevertheless.
    RecentFiles nowhere;
    nowhere.add("/a.nii");
    EXPECT_THAT(nowhere.paths(), ElementsAre("/a.nii"));
    RecentFiles unwritable(std::filesystem::path(file("plain")) / "recent.json");
    unwritable.add("/a.nii");
    EXPECT_THAT(unwritable.paths(), ElementsAre("/a.nii"));
}

TEST_F(ViewKeptFiles, TheFolderIsThatOfTheSpecification) {
    const char* const before = std::getenv("XDG_STATE_HOME");
    const std::string kept = before == nullptr ? "" : before;
    ASSERT_EQ(setenv("XDG_STATE_HOME", folder_.c_str(), 1), 0);
    EXPECT_EQ(stateFolder(), folder_ / "voxtact");
    ASSERT_EQ(setenv("XDG_STATE_HOME", "not/absolute", 1), 0);
    EXPECT_NE(stateFolder(), std::filesystem::path("not/absolute/voxtact"));
    before == nullptr ? unsetenv("XDG_STATE_HOME") : setenv("XDG_STATE_HOME", kept.c_str(), 1);
}

TEST_F(ViewKeptFiles, MissingFilesAreNamedAndLookedForBesideTheSession) {
    Sources sources;
    sources.volume = "/gone/ct.nii";
    sources.meshes = {{file("tool.stl")}};
    sources.labels = "/gone/atlas.nii";
    const std::string beside = file("ct.nii");
    const std::vector<MissingFile> files = missingFiles(sources, folder_ / "session.json");
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0].name, "volume");
    EXPECT_EQ(files[0].path, beside);
    EXPECT_EQ(files[1].name, "label map");
    EXPECT_EQ(files[1].path, "/gone/atlas.nii");
    const Sources now = found(sources, files);
    EXPECT_EQ(now.volume, beside);
    EXPECT_EQ(now.meshes.at(0).path, sources.meshes.at(0).path);
    EXPECT_EQ(missingFiles(now, {}).size(), 1U);
    // Of several meshes each has a name of its own.
    sources.meshes = {{"/gone/a.stl"}, {file("tool.stl")}, {"/gone/b.stl"}};
    std::vector<MissingFile> gone = missingFiles(sources, {});
    ASSERT_EQ(gone.size(), 4U);
    EXPECT_EQ(gone[1].name, "mesh 1");
    EXPECT_EQ(gone[2].name, "mesh 3");
    gone[2].path = beside;
    EXPECT_EQ(found(sources, gone).meshes[2].path, beside);
    EXPECT_EQ(found(sources, gone).meshes[0].path, "/gone/a.stl");
    // An image of several in a file, and what is builtin.
    sources = {};
    sources.volume = file("several.nii") + "#3";
    sources.meshes = {{"builtin:scalpel"}};
    EXPECT_THAT(missingFiles(sources, {}), IsEmpty());
}

TEST(ViewProgress, EndsAtTheNextStep) {
    Progress progress;
    EXPECT_EQ(progress.now().step, "");
    ASSERT_TRUE(progress.begin("reading").ok());
    EXPECT_FALSE(progress.now().share);
    EXPECT_TRUE(progress.tell(0.5));
    EXPECT_EQ(progress.now().share, 0.5);
    ASSERT_TRUE(progress.begin("drawing").ok());
    EXPECT_FALSE(progress.now().share);
    progress.cancel();
    EXPECT_FALSE(progress.tell(0.5));
    const Result<void> next = progress.begin("more");
    ASSERT_FALSE(next.ok());
    EXPECT_EQ(next.error().code, ErrorCode::Cancelled);
    EXPECT_EQ(progress.now().step, "drawing");
}

} // namespace voxtact::test

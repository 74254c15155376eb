// SPDX-License-Identifier: MIT
#include "viewer/model/files/session_file.h"

#include "voxtact/io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace voxtact::test {

using namespace voxtact::view;
using testing::HasSubstr;

namespace {

Document document() {
    Document out;
    out.sources = {"head.nii.gz", {{"tool.stl", "ras", 0.001}}, "atlas.nii.gz", "atlas names.txt", 1};
    out.edit.curve = {{-40.5, 0}, {1.0 / 3, 0.1}, {80, 1}};
    out.edit.threshold = 0.25;
    out.edit.pose() = translation({1.5, -2, 1.0 / 3});
    out.edit.colours = {{0, {0, 0.5, 1}}, {100, {1, 1, 1}}};
    out.domain = {-1024, 3071};
    out.tableSize = 512;
    out.poses = {identity(), translation({1, 2, 3})};
    out.pose = 1;
    out.method = MethodChoice{CountingMethod::Atomic, Projection::TwoView};
    out.camera = Camera{{1, 2, 3}, {30, -10}, 77};
    out.cursor = Vec3{4, 5, 6};
    out.sources.coarser = 2;
    out.holes = {{{1, 2, 3}, 4}, {{-1, 0.5, 1.0 / 3}, 2.5}};
    out.edit.holes = 2;
    out.shown = Shown{GizmoAxes::Own, false, false, false, Maximised::Slice1,
                      Theme::Light,   0.25,  2.5,   7.5,   ValueRange{-10, 300}};
    return out;
}

/// The same with three meshes of four that were opened.
Document several() {
    Document out = document();
    out.sources.meshes = {{"tool.stl", "ras", 0.001}, {"gone.stl"}, {"screw.ply"}, {"plate.obj", "lps", 2}};
    out.edit.instruments = {
        {3, translation({3, 0, 0}), true}, {0, translation({0, 1, 0}), false}, {2, translation({2, 0, 1.0 / 3}), true}};
    out.edit.chosen = 2;
    return out;
}

/// The session with one member changed: the error's text.
std::string refused(const std::string& pointer, const nlohmann::json& value, const Document& of = document()) {
    nlohmann::json json = nlohmann::json::parse(sessionText(of));
    json[nlohmann::json::json_pointer(pointer)] = value;
    const Result<Document> parsed = parseSession(json.dump(), "s.json");
    return parsed.ok() ? "" : parsed.error().text;
}

} // namespace

TEST(ViewSession, RefusesWhatCannotBeShown) {
    EXPECT_THAT(refused("/volume_coarser", 0), HasSubstr("volume_coarser"));
    EXPECT_THAT(refused("/volume_coarser", 1.5), HasSubstr("volume_coarser"));
    EXPECT_THAT(refused("/holes/0", {1, 2, 3}), HasSubstr("holes[0]"));
    EXPECT_THAT(refused("/holes/1/3", -1), HasSubstr("holes[1]"));
    EXPECT_THAT(refused("/shown/handle_axes", "mine"), HasSubstr("shown.handle_axes"));
    EXPECT_THAT(refused("/shown/handles", 1), HasSubstr("shown.handles"));
    EXPECT_THAT(refused("/shown/maximised", "all"), HasSubstr("shown.maximised"));
    EXPECT_THAT(refused("/shown/theme", "blue"), HasSubstr("shown.theme"));
    EXPECT_THAT(refused("/shown/drill_radius_mm", 0), HasSubstr("shown.drill_radius_mm"));
    EXPECT_THAT(refused("/shown/window", {2, 1}), HasSubstr("shown.window"));
}

TEST(ViewSession, ComesBackAsItWas) {
    const Document before = document();
    const Result<Document> after = parseSession(sessionText(before), "s.json");
    ASSERT_TRUE(after.ok()) << after.error().text;
    EXPECT_EQ(sessionText(*after), sessionText(before));
    EXPECT_EQ(after->edit, before.edit);
    EXPECT_EQ(after->poses, before.poses);
    EXPECT_EQ(after->method, before.method);
    EXPECT_EQ(after->cursor, before.cursor);
    EXPECT_EQ(after->sources.meshes.at(0).space, "ras");
    EXPECT_EQ(after->sources.labels, "atlas.nii.gz");
    EXPECT_EQ(after->sources.coarser, 2U);
    ASSERT_EQ(after->holes.size(), 2U);
    EXPECT_EQ(after->holes[1].centre, before.holes[1].centre);
    EXPECT_EQ(after->holes[1].radius, 2.5);
    ASSERT_TRUE(after->shown.has_value());
    EXPECT_EQ(after->shown->handleAxes, GizmoAxes::Own);
    EXPECT_EQ(after->shown->maximised, Maximised::Slice1);
    EXPECT_EQ(after->shown->theme, Theme::Light);
    EXPECT_FALSE(after->shown->handles || after->shown->contacts || after->shown->logHistogram);
    EXPECT_EQ(after->shown->drillRadius, 7.5);
    EXPECT_EQ(after->shown->window->hi, 300);
    EXPECT_EQ(after->sources.labelNames, "atlas names.txt");
    EXPECT_EQ(after->camera->halfHeight, 77);
}

TEST(ViewSession, HasAllMeshesThatAreThere) {
    const Result<Document> after = parseSession(sessionText(several()), "s.json");
    ASSERT_TRUE(after.ok()) << after.error().text;
    EXPECT_EQ(sessionText(*after), sessionText(several()));
    ASSERT_EQ(after->sources.meshes.size(), 3U);
    EXPECT_EQ(after->sources.meshes[0].path, "plate.obj");
    EXPECT_EQ(after->sources.meshes[0].scale, 2);
    EXPECT_EQ(after->sources.meshes[1].space, "ras");
    ASSERT_EQ(after->edit.instruments.size(), 3U);
    EXPECT_FALSE(after->edit.instruments[1].shown);
    EXPECT_EQ(after->edit.chosen, 2U);
    EXPECT_EQ(after->edit.pose(), several().edit.pose());
    // A program that knows of one mesh has the chosen one.
    nlohmann::json json = nlohmann::json::parse(sessionText(several()));
    EXPECT_EQ(json["mesh"], "screw.ply");
    json.erase("meshes");
    const Result<Document> one = parseSession(json.dump(), "s.json");
    ASSERT_TRUE(one.ok()) << one.error().text;
    EXPECT_EQ(one->edit.instruments.size(), 1U);
    EXPECT_EQ(one->edit.pose(), several().edit.pose());
    EXPECT_FALSE(nlohmann::json::parse(sessionText(document())).contains("meshes"));
}

TEST(ViewSession, WhatIsWrongWithAMeshIsNamed) {
    using Json = nlohmann::json;
    EXPECT_EQ(refused("/meshes/0/mesh_space", "lps", several()), "");
    EXPECT_THAT(refused("/meshes", Json::array(), several()), HasSubstr("meshes: is empty"));
    EXPECT_THAT(refused("/meshes", 3, several()), HasSubstr("meshes: is not an array"));
    EXPECT_THAT(refused("/meshes/1", 3, several()), HasSubstr("meshes[1]: is not an object"));
    EXPECT_THAT(refused("/meshes/1/mesh", Json(), several()), HasSubstr("meshes[1]: mesh: is missing"));
    EXPECT_THAT(refused("/meshes/1/mesh_scale", 0, several()), HasSubstr("meshes[1]: mesh_scale: "));
    EXPECT_THAT(refused("/meshes/2/pose", Json(), several()), HasSubstr("meshes[2]: pose: is missing"));
    EXPECT_THAT(refused("/meshes/2/pose/12", 1, several()), HasSubstr("meshes[2]: pose: "));
    EXPECT_THAT(refused("/meshes/0/shown", 1, several()), HasSubstr("meshes[0]: shown: "));
    EXPECT_THAT(refused("/chosen", 3, several()), HasSubstr("chosen: is not an index"));
    EXPECT_THAT(refused("/chosen", 0.5, several()), HasSubstr("chosen: is not an index"));
}

TEST(ViewSession, ComesBackFromAFile) {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("voxtact_session_" + std::to_string(getpid()) + ".json");
    ASSERT_TRUE(writeSession(path, document()).ok());
    const Result<Document> read = readSession(path);
    ASSERT_TRUE(read.ok()) << read.error().text;
    Document whole = document(); // the files of document() are in the current folder, not in the session's
    whole.sources.volume = (std::filesystem::current_path() / "head.nii.gz").string();
    whole.sources.meshes[0].path = (std::filesystem::current_path() / "tool.stl").string();
    whole.sources.labels = (std::filesystem::current_path() / "atlas.nii.gz").string();
    whole.sources.labelNames = (std::filesystem::current_path() / "atlas names.txt").string();
    EXPECT_EQ(sessionText(*read), sessionText(whole));
    ASSERT_TRUE(writeTransferFunction(path, document()).ok());
    const auto points = io::readTransferFunction(path);
    ASSERT_TRUE(points.ok()) << points.error().text;
    EXPECT_EQ(points->size(), 3U);
    EXPECT_EQ((*points)[1].value, 1.0 / 3);
    const auto colours = io::readColours(path);
    ASSERT_TRUE(colours.ok());
    EXPECT_EQ(colours->size(), 2U);
    std::filesystem::remove(path);
}

TEST(ViewSession, AFileThatIsNotThereIsNamed) {
    const Result<Document> read = readSession("/nowhere/s.json");
    ASSERT_FALSE(read.ok());
    EXPECT_THAT(read.error().text, HasSubstr("'/nowhere/s.json'"));
}

TEST(ViewSession, OtherFilesAreNoSessions) {
    for (const char* text : {"", "{", "[]", "3", "{}", "{\"voxtact_session\": \"1\"}", "{\"voxtact_session\": 2}"}) {
        const Result<Document> parsed = parseSession(text, "s.json");
        ASSERT_FALSE(parsed.ok()) << text;
        EXPECT_THAT(parsed.error().text, HasSubstr("'s.json'")) << text;
        EXPECT_EQ(parsed.error().code, ErrorCode::Format);
    }
}

TEST(ViewSession, WhatIsWrongIsNamed) {
    using Json = nlohmann::json;
    EXPECT_EQ(refused("/mesh_space", "lps"), "");
    const std::vector<std::tuple<const char*, Json, const char*>> cases{
        {"/volume", Json(), "volume: is missing"},
        {"/mesh", 3, "mesh: is not a text"},
        {"/mesh_space", "xyz", "mesh_space: is neither"},
        {"/labels", 3, "labels: is not a text"},
        {"/labels", Json(), "label_names: needs a label map"},
        {"/mesh_scale", -1, "mesh_scale: is not a positive number"},
        {"/transfer_function", 3, "transfer_function: is not an object"},
        {"/transfer_function/points", Json::array(), "transfer_function: "},
        {"/transfer_function/points/1", Json::array({-100, 0.5}), "transfer_function: "},
        {"/transfer_function/points/1", Json::array({5}), "transfer_function.points[1]: is not an array of 2 numbers"},
        {"/transfer_function/points/1/1", "x", "transfer_function.points[1][1]: is not a number"},
        {"/transfer_function/points/1/1", 1.5, "transfer_function: "},
        {"/transfer_function/colours/0/2", 7, "transfer_function.colours[0]: a colour's channel"},
        {"/transfer_function/colours/1/0", -7, "transfer_function.colours[1]: its value is below"},
        {"/transfer_function/domain", Json::array({5, 5}), "transfer_function: "},
        {"/transfer_function/size", 1, "transfer_function.size: "},
        {"/transfer_function/size", 1e9, "transfer_function.size: "},
        {"/transfer_function/threshold", 2, "transfer_function.threshold: "},
        {"/instrument/pose", Json::array({1, 2}), "instrument.pose: is not an array of 16 numbers"},
        {"/instrument/pose/12", 1, "instrument.pose: "},
        {"/instrument/poses/1/15", 0, "instrument.poses[1]: the last row"},
        {"/instrument/pose_number", 2, "instrument.pose_number: "},
        {"/method/count", "guess", "method.count: "},
        {"/method/projection", "guess", "method.projection: "},
        {"/camera/half_height", 0, "camera.half_height: "},
        {"/camera/azimuth", 1e308, "camera.azimuth: is not from -1e9 to 1e9 degrees"},
        {"/camera/elevation", -1e308, "camera.elevation: is not from -1e9 to 1e9 degrees"},
        {"/camera/target/1", -1e300, "camera.target: is beyond 1e12 mm"},
        {"/camera/target/2", 1e11, "camera.target: is beyond 1e8 times camera.half_height"},
        {"/camera/target", Json::array({1, 2}), "camera.target: "},
        {"/cursor", "here", "cursor: "},
    };
    for (const auto& [pointer, value, text] : cases) {
        const std::string error = refused(pointer, value);
        EXPECT_THAT(error, HasSubstr(std::string("cannot use the session 's.json': ") + text)) << pointer;
        EXPECT_EQ(error.find('\n'), std::string::npos);
    }
}

/// A session of one patient must not open another one's files because of where the program runs.
TEST(ViewSession, FilesAreFoundFromTheSessionOn) {
    namespace fs = std::filesystem;
    // Without links: the current folder has none.
    const fs::path folder = fs::canonical(testing::TempDir()) / ("voxtact_moved_" + std::to_string(getpid()));
    fs::create_directories(folder / "a" / "meshes");
    Document saved = document();
    saved.sources.volume = (folder / "a" / "head.nii.gz").string();
    saved.sources.meshes = {{(folder / "a" / "meshes" / "tool.stl").string()}};
    saved.sources.labels = (folder / "atlas.nii#2").string();
    saved.sources.labelNames.clear();
    ASSERT_TRUE(writeSession(folder / "a" / "s.json", saved).ok());
    EXPECT_EQ(sessionText(readSession(folder / "a" / "s.json").value()), sessionText(saved));
    fs::rename(folder / "a", folder / "b");
    const Sources moved = readSession(folder / "b" / "s.json").value().sources;
    EXPECT_EQ(moved.volume, (folder / "b" / "head.nii.gz").string());
    EXPECT_EQ(moved.meshes.at(0).path, (folder / "b" / "meshes" / "tool.stl").string());
    EXPECT_EQ(moved.labels, (folder / "atlas.nii#2").string());
    const fs::path before = fs::current_path();
    fs::current_path(folder / "b");
    EXPECT_EQ(readSession("s.json").value().sources.volume, "head.nii.gz");
    saved.sources.volume = "builtin:head:16";
    saved.sources.meshes[0].path = "meshes/tool.stl"; // from the current folder on
    ASSERT_TRUE(writeSession(folder / "s.json", saved).ok());
    fs::current_path(before);
    const Sources above = readSession(folder / "s.json").value().sources;
    EXPECT_EQ(above.volume, "builtin:head:16");
    EXPECT_EQ(above.meshes.at(0).path, (folder / "b" / "meshes" / "tool.stl").string());
    fs::remove_all(folder);
}

TEST(ViewSession, ACameraKeepsToWhatCanBeShown) {
    for (const auto& [given, taken] : {std::pair(1e300, kMostHalfHeight), std::pair(1e-300, kLeastHalfHeight)}) {
        Document far = document();
        far.camera->halfHeight = given;
        EXPECT_EQ(parseSession(sessionText(far), "s.json").value().camera->halfHeight, taken);
    }
}

/// What is behind ".." may be elsewhere than it looks: behind a link.
TEST(ViewSession, PathsThroughLinksStayAsTheyAre) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(testing::TempDir()) / ("voxtact_links_" + std::to_string(getpid()));
    fs::create_directories(folder / "far" / "inner");
    fs::create_directories(folder / "near");
    fs::create_directory_symlink(folder / "far" / "inner", folder / "near" / "link");
    Document saved = document();
    const std::string path = (folder / "near" / "link" / ".." / "head.nii").string(); // far/head.nii
    saved.sources.volume = path;
    ASSERT_TRUE(writeSession(folder / "near" / "s.json", saved).ok());
    EXPECT_EQ(readSession(folder / "near" / "s.json").value().sources.volume, path);
    fs::remove_all(folder);
}

TEST(ViewSession, AMemberThatIsThereTwiceIsRefused) {
    std::string text = sessionText(document());
    text.insert(text.rfind('}'), ", \"volume\": \"other.nii\"");
    const Result<Document> parsed = parseSession(text, "s.json");
    ASSERT_FALSE(parsed.ok());
    EXPECT_THAT(parsed.error().text, HasSubstr("'s.json': it has \"volume\" twice"));
}

TEST(ViewSession, PathsThatAreNoUtf8DoNoHarm) {
    Document odd = document();
    odd.sources.volume = "\xff\xfe";
    EXPECT_TRUE(parseSession(sessionText(odd), "s.json").ok());
}

} // namespace voxtact::test

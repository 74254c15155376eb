// SPDX-License-Identifier: MIT
// voxtact info: what it says of volumes and meshes whose content is known. No device is needed.
#include "cli/info/mesh_info.h"
#include "cli_fixture.h"
#include "voxtact/samples.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace voxtact::test {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class InfoTest : public CliTest {
  protected:
    static Json rows(const Arguments& more) {
        Arguments all{"info", "--format", "json"};
        all.insert(all.end(), more.begin(), more.end());
        return Json::parse(output(all)).at("rows");
    }
    /// Writes a transform (RAS) into a NIfTI header.
    static void place(std::string& text, const std::array<float, 12>& rows) {
        const std::int16_t code = 1;
        text.replace(254, 2, reinterpret_cast<const char*>(&code), 2);
        text.replace(280, sizeof rows, reinterpret_cast<const char*>(rows.data()), sizeof rows);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float spacing = std::hypot(rows[axis], rows[4 + axis], rows[8 + axis]);
            text.replace(80 + 4 * axis, sizeof spacing, reinterpret_cast<const char*>(&spacing), sizeof spacing);
        }
    }
    /// 4 x 2 x 1 voxels at a NIfTI transform (RAS), counted up from 0.
    [[nodiscard]] std::string counted(const std::array<float, 12>& rows) const {
        std::string file = path("counted.nii");
        writeNifti(file, {.sizes = {3, 4, 2, 2, 1, 1, 1, 1}, .bytes = 16});
        std::string text = readText(file);
        place(text, rows);
        for (std::size_t i = 0; i < 16; ++i) {
            text[352 + i] = static_cast<char>(i);
        }
        writeText(file, text);
        return file;
    }
};

TEST_F(InfoTest, OneOfSeveralImages) {
    const std::string file = path("several.nii");
    writeNifti(file, {.sizes = {4, 2, 2, 2, 3, 1, 1, 1}, .bytes = 24});
    std::string text = readText(file);
    place(text, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    for (std::size_t i = 0; i < 24; ++i) {
        text[352 + i] = static_cast<char>(i);
    }
    writeText(file, text);
    const Json row = rows({file + "#2"}).at(0);
    EXPECT_EQ(row.at("value_min"), 16);
    EXPECT_EQ(row.at("value_max"), 23);
    EXPECT_THAT(refused(1, {"info", file}), HasSubstr("(frame 0 to 2; to the program: PATH#0)"));
    EXPECT_THAT(refused(1, {"info", file + "#3"}), HasSubstr("it has no frame 3"));
    output({"make", "volume", "builtin:head:16", path("one.nrrd")});
    output({"make", "volume", "builtin:head:16", path("one.mha")});
    for (const char* name : {"one.nrrd", "one.mha"}) {
        EXPECT_EQ(rows({path(name) + "#0"}).size(), 1U);
        EXPECT_THAT(refused(1, {"info", path(name) + "#1"}), HasSubstr("it has no frame 1: it holds 1 image"));
    }
    EXPECT_THAT(refused(1, {"info", file + "#last"}), HasSubstr("is not the number of an image in"));
    EXPECT_THAT(refused(2, {"info", file + "#1", "--output", file}), HasSubstr("is not overwritten"));
    // Wherever a volume is named.
    const Arguments detect{"count", "--volume", file + "#2", "--mesh", "builtin:scalpel:300", "--method", "cpu"};
    EXPECT_EQ(linesOf(output(detect, {.note = "16 to 23, is opaque"})).size(), 2U);
    writeText(path("path.txt"), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 9 0 0 0 1\n");
    const Arguments motion{"motion",  "--volume",      file + "#2", "--mesh", "builtin:scalpel:300",
                           "--poses", path("path.txt")};
    EXPECT_EQ(linesOf(output(motion, {.note = "16 to 23, is opaque"})).size(), 2U);
    // A name that is there as it stands.
    std::filesystem::copy_file(counted({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}), path("a#1.nii"));
    EXPECT_EQ(rows({path("a#1.nii")}).at(0).at("value_max"), 15);
}

/// Of the values 0 to 15, by the control points themselves: no table rounds.
TEST_F(InfoTest, TheShareOfOpaqueVoxelsIsThatOfThePoints) {
    const std::string file = counted({1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30});
    const auto percent = [&](const Arguments& more) {
        Arguments all{file};
        all.insert(all.end(), more.begin(), more.end());
        return rows(all).at(0).at("opaque_percent").get<double>();
    };
    EXPECT_EQ(percent({"--opacity", "7:0,8:1", "--opacity-threshold", "1"}), 50) << "8 to 15";
    EXPECT_EQ(percent({"--opacity", "8:0,8:1", "--opacity-threshold", "1", "--tf-size", "2"}), 50);
    EXPECT_EQ(percent({"--iso", "8"}), 50);
    EXPECT_EQ(percent({"--iso", "4:7", "--opacity-threshold", "1"}), 25);
    EXPECT_EQ(percent({"--iso", "3:3"}), 6.25);
    EXPECT_EQ(percent({"--iso", "15.5"}), 0);
    for (const char* const wrong : {"", "a", "1:0", "1:2:3", ":5", "5:", "nan"}) {
        EXPECT_THAT(refused(2, {"info", file, "--iso", wrong}), HasSubstr("--iso")) << wrong;
    }
    EXPECT_THAT(refused(2, {"info", file, "--iso", "1", "--opacity", "0:0,1:1"}), HasSubstr("--opacity"));
}

TEST_F(InfoTest, AVolumeWhoseVoxelsAreKnown) {
    // x runs to the right at 1 mm, y to the front at 2 mm, z upwards at 3 mm.
    const std::string file = counted({1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30});
    const Json row = rows({file, "--opacity", "0:0,16:1", "--tf-domain", "0:16", "--opacity-threshold", "0.5"}).at(0);
    EXPECT_EQ(row.at("kind"), "volume");
    EXPECT_EQ(row.at("orientation"), "RAS");
    EXPECT_EQ(row.at("oblique_degrees"), 0);
    EXPECT_EQ(row.at("type"), "uint8");
    EXPECT_EQ(row.at("size_x").get<int>() * 100 + row.at("size_y").get<int>() * 10 + row.at("size_z").get<int>(), 422);
    EXPECT_EQ(row.at("spacing_y"), 2);
    EXPECT_EQ(row.at("value_min"), 0);
    EXPECT_EQ(row.at("value_max"), 15);
    EXPECT_EQ(row.at("value_mean"), 7.5);
    EXPECT_NEAR(row.at("opaque_percent").get<double>(), 50, 1e-9) << "8 to 15 of 16";
    // LPS: x and y negated; half a voxel beyond the centres.
    EXPECT_EQ(row.at("min_x"), -13.5);
    EXPECT_EQ(row.at("max_x"), -9.5);
    EXPECT_EQ(row.at("min_y"), -23);
    EXPECT_EQ(row.at("max_z"), 34.5);
    ASSERT_EQ(row.at("histogram").size(), 16U);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(row["histogram"][i].at("count"), 1);
        EXPECT_EQ(row["histogram"][i].at("name"), std::to_string(i));
    }
}

TEST_F(InfoTest, LettersSayWhereTheAxesRun) {
    // As nibabel's aff2axcodes: rows are world R, A, S, columns the index axes.
    EXPECT_EQ(rows({counted({-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})}).at(0).at("orientation"), "LAS");
    EXPECT_EQ(rows({counted({0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0})}).at(0).at("orientation"), "PIR");
    const float c = std::cos(0.3F);
    const float s = std::sin(0.3F);
    const Json oblique = rows({counted({c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0})}).at(0);
    EXPECT_EQ(oblique.at("orientation"), "RAS");
    EXPECT_NEAR(oblique.at("oblique_degrees").get<double>(), 0.3 * 180 / 3.14159265, 0.01);
}

TEST_F(InfoTest, HistogramsHoldEveryVoxel) {
    for (const char* name : {"builtin:head:16", "builtin:ct:16", "builtin:noise:16", "builtin:shells:16"}) {
        const Json row = rows({name}).at(0);
        std::uint64_t all = 0;
        for (const Json& bin : row.at("histogram")) {
            all += bin.at("count").get<std::uint64_t>();
        }
        EXPECT_EQ(all, row.at("size_x").get<std::uint64_t>() * row.at("size_y").get<std::uint64_t>() *
                           row.at("size_z").get<std::uint64_t>())
            << name;
        EXPECT_LE(row.at("histogram").size(), 16U);
    }
    writeNifti(path("alike.nii"), {.value = 7});
    const Json alike = rows({path("alike.nii")}).at(0);
    ASSERT_EQ(alike.at("histogram").size(), 1U);
    EXPECT_EQ(alike["histogram"][0].at("name"), "7");
}

TEST_F(InfoTest, MeshesAreClosedOrNot) {
    const std::string tetrahedron = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
    writeText(path("open.obj"), tetrahedron);
    writeText(path("closed.obj"), tetrahedron + "f 2 3 4\n");
    writeText(path("turned.obj"), tetrahedron + "f 2 4 3\n");
    writeText(path("many.obj"), tetrahedron + "f 2 3 4\nf 2 3 4\n");
    const Json all = rows({path("open.obj"), path("closed.obj"), path("turned.obj"), path("many.obj")});
    EXPECT_EQ(all.at(0).at("closed"), "no");
    EXPECT_EQ(all.at(0).at("open_edges"), 3);
    EXPECT_EQ(all.at(1).at("closed"), "yes");
    EXPECT_EQ(all.at(1).at("triangles"), 4);
    EXPECT_EQ(all.at(1).at("vertices"), 4);
    EXPECT_EQ(all.at(1).at("parts"), 1);
    EXPECT_EQ(all.at(1).at("max_z"), 10);
    EXPECT_EQ(all.at(1).at("turned_edges"), 0);
    EXPECT_EQ(all.at(2).at("closed"), "yes");
    EXPECT_EQ(all.at(2).at("turned_edges"), 3);
    EXPECT_EQ(all.at(3).at("closed"), "no");
    EXPECT_EQ(all.at(3).at("edges_of_many"), 3);
}

TEST_F(InfoTest, BuiltinsAreClosedAndInOnePart) {
    for (const char* name : {"scalpel:500", "ellipsoid:500"}) {
        const Result<MeshData> mesh = makeBuiltinMesh(name);
        ASSERT_TRUE(mesh.ok());
        const app::Closedness found = app::closednessOf(mesh->view());
        EXPECT_TRUE(found.closed());
        EXPECT_EQ(found.turned, 0U);
        EXPECT_EQ(found.parts, 1U);
    }
}

TEST_F(InfoTest, MetresAreSuspected) {
    output({"make", "mesh", "builtin:scalpel:500", path("tool.stl")});
    EXPECT_EQ(rows({path("tool.stl")}).at(0).at("hint"), "");
    EXPECT_THAT(rows({path("tool.stl"), "--mesh-scale", "0.001"}).at(0).at("hint").get<std::string>(),
                HasSubstr("if in metres, use --mesh-scale 1000"));
    const Ran micrometres = run({"info", path("tool.stl"), "--mesh-scale", "1000"});
    EXPECT_THAT(micrometres.out, HasSubstr("micrometres"));
    EXPECT_THAT(micrometres.err, HasSubstr("vertices rounded by up to 0.00"));
}

TEST_F(InfoTest, TextAndCsv) {
    const std::string text = output({"info", "builtin:head:16", "builtin:scalpel:500", "--format", "text"});
    EXPECT_THAT(text, AllOf(HasSubstr("16 x 16 x 16 voxels, uint8"), HasSubstr("orientation  LPS"),
                            HasSubstr("-100 -100 -100 to 100 100 100 mm"), HasSubstr("|####"),
                            HasSubstr("500 triangles"), HasSubstr("closed       yes")));
    const auto lines = linesOf(output({"info", "builtin:head:16", "builtin:scalpel:500"}));
    ASSERT_EQ(lines.size(), 4U) << "both, and how they lie to each other";
    EXPECT_TRUE(lines[0].starts_with("path,kind,min_x,"));
    EXPECT_EQ(std::count(lines[1].begin(), lines[1].end(), ','), std::count(lines[0].begin(), lines[0].end(), ','));
    EXPECT_EQ(std::count(lines[2].begin(), lines[2].end(), ','), std::count(lines[0].begin(), lines[0].end(), ','));
}

TEST_F(InfoTest, PathsByOptions) {
    EXPECT_EQ(rows({"--volume", "builtin:head:16", "--mesh", "builtin:scalpel:500"}),
              rows({"builtin:head:16", "builtin:scalpel:500"}));
    writeText(path("triangle"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(refused(2, {"info", "--mesh", path("triangle"), "--output", path("triangle")}),
                HasSubstr("that --mesh reads"));
}

TEST_F(InfoTest, WhatCannotBeSaid) {
    EXPECT_THAT(refused(2, {"info"}), HasSubstr("PATH: name a volume or mesh"));
    EXPECT_THAT(refused(1, {"info", path("no.nii")}), HasSubstr("no.nii"));
    EXPECT_THAT(refused(1, {"info", path("no.stl")}), HasSubstr("no.stl"));
    writeText(path("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(refused(2, {"info", path("m.obj"), "--output", path("m.obj")}), HasSubstr("not overwritten"));
}

} // namespace
} // namespace voxtact::test

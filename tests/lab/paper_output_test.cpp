// SPDX-License-Identifier: MIT
// What voxtact bench --paper says, of made-up measurements.
#include "bench/measure/numbers.h"
#include "bench/paper/paper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <numeric>
#include <sstream>

namespace voxtact::test {
namespace {

using lab::PaperColumns;
using lab::PaperResult;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

/// Seven rounds: 10 ms of rendering, the mesh 1 of them, 2 of detection, and in a frame `added` to `added` + 0.6.
PaperColumns columns(double added) {
    PaperColumns out;
    for (int round = 0; round < 7; ++round) {
        out.mesh.push_back(1);
        out.volume.push_back(9);
        out.collision.push_back(2);
        out.rendering.push_back(10);
        out.total.push_back(10 + added + 0.1 * round);
    }
    return out;
}

PaperColumns untold(PaperColumns columns) {
    columns.mesh.clear();
    columns.volume.clear();
    return columns;
}

PaperResult measured() {
    PaperResult result;
    result.width = 512;
    result.height = 256;
    result.scenes = {
        {.name = "v1s1", .volume = "builtin:head:256", .mesh = "builtin:scalpel", .voxels = {256, 256, 256}},
        {.name = "v1s2", .volume = "builtin:head:256", .mesh = "body.ply", .voxels = {256, 256, 256}}};
    result.rows = {
        {.scene = 0, .method = "query", .survivors = 812.5, .hits = 8, .gpu = columns(1), .wall = untold(columns(1))},
        {.scene = 0, .method = "atomic", .survivors = 812.5, .hits = 8, .gpu = columns(3), .wall = untold(columns(3))},
        {.scene = 1, .method = "cpu", .survivors = 900, .hits = 8, .gpu = {}, .wall = untold(columns(0))}};
    result.rows.back().gpu.rendering = {1};
    result.rows[1].gpu.collision.assign(7, 1.5);
    result.rows[1].wall.collision.assign(7, 0.5);
    result.rows[2].wall.collision.assign(7, 1);
    return result;
}

void addTheRest(PaperResult& result) {
    result.series = {
        {.sweep = lab::Sweep::Batch,
         .method = "atomic",
         .mode = lab::Mode::Pipelined,
         .batch = 1024,
         .fragments = std::nullopt,
         .wall = {512, 256, 300},
         .gpu = {}},
        {.sweep = lab::Sweep::Fragments, .method = "query", .fragments = std::nullopt, .wall = {0.001}, .gpu = {}}};
    result.polygons = {
        {.name = "polygon", .triangles = 70, .missed = 30, .wrong = 2, .queries = 24544, .wall = {40, 41, 45}},
        {.name = "leaf", .unchecked = "no queries"}};
    result.polygonTriangles = 3068;
    result.polygonPoses = 4;
    result.integration = {{.entries = 128, .gpu = {1}, .wall = {2}}, {.entries = 256, .gpu = {3}, .wall = {4, 5, 6}}};
}

std::string written(const PaperResult& result, io::Format format) {
    std::ostringstream out;
    lab::writePaper(out, format, result);
    return out.str();
}

TEST(PaperOutput, SaysWhatDetectionAdds) {
    EXPECT_THAT(
        lab::paperSummary(measured()),
        ElementsAre(
            "query and atomic count the same, on every pose of every scene; every timed frame gave these counts",
            "query and cpu differ by at most (half of cpu's count + 64 fragments), on every pose; not checked by an "
            "oracle",
            "detection adds to a frame 13.0 % (query in v1s1) to 33.0 % (atomic in v1s1), by GPU timestamps, medians; "
            "published: 4.3 to 15.9 %, on other hardware",
            "detection adds to a frame 3.00 % (cpu in v1s2) to 33.0 % (atomic in v1s1), by wall clock, medians; "
            "published: 4.3 to 15.9 %, on other hardware",
            "detection alone takes, of the time of rendering, 15.0 % (atomic in v1s1) to 20.0 % (query in v1s1), by "
            "GPU "
            "timestamps, medians",
            "detection alone takes, of the time of rendering, 5.00 % (atomic in v1s1) to 20.0 % (query in v1s1), by "
            "wall clock, medians",
            "in 2 of 2 rows the interval (of 95 % or more) of what detection adds leaves out 0, by GPU timestamps",
            "in 2 of 3 rows the interval (of 95 % or more) of what detection adds leaves out 0, by wall clock",
            "the fastest to count one pair, submitted and waited for alone, is atomic in v1s1: 0.500 ms, 2,000 pairs "
            "per "
            "second; published: 3,800 pairs per second, on other hardware"));
}

TEST(PaperOutput, SaysTheRestWhereItIsThere) {
    PaperResult result = measured();
    addTheRest(result);
    const auto summary = lab::paperSummary(result);
    EXPECT_THAT(
        std::vector(summary.begin() + 9, summary.end()),
        ElementsAre("the fastest in batches is atomic with 1,024 pairs per submission (pipelined): 3,413 pairs per "
                    "second; published: 3,800 pairs per second, on other hardware",
                    "which of 3,068 triangles touch on 4 poses, by the way polygon: 41.0 ms per pair by wall clock, "
                    "24,544 queries in all; 70 found in all, 30 of those that certainly touch are missed",
                    "the pre-integrated table of 256x256 entries is made in 3.00 ms by GPU timestamps, 5.00 ms "
                    "by wall clock; published: 40 ms, on other hardware"));
}

TEST(PaperOutput, ADisagreementComesFirst) {
    PaperResult result = measured();
    result.disagreement = "v1s1, pose 3: atomic in a frame counts 1, before it was 2";
    EXPECT_EQ(lab::paperSummary(result).front(), "DISAGREEMENT: " + result.disagreement);
    EXPECT_EQ(lab::paperJson(result)["agrees"], false);
}

TEST(PaperOutput, JsonHasEverything) {
    PaperResult result = measured();
    addTheRest(result);
    const Json json = lab::paperJson(result);
    const Json& overhead = json["tables"][0]["gpu"]["overhead_percent"];
    // Of seven samples from 10 to 16 %, all: 2/128.
    EXPECT_EQ(overhead["median"], 13.0);
    EXPECT_EQ(overhead["low"], 10.0);
    EXPECT_EQ(overhead["high"], 16.0);
    EXPECT_EQ(overhead["confidence"], 0.984375);
    EXPECT_EQ(json["tables"][0]["survivors"], 812.5);
    EXPECT_TRUE(json["tables"][0]["wall"]["mesh_ms"].is_null());
    EXPECT_TRUE(json["tables"][2]["gpu"]["overhead_percent"].is_null());
    EXPECT_EQ(json["series"].size(), 2U);
    EXPECT_EQ(json["polygons"]["triangles"], 3068);
    EXPECT_EQ(json["polygons"]["poses"], 4);
    EXPECT_EQ(json["polygons"]["ways"][0]["queries"], 24544);
    EXPECT_EQ(json["polygons"]["ways"][0]["found"], 70);
    EXPECT_TRUE(json["polygons"]["ways"][0]["gpu_ms"].is_null());
    EXPECT_EQ(json["polygons"]["ways"][1]["unchecked"], "no queries");
    for (const char* unknown : {"found", "missed", "wrong"}) {
        EXPECT_TRUE(json["polygons"]["ways"][1][unknown].is_null()) << unknown;
    }
    EXPECT_EQ(json["integration"][1]["wall_ms"]["median"], 5.0);
}

TEST(PaperOutput, WithoutTimestampsThereIsNoTableOfTheGpu) {
    PaperResult result = measured();
    for (lab::PaperRow& row : result.rows) {
        row.gpu = {};
    }
    EXPECT_THAT(written(result, io::Format::Text), AllOf(Not(HasSubstr("# By GPU")), HasSubstr("# By wall clock")));
    EXPECT_TRUE(lab::paperJson(result)["tables"][0]["gpu"].is_null());
}

TEST(PaperOutput, TextAndCsvHaveTheRestToo) {
    PaperResult result = measured();
    const std::string title = "Computing the pre-integrated table";
    EXPECT_THAT(written(result, io::Format::Text), Not(HasSubstr(title)));
    addTheRest(result);
    EXPECT_THAT(written(result, io::Format::Text),
                AllOf(HasSubstr("\n# " + title + "\nentries"),
                      HasSubstr("Which of 3068 triangles touch, in v1s1, on 4 poses together"),
                      HasSubstr("13.0 (10.0 to 16.0)"),
                      HasSubstr("# Sweeps in v1s1; of voxels in the builtin head\nsweep")));
    const std::string csv = written(result, io::Format::Csv);
    EXPECT_THAT(csv, AllOf(HasSubstr("\n# " + title + "\n# entries,"), HasSubstr("\n# 256,3,3,5,"),
                           HasSubstr("\n# polygon,24544,70,30,2,3,41,"), HasSubstr("\n# leaf,,,,,0,")));
    EXPECT_THAT(csv, HasSubstr("\nv1s1,query,gpu,512,256,0,0,812.5,8,7,1,9,2,2,2,10,10,10,"));
}

TEST(PaperOutput, ShortNumbers) {
    EXPECT_EQ(lab::shortNumber(0), "0");
    EXPECT_EQ(lab::shortNumber(0.012345), "0.0123");
    EXPECT_EQ(lab::shortNumber(-1.2345), "-1.23");
    EXPECT_EQ(lab::shortNumber(12345.6), "12346");
    EXPECT_EQ(lab::shortNumber(1e-30), "0");
}

} // namespace
} // namespace voxtact::test

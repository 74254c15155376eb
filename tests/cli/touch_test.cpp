// SPDX-License-Identifier: MIT
// voxtact touch, poses in RAS, and notes on meshes that do not fit.
#include "cli_fixture.h"

#include <fstream>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Arguments with(Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

using Rows = std::vector<std::map<std::string, std::string>>;

class TouchTest : public CliTest {
  protected:
    static Rows rowsFor(const Arguments& arguments, const RunOptions& options = {}) {
        return rowsOf(output(arguments, options));
    }
    [[nodiscard]] Arguments scene(const char* question) const {
        return {question, "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--poses", path("poses.txt")};
    }
    void makePoses(int count) const {
        output({"make", "poses", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--number",
                std::to_string(count), "--seed", "7", "--output", path("poses.txt")});
    }
    /// The verdicts are those of `voxtact count`, certified.
    void expectVerdictsOfCount(const Rows& touches) const {
        const Rows counted = rowsFor(scene("count"));
        ASSERT_EQ(counted.size(), touches.size());
        std::size_t yes = 0;
        for (std::size_t i = 0; i < counted.size(); ++i) {
            EXPECT_EQ(touches[i].at("touch"), counted[i].at("touch")) << "pose " << i;
            yes += counted[i].at("touch") == "1" ? 1 : 0;
        }
        EXPECT_GT(yes, counted.size() / 10);
        EXPECT_LT(yes, counted.size());
    }
};

class TouchDeviceTest : public TouchTest {
  protected:
    void SetUp() override {
        static const Ran devices = run({"devices", "--format", "csv"});
        if (devices.status != 0 && VOXTACT_REQUIRE_DEVICE != 0) {
            FAIL() << "this build requires a Vulkan device: " << devices.err;
        }
        if (devices.status != 0) {
            GTEST_SKIP() << devices.err;
        }
    }
};

TEST_F(TouchTest, HasAWitnessPoint) {
    makePoses(200);
    const std::string csv = output(scene("touch"));
    EXPECT_EQ(linesOf(csv).at(0), "pose,mesh,volume,touch,x,y,z,triangle,label");
    const Rows touches = rowsOf(csv);
    expectVerdictsOfCount(touches);
    for (const auto& row : touches) {
        EXPECT_EQ(row.at("x").empty(), row.at("touch") != "1");
        EXPECT_EQ(row.at("triangle").empty(), row.at("touch") != "1");
        if (row.at("touch") == "1") {
            EXPECT_LT(std::stoul(row.at("triangle")), 500U);
            // In the image, 200 mm a side.
            EXPECT_LE(std::abs(std::stod(row.at("x"))), 100.001);
        }
    }
    Arguments one = scene("touch");
    one.insert(one.end(), {"--threads", "1"});
    EXPECT_EQ(output(one), csv);
}

TEST_F(TouchTest, NamesTheLabelOfTheWitnessPoint) {
    makePoses(60);
    output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
    writeText(path("labels.txt"), "70 skull\n");
    const Rows touches = rowsFor(with(scene("touch"), {"--labels", path("labels.nii.gz")}));
    for (const auto& row : touches) {
        EXPECT_EQ(row.count("label"), row.at("touch") == "1" ? 1U : 0U);
        if (row.at("touch") == "1" && row.at("label") == "70") {
            EXPECT_EQ(row.at("label_name"), "skull");
        }
    }
    EXPECT_THAT(output(with(scene("touch"), {"--format", "json"})), HasSubstr("\"touch\":\"no\",\"x\":null"));
}

TEST_F(TouchDeviceTest, TheDeviceSaysTheSame) {
    makePoses(60);
    const Rows touches = rowsFor(with(scene("touch"), {"--on", "device"}));
    expectVerdictsOfCount(touches);
    EXPECT_EQ(touches[0].at("x"), "");
    EXPECT_THAT(refused(2, with(scene("touch"), {"--on", "device", "--margin", "1"})),
                HasSubstr("--margin needs the host engine"));
    EXPECT_THAT(refused(2, with(scene("touch"), {"--on", "host", "--device", "0"})), HasSubstr("--on host: --device"));
}

TEST_F(TouchTest, SummaryNamesHowManyTouch) {
    makePoses(50);
    const Ran ran = run(with(scene("touch"), {"--summary", "--progress", "never", "-q"}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err,
                testing::MatchesRegex("voxtact: summary: 50 pairs: [0-9]+ touch, [0-9]+ do not, 0 undecided\n"));
    const Ran far = run(with(scene("distance"), {"--summary", "--progress", "never"}));
    EXPECT_THAT(far.err, HasSubstr("; minimum distance 0 to 0 mm at pose "));
}

TEST_F(TouchTest, TakesOnlyItsOptions) {
    for (const char* option : {"--contacts", "--method", "--tolerance", "--projection", "--answer", "--jobs"}) {
        EXPECT_THAT(refused(2, with(scene("touch"), {option, "x"})), HasSubstr(option));
    }
    EXPECT_THAT(refused(2, with(scene("touch"), {"--margin", "1", "--uncertainty", "1,2"})), HasSubstr("--margin"));
    EXPECT_THAT(refused(2, with(scene("touch"), {"--margin", "-1"})), HasSubstr("--margin"));
    EXPECT_THAT(refused(2, with(scene("touch"), {"--label-names", "n.txt"})), HasSubstr("add --labels"));
}

TEST_F(TouchTest, PosesInRas) {
    makePoses(20);
    // The same motions of RAS points: x and y of both sides are turned round.
    std::string ras;
    for (const std::string& line : linesOf(readText(path("poses.txt")))) {
        std::istringstream numbers(line);
        double number = 0;
        for (int i = 0; numbers >> number; ++i) {
            ras += std::to_string((i / 4 < 2) != (i % 4 < 2) ? -number : number) + (i == 15 ? "\n" : " ");
        }
    }
    writeText(path("ras.txt"), ras);
    for (const char* question : {"touch", "count"}) {
        const Arguments pair{question, "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500"};
        const Rows expected = rowsFor(with(pair, {"--poses", path("poses.txt")}));
        const Rows found = rowsFor(with(pair, {"--poses", path("ras.txt"), "--poses-space", "RAS"}));
        for (std::size_t i = 0; i < expected.size(); ++i) { // witness points move by the digits of the file
            EXPECT_EQ(found.at(i).at("touch"), expected[i].at("touch"));
        }
    }
    const auto distances = [&](const Arguments& more) {
        return rowsFor(with({"distance", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500"}, more));
    };
    EXPECT_NE(distances({"--poses", path("ras.txt")}), distances({"--poses", path("poses.txt")}));
}

TEST_F(TouchTest, TextHasNoWholePaths) {
    writeText(path("m.obj"), "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n");
    const Arguments pair{"count", "--volume", "builtin:head:30", "--mesh", path("m.obj")};
    EXPECT_THAT(output(with(pair, {"--format", "text"})),
                AllOf(HasSubstr(" m.obj "), HasSubstr(" builtin:head:30 "), Not(HasSubstr(path("m.obj")))));
    for (const char* format : {"csv", "json"}) {
        EXPECT_THAT(output(with(pair, {"--format", format})), HasSubstr(path("m.obj")));
    }
}

/// The head is a ball of some 80 mm.
TEST_F(TouchTest, WhatIsEnclosedIsNoted) {
    writeText(path("around.obj"),
              "v -150 -150 -150\nv 150 -150 -150\nv 150 150 -150\nv -150 150 -150\nv -150 -150 150\n"
              "v 150 -150 150\nv 150 150 150\nv -150 150 150\nf 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\n"
              "f 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
    const Arguments pair{"count", "--volume", "builtin:head:30", "--mesh", path("around.obj"), "--format", "csv"};
    const std::string note = "around.obj encloses but does not touch an opaque region of builtin:head:30";
    const auto found = rowsOf(output(pair, {.note = note}));
    EXPECT_EQ(found.at(0).at("touch"), "0");
    EXPECT_EQ(found.at(0).at("count_exact"), "1");
    Arguments touch = pair;
    touch[0] = "touch";
    EXPECT_EQ(rowsOf(output(touch, {.note = note})).at(0).at("touch"), "0");
    // Nothing is said where it touches at a pose, or of a mesh that is open.
    writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n1 0 0 150  0 1 0 0  0 0 1 0  0 0 0 1\n");
    EXPECT_EQ(rowsOf(output(with(pair, {"--poses", path("poses.txt")}))).at(1).at("touch"), "1");
    const std::string text = readText(path("around.obj"));
    writeText(path("around.obj"), text.substr(0, text.size() - 8));
    output(pair);
}

TEST_F(TouchTest, ThreadsAreNamed) {
    EXPECT_THAT(output({"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--method", "cpu",
                        "--threads", "1", "--format", "json"}),
                HasSubstr("\"cpu, 1 thread\""));
}

TEST_F(TouchTest, MeshesThatDoNotFitAreNamed) {
    output({"make", "mesh", "builtin:scalpel:500", path("tool.stl")});
    const Arguments plain{"count", "--volume", "builtin:head:18", "--mesh", path("tool.stl"), "--method", "cpu"};
    EXPECT_EQ(run(plain).err, "");
    const Ran metres = run(with(plain, {"--mesh-scale", "0.001"}));
    EXPECT_EQ(metres.status, 0);
    EXPECT_THAT(metres.err, AllOf(HasSubstr("note: "), HasSubstr("--mesh-scale 1000")));
    const Ran microns = run(with(plain, {"--mesh-scale", "1000"}));
    EXPECT_EQ(microns.status, 0);
    EXPECT_THAT(microns.err, AllOf(HasSubstr("note: "), HasSubstr("--mesh-scale 0.001")));
    const Arguments builtin{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--method", "cpu"};
    EXPECT_EQ(run(builtin).err, "");
    EXPECT_THAT(run(with(builtin, {"--mesh-scale", "0.5"})).err, HasSubstr("--mesh-scale has no effect"));
    EXPECT_THAT(run(with(builtin, {"--mesh-space", "ras"})).err, HasSubstr("--mesh-space has no effect"));
    const std::string far = "1 0 0 900 0 1 0 0 0 0 1 0 0 0 0 1\n";
    writeText(path("far.txt"), far + far);
    const Ran away = run(with(plain, {"--poses", path("far.txt")}));
    EXPECT_EQ(away.status, 0);
    EXPECT_THAT(away.err,
                AllOf(HasSubstr("does not come near"), HasSubstr("any of 2 poses"), Not(HasSubstr("scale 1"))));
    writeText(path("far.txt"), far + "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_EQ(run(with(plain, {"--poses", path("far.txt")})).err, "");
}

} // namespace
} // namespace voxtact::test

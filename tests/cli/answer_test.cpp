// SPDX-License-Identifier: MIT
// voxtact detect --answer, --jobs, and what is said of meshes that do not fit.
#include "cli_fixture.h"

#include <fstream>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

enum Column : std::size_t { kPose, kMesh, kVolume, kHit, kCount, kExact, kMethod, kProjection, kJob };

Arguments with(Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

class AnswerTest : public CliTest {
  protected:
    static std::vector<std::vector<std::string>> rows(const Arguments& arguments) {
        std::vector<std::vector<std::string>> rows;
        for (const std::string& line : linesOf(output(arguments))) {
            rows.push_back(fieldsOf(line));
        }
        rows.erase(rows.begin());
        return rows;
    }
    /// yes-no says what count does, by these options.
    void expectSameVerdicts(const Arguments& how) const {
        const Arguments plain = with(
            {"detect", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--poses", path("poses.txt")},
            how);
        const auto counted = rows(plain);
        const auto answered = rows(with(plain, {"--answer", "yes-no"}));
        ASSERT_EQ(counted.size(), answered.size());
        std::size_t hits = 0;
        for (std::size_t i = 0; i < counted.size(); ++i) {
            EXPECT_EQ(answered[i].at(kHit), counted[i].at(kHit)) << "pose " << i;
            EXPECT_EQ(answered[i].at(kCount), counted[i].at(kHit) == "1" ? "1" : "0") << "pose " << i;
            EXPECT_EQ(answered[i].at(kExact), "0");
            EXPECT_EQ(answered[i].at(kMethod), counted[i].at(kMethod));
            EXPECT_EQ(answered[i].at(kProjection), counted[i].at(kProjection));
            hits += counted[i].at(kHit) == "1" ? 1 : 0;
        }
        EXPECT_GT(hits, counted.size() / 10);
        EXPECT_LT(hits, counted.size());
    }
    void makePoses(int count) const {
        output({"make", "poses", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--number",
                std::to_string(count), "--seed", "7", "--output", path("poses.txt")});
    }
};

class AnswerDeviceTest : public AnswerTest {
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

TEST_F(AnswerTest, YesNoOnTheHost) {
    makePoses(200);
    for (const char* projection : {"conservative", "view", "two-view", "dominant-axis"}) {
        expectSameVerdicts({"--count", "cpu", "--projection", projection});
    }
    expectSameVerdicts({"--count", "cpu", "--threads", "1"});
}

TEST_F(AnswerDeviceTest, YesNoOnTheDevice) {
    makePoses(40);
    expectSameVerdicts({"--count", "compute"});
    for (const char* method : {"query", "query-any", "atomic"}) {
        expectSameVerdicts({"--count", method});
    }
}

TEST_F(AnswerTest, YesNoIsAboutOneContact) {
    const Arguments plain{"detect",  "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500",
                          "--count", "cpu",      "--answer",        "yes-no"};
    for (const Arguments& more : {Arguments{"--contacts", path("c.csv")}, Arguments{"--triangles", path("t.csv")},
                                  Arguments{"--bounds"}, Arguments{"--labels", path("l.nii")}}) {
        EXPECT_THAT(refused(2, with(plain, more)), AllOf(HasSubstr("--answer yes-no"), HasSubstr(more.front())));
    }
    EXPECT_THAT(refused(2, with({"detect", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500"},
                                {"--answer", "maybe"})),
                HasSubstr("count, yes-no"));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(AnswerTest, ThreadsAreNamed) {
    EXPECT_THAT(output({"detect", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--count", "cpu",
                        "--threads", "1", "--format", "json"}),
                HasSubstr("\"cpu, 1 thread\""));
}

TEST_F(AnswerTest, JobsSayWhatIsPutToWhat) {
    makePoses(3);
    output({"make", "mesh", "builtin:ellipsoid:500", path("a, \"b\".stl")});
    writeText(path("jobs.csv"), "mesh,volume,poses\r\n# a comment\n\n"
                                "builtin:scalpel:500,builtin:head:30," +
                                    path("poses.txt") + "\n\"" + path("a, \"\"b\"\".stl") + "\",builtin:ct:32,\n" +
                                    "builtin:scalpel:500,builtin:head:30\n");
    const std::string csv =
        output({"detect", "--jobs", path("jobs.csv"), "--count", "cpu", "--triangles", path("triangles.csv")});
    const auto lines = linesOf(csv);
    ASSERT_EQ(lines.size(), 6U);
    EXPECT_EQ(lines[0], "pose,mesh,volume,hit,count,exact,method,projection,triangles,job");
    EXPECT_TRUE(lines[1].ends_with(",0"));
    EXPECT_TRUE(lines[4].ends_with(",1"));
    EXPECT_TRUE(lines[5].ends_with(",2"));
    EXPECT_THAT(lines[4], HasSubstr("a, \"\"b\"\".stl\",builtin:ct:32,"));
    EXPECT_THAT(readText(path("triangles.csv")), HasSubstr("pose,triangle,count,mesh,volume,job\n"));
    // As each alone.
    const auto alone =
        linesOf(output({"detect", "--mesh", "builtin:scalpel:500", "--volume", "builtin:head:30", "--poses",
                        path("poses.txt"), "--count", "cpu", "--triangles", path("triangles.csv")}));
    for (std::size_t i = 1; i <= 3; ++i) {
        EXPECT_EQ(lines[i], alone.at(i) + ",0");
    }
}

TEST_F(AnswerTest, VolumesOfJobsComeBack) {
    // Each volume in turn: the rows are those of the order of the file.
    std::string text;
    for (int i = 0; i < 4; ++i) {
        text += "builtin:scalpel:500,builtin:head:30,\nbuiltin:ellipsoid:500,builtin:sphere:16,\n";
    }
    writeText(path("jobs.csv"), text);
    const auto found = rows({"detect", "--jobs", path("jobs.csv"), "--count", "cpu"});
    ASSERT_EQ(found.size(), 8U);
    for (std::size_t i = 2; i < 8; ++i) {
        EXPECT_EQ(found[i].at(kCount), found[i % 2].at(kCount));
        EXPECT_EQ(found[i].at(kVolume), found[i % 2].at(kVolume));
        EXPECT_EQ(found[i].at(kJob), std::to_string(i));
    }
}

TEST_F(AnswerTest, JobsThatAreNone) {
    const auto bad = [&](const std::string& text) {
        writeText(path("jobs.csv"), text);
        return refused(1, {"detect", "--jobs", path("jobs.csv"), "--count", "cpu"});
    };
    EXPECT_THAT(bad(""), HasSubstr("holds no job"));
    EXPECT_THAT(bad("mesh,volume,poses\n"), HasSubstr("holds no job"));
    EXPECT_THAT(bad("mesh,poses,volume\n"), HasSubstr("the columns are mesh,volume,poses"));
    EXPECT_THAT(bad("builtin:scalpel\n"), AllOf(HasSubstr("line 1"), HasSubstr("mesh,volume,poses")));
    EXPECT_THAT(bad("a,b,c,d\n"), HasSubstr("line 1"));
    EXPECT_THAT(bad("\na,\"b,c\n"), AllOf(HasSubstr("line 2"), HasSubstr("quotes")));
    EXPECT_THAT(bad("builtin:scalpel,builtin:head,-\n"), HasSubstr("standard input"));
    EXPECT_THAT(bad("builtin:scalpel,builtin:head:18," + path("no.txt") + "\n"), HasSubstr("no.txt"));
    if (const char* const unreadable = "/proc/self/mem"; std::ifstream(unreadable).is_open()) {
        EXPECT_THAT(refused(1, {"detect", "--jobs", unreadable}), HasSubstr("Input/output error"));
    }
    EXPECT_THAT(refused(1, {"detect", "--jobs", path("none.csv")}), HasSubstr("none.csv"));
    for (const char* option : {"--mesh", "--volume", "--poses"}) {
        EXPECT_THAT(refused(2, {"detect", "--jobs", path("jobs.csv"), option, "x"}),
                    AllOf(HasSubstr(option), HasSubstr("--jobs names")));
    }
    writeText(path("jobs.csv"), "builtin:scalpel:500,builtin:head:18," + path("poses.txt") + "\n");
    writeText(path("poses.txt"), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    for (const char* output : {"jobs.csv", "poses.txt"}) {
        EXPECT_THAT(refused(2, {"detect", "--jobs", path("jobs.csv"), "--output", path(output)}),
                    HasSubstr("that --jobs reads"));
    }
}

TEST_F(AnswerTest, MeshesThatDoNotFitAreNamed) {
    output({"make", "mesh", "builtin:scalpel:500", path("tool.stl")});
    const Arguments plain{"detect", "--volume", "builtin:head:18", "--mesh", path("tool.stl"), "--count", "cpu"};
    EXPECT_EQ(run(plain).err, "");
    const Ran metres = run(with(plain, {"--mesh-scale", "0.001"}));
    EXPECT_EQ(metres.status, 0);
    EXPECT_THAT(metres.err, AllOf(HasSubstr("note: "), HasSubstr("--mesh-scale 1000")));
    const Ran microns = run(with(plain, {"--mesh-scale", "1000"}));
    EXPECT_EQ(microns.status, 0);
    EXPECT_THAT(microns.err, AllOf(HasSubstr("note: "), HasSubstr("--mesh-scale 0.001")));
    const Arguments builtin{"detect", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--count", "cpu"};
    EXPECT_EQ(run(builtin).err, "");
    EXPECT_THAT(run(with(builtin, {"--mesh-scale", "0.5"})).err, HasSubstr("--mesh-scale is about mesh files"));
    EXPECT_THAT(run(with(builtin, {"--mesh-space", "ras"})).err, HasSubstr("--mesh-space is about mesh files"));
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

// SPDX-License-Identifier: MIT
// Rows come as they are known, and what is interrupted is whole. No device is needed.
#include "child.h"

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class StreamTest : public CliTest {
  protected:
    static Arguments detect(const Arguments& more = {}) {
        Arguments all{"count", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--method", "cpu"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// `count` lines of poses.
    static std::string poses(int count) {
        std::string text;
        for (const std::string& line :
             linesOf(output({"make", "poses", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500",
                             "--number", std::to_string(count), "--seed", "7"}))) {
            text += line.starts_with("#") ? "" : line + "\n";
        }
        return text;
    }
};

TEST_F(StreamTest, RowsComeBeforeThePosesEnd) {
    const std::string first = poses(16);
    Child child(detect({"--poses", "-"}));
    child.write(first);
    // Standard input is still open: the program cannot know what else there is.
    EXPECT_EQ(child.lines(17).size(), 17U);
    child.write(first);
    child.closeInput();
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 0) << ran.err;
    writeText(path("poses.txt"), first + first);
    EXPECT_EQ(ran.out, output(detect({"--poses", path("poses.txt")})));
}

TEST_F(StreamTest, InterruptedRowsAreWhole) {
    const std::string first = poses(16);
    writeText(path("poses.txt"), first);
    const auto whole = linesOf(output(detect({"--poses", path("poses.txt")})));
    for (const int signal : {SIGINT, SIGTERM}) {
        Child child(detect({"--poses", "-"}));
        child.write(first);
        child.lines(17);
        child.signal(signal);
        child.closeInput();
        const Ran ran = child.end();
        EXPECT_EQ(ran.status, 128 + signal) << ran.err;
        EXPECT_EQ(linesOf(ran.out), whole);
        EXPECT_TRUE(ran.out.ends_with("\n"));
        EXPECT_EQ(linesOf(ran.err).size(), 1U);
        EXPECT_THAT(ran.err, AllOf(StartsWith("voxtact count: interrupted by SIG"), HasSubstr("16 pairs are written")));
    }
}

TEST_F(StreamTest, InterruptedJsonSaysSo) {
    Child child(detect({"--poses", "-", "--format", "json"}));
    child.write(poses(16));
    child.lines(17);
    child.signal(SIGINT);
    child.closeInput();
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 128 + SIGINT);
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json.at("rows").size(), 16U);
    EXPECT_EQ(json.at("interrupted"), true);
    EXPECT_EQ(json.at("rows").at(15).at("pose"), 15);
}

TEST_F(StreamTest, InterruptedFilesAreNotThere) {
    writeText(path("rows.csv"), "as it was");
    Child child(detect({"--poses", "-", "--output", path("rows.csv"), "--contacts", path("contacts.csv")}));
    child.write(poses(16));
    // The temporary files are there once it has begun.
    for (int i = 0; i < 1200 && filesInFolder() < 3; ++i) {
        ::usleep(100000);
    }
    EXPECT_EQ(filesInFolder(), 3U);
    child.signal(SIGINT);
    child.closeInput();
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 128 + SIGINT);
    EXPECT_THAT(ran.err, HasSubstr("is not written"));
    EXPECT_EQ(readText(path("rows.csv")), "as it was");
    EXPECT_EQ(filesInFolder(), 1U);
}

/// In and out of the head, so often that it takes a while.
TEST_F(StreamTest, MotionsComeAsTheyAreKnown) {
    std::string text;
    for (int i = 0; i < 20000; ++i) {
        text += "1 0 0 0  0 1 0 0  0 0 1 " + std::to_string(i % 2 == 0 ? 160 : 80) + "  0 0 0 1\n";
    }
    writeText(path("path.txt"), text);
    const Arguments motion{"motion",  "--volume",       "builtin:head:30", "--mesh", "builtin:scalpel:500",
                           "--poses", path("path.txt"), "--format",        "csv"};
    Child child(motion);
    const std::vector<std::string> first = child.lines(200);
    child.signal(SIGINT);
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 128 + SIGINT) << ran.err;
    EXPECT_TRUE(ran.out.ends_with("\n"));
    const std::vector<std::string> rows = linesOf(ran.out);
    EXPECT_GE(rows.size(), 200U);
    EXPECT_LT(rows.size(), 20000U);
    for (std::size_t i = 1; i < rows.size(); ++i) {
        EXPECT_TRUE(rows[i].starts_with(std::to_string(i - 1) + ",")) << rows[i];
        EXPECT_EQ(std::count(rows[i].begin(), rows[i].end(), ','), 10) << rows[i];
    }
    EXPECT_THAT(ran.err, AllOf(StartsWith("voxtact motion: interrupted by SIGINT"),
                               HasSubstr(std::to_string(rows.size() - 1) + " segments are written")));
}

/// Segments that take their time, near the head and never in it: a few at a time, and an interrupt ends those, too.
TEST_F(StreamTest, SlowMotionsEndSoonAfterAnInterrupt) {
    std::string text;
    for (int i = 0; i < 256; ++i) {
        text += "1 0 0 " + std::to_string(i % 2 == 0 ? 130 : -130) + "  0 1 0 0  0 0 1 0  0 0 0 1\n";
    }
    writeText(path("path.txt"), text);
    Child child({"motion", "--volume", "builtin:head:64", "--mesh", "builtin:ellipsoid:20000", "--poses",
                 path("path.txt"), "--threads", "1", "--format", "csv"});
    child.lines(2);
    child.signal(SIGINT);
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 128 + SIGINT) << ran.err;
    EXPECT_LT(linesOf(ran.out).size(), 200U) << "all at once";
}

TEST_F(StreamTest, WhatIsWrongInTheMiddleLeavesADocument) {
    Child child(detect({"--poses", "-", "--format", "json"}));
    child.write(poses(40) + "1 2 3\n");
    child.closeInput();
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 1);
    const auto json = nlohmann::json::parse(ran.out, nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << ran.out;
    EXPECT_EQ(json.at("rows").size(), 40U);
    EXPECT_EQ(json.at("interrupted"), true);
}

TEST_F(StreamTest, WhatIsWrongInTheMiddle) {
    const std::string good = poses(40);
    Child child(detect({"--poses", "-"}));
    child.write(good + "1 2 3\n");
    child.closeInput();
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 1);
    EXPECT_THAT(ran.err, AllOf(HasSubstr("standard input line 41"), HasSubstr("3 numbers")));
    EXPECT_EQ(linesOf(ran.out).size(), 41U) << "the poses before it are answered";
    // A file is examined first.
    writeText(path("poses.txt"), good + "1 2 3\n");
    EXPECT_THAT(refused(1, detect({"--poses", path("poses.txt")})), HasSubstr("line 41"));
}

TEST_F(StreamTest, StandardInputForSeveralMeshes) {
    const std::string text = poses(30);
    writeText(path("poses.txt"), text);
    const Arguments several = detect({"--mesh", "builtin:ellipsoid:500", "--poses"});
    Arguments file = several;
    file.push_back(path("poses.txt"));
    Arguments input = several;
    input.push_back("-");
    Child child(input);
    child.write(text);
    child.closeInput();
    EXPECT_EQ(child.end().out, output(file));
}

TEST_F(StreamTest, ADashIsStandardOutput) {
    EXPECT_EQ(output(detect({"--output", "-"})), output(detect()));
    writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n1 0 0 9  0 1 0 0  0 0 1 0  0 0 0 1\n");
    const Arguments motion{"motion",  "--volume",       "builtin:head:30", "--mesh", "builtin:scalpel:500",
                           "--poses", path("poses.txt")};
    Arguments dashed = motion;
    dashed.insert(dashed.end(), {"--output", "-"});
    EXPECT_EQ(output(dashed), output(motion));
    // Also for what is in addition to the rows, where these have a file.
    const std::string rows = output(detect({"--triangles", path("t.csv")}));
    EXPECT_EQ(output(detect({"--triangles", "-", "--output", path("rows.csv")})), readText(path("t.csv")));
    EXPECT_EQ(readText(path("rows.csv")), rows);
    EXPECT_THAT(refused(2, detect({"--triangles", "-"})), HasSubstr("--triangles: - is standard output"));
    EXPECT_FALSE(std::filesystem::exists("-"));
}

/// More rows than a window has, from one file that is read twice; in memory that does not grow.
TEST_F(StreamTest, MemoryDoesNotGrowWithThePoses) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer keeps what was freed";
#endif
    const std::string far = "1 0 0 900 0 1 0 0 0 0 1 0 0 0 0 1\n";
    std::string text;
    for (int i = 0; i < 100000; ++i) {
        text += far;
    }
    writeText(path("some.txt"), text);
    writeText(path("more.txt"), text + text + text + text);
    const auto memory = [&](const char* name, std::size_t rows) {
        Child child(detect({"--mesh", "builtin:ellipsoid:500", "--poses", path(name)}));
        child.closeInput();
        const Ran ran = child.end();
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(static_cast<std::size_t>(std::count(ran.out.begin(), ran.out.end(), '\n')), rows + 1);
        return child.mostMemory();
    };
    const long some = memory("some.txt", 200000);
    const long more = memory("more.txt", 800000);
    EXPECT_LT(more, some + 20000) << "KiB; the rows alone would take 100,000 more";
}

} // namespace
} // namespace voxtact::test

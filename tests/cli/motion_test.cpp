// SPDX-License-Identifier: MIT
// voxtact motion, and detect --uncertainty.
#include "cli_fixture.h"

#include <cmath>
#include <iomanip>
#include <regex>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// A scalpel whose tip goes along z, 20 mm or so above the head, into it, and back out on another way.
class MotionTest : public CliTest {
  protected:
    void SetUp() override {
        writeText(path("path.txt"), "1 0 0 0  0 1 0 0  0 0 1 160  0 0 0 1\n"
                                    "1 0 0 0  0 1 0 0  0 0 1 120  0 0 0 1\n"
                                    "1 0 0 0  0 1 0 0  0 0 1 80   0 0 0 1\n"
                                    "0 -1 0 50  1 0 0 0  0 0 1 200  0 0 0 1\n");
    }
    [[nodiscard]] Arguments motion(const Arguments& more) const {
        Arguments all{"motion",  "--volume",       "builtin:head:30", "--mesh", "builtin:scalpel:300",
                      "--poses", path("path.txt"), "--format",        "csv"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] std::vector<std::vector<std::string>> rows(const Arguments& more) const {
        std::vector<std::vector<std::string>> found;
        for (const std::string& line : linesOf(output(motion(more)))) {
            found.push_back(fieldsOf(line));
        }
        return found;
    }
};

TEST_F(MotionTest, HasARowForEachSegment) {
    const auto found = rows({});
    ASSERT_EQ(found.size(), 4U);
    EXPECT_EQ(found[0], (std::vector<std::string>{"pose", "mesh", "volume", "touch", "toi_lower", "toi_upper", "x", "y",
                                                  "z", "triangle", "label"}));
    EXPECT_EQ(found[1],
              (std::vector<std::string>{"0", "builtin:scalpel:300", "builtin:head:30", "0", "1", "", "", "", "", ""}));
    EXPECT_EQ(found[2][3], "1");
    const double freeUntil = std::stod(found[2][4]);
    const double touchAt = std::stod(found[2][5]);
    EXPECT_GT(freeUntil, 0);
    EXPECT_LE(touchAt - freeUntil, 0.01 / 40 + 1e-12);
    // The tip goes straight down.
    EXPECT_NEAR(std::stod(found[2][8]), 120 - 40 * touchAt, 0.5);
    EXPECT_EQ(found[2].size(), 10U); // an empty label is no field to fieldsOf()
    EXPECT_EQ(found[3][3], "1");
    EXPECT_EQ(found[3][4], "0");
    EXPECT_EQ(found[3][5], "0");
    // A coarser question has a coarser answer, around the same place.
    const auto coarse = rows({"--resolution", "2", "--threads", "1"});
    EXPECT_LE(std::stod(coarse[2][4]), touchAt);
    EXPECT_GE(std::stod(coarse[2][5]), freeUntil);
    EXPECT_LE(std::stod(coarse[2][5]) - std::stod(coarse[2][4]), 2.0 / 40 + 1e-12);
}

/// The last digits decide which way round it goes.
TEST_F(MotionTest, HalfTurnsAreNoted) {
    const std::string start = "1 0 0 0  0 1 0 0  0 0 1 90  0 0 0 1\n";
    const auto turned = [](double degrees) {
        const double angle = degrees / 180 * 3.14159265358979323846;
        std::ostringstream text;
        text << std::setprecision(17) << std::cos(angle) << ' ' << -std::sin(angle) << " 0 0  " << std::sin(angle)
             << ' ' << std::cos(angle) << " 0 0  0 0 1 90  0 0 0 1\n";
        return text.str();
    };
    const auto notes = [&](const std::string& poses, const Arguments& more = {}) {
        writeText(path("turns.txt"), poses);
        Arguments all = motion(more);
        all[6] = path("turns.txt");
        const Ran ran = run(all);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return withoutProgress(ran.err);
    };
    EXPECT_EQ(notes(start + turned(179.999) + start), "");
    EXPECT_EQ(notes(start + start + turned(180.00005) + start),
              "voxtact: note: segments within 0.0001 degrees of half a turn: 2, first: 1; rounding "
              "decides the sense of rotation; add a pose in between\n");
    // Segments, however many meshes and volumes there are rows for.
    EXPECT_THAT(notes(start + turned(180), {"--mesh", "builtin:scalpel:500", "--volume", "builtin:sphere:16"}),
                HasSubstr("of half a turn: 1, first: 0;"));
}

TEST_F(MotionTest, TimesAreAsShortAsThoseOfDetect) {
    const std::string last = linesOf(output(motion({"--timing"}))).back();
    // A nanosecond, and a tenth.
    EXPECT_TRUE(std::regex_match(last, std::regex(R"(# segments=3 wall_ms=\d+(\.\d{1,6})? segments_per_s=\d+(\.\d)?)")))
        << last;
}

TEST_F(MotionTest, WhatIsMissingIsSaidBeforeTheFirstRow) {
    Ran ran = run(motion({"--volume", path("nowhere.nii")}));
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.out, "");
    EXPECT_THAT(ran.err, HasSubstr("nowhere.nii': there is no such file or folder"));
    ran = run(motion({"--output", path("rows.csv"), "--volume", path("path.txt")}));
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.out, "");
    EXPECT_FALSE(std::filesystem::exists(path("rows.csv")));
}

TEST_F(MotionTest, WritesWhatElseIsAskedFor) {
    output({"make", "volume", "builtin:head:18", path("labels.nii.gz")});
    const auto labelled = rows({"--labels", path("labels.nii.gz"), "--timing", "--interpolation", "slerp"});
    ASSERT_EQ(labelled.size(), 5U);
    EXPECT_NE(labelled[2][10], "");
    EXPECT_THAT(labelled[4][0], HasSubstr("# segments=3 wall_ms="));
    Arguments json = motion({});
    json[8] = "json";
    EXPECT_THAT(output(json), HasSubstr(R"("touch":"no","toi_lower":1.0,"toi_upper":null)"));
    Arguments text = motion({"--output", path("out.txt")});
    text[8] = "text";
    output(text);
    EXPECT_THAT(readText(path("out.txt")), HasSubstr("yes"));
    EXPECT_EQ(rows({"--volume", "builtin:sphere:16", "--mesh", "builtin:ellipsoid:200"}).size(), 1U + 4 * 3);
}

TEST_F(MotionTest, RefusesWhatItCannotUse) {
    writeText(path("one.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n");
    writeText(path("scaled.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1\n");
    const auto refusedPoses = [&](int status, const std::string& poses) {
        Arguments all = motion({});
        all[6] = poses;
        return refused(status, all);
    };
    EXPECT_THAT(refusedPoses(2, path("one.txt")), HasSubstr("a motion needs at least two"));
    EXPECT_THAT(refusedPoses(2, path("scaled.txt")), HasSubstr("poses 0 and 1: the motion from one to the other is not "
                                                               "rigid"));
    EXPECT_THAT(refusedPoses(1, path("none.txt")), HasSubstr("none.txt"));
    EXPECT_THAT(refused(2, motion({"--interpolation", "linear"})), HasSubstr("screw, slerp"));
    EXPECT_THAT(refused(2, motion({"--resolution", "0"})), HasSubstr("--resolution"));
    EXPECT_THAT(refused(2, motion({"--label-names", "n.txt"})),
                HasSubstr("--label-names: it needs a label map; add --labels"));
    EXPECT_THAT(refused(2, motion({"--output", path("path.txt")})), HasSubstr("--output"));
    EXPECT_THAT(refused(2, {"motion", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel"}),
                HasSubstr("--poses is required"));
    EXPECT_EQ(filesInFolder(), 3U);
}

/// Far behind the first that are checked together; before any row.
TEST_F(MotionTest, RefusedPosesHaveTheirNumbers) {
    std::string text;
    for (int i = 0; i < 400; ++i) {
        text += i == 350 ? "2 0 0 0  0 2 0 0  0 0 2 900  0 0 0 1\n" : "1 0 0 0  0 1 0 0  0 0 1 900  0 0 0 1\n";
    }
    writeText(path("bad.txt"), text);
    for (const char* shard : {"1/1", "2/2"}) {
        const Arguments all{"motion",  "--volume",      "builtin:head:30", "--mesh", "builtin:scalpel:300",
                            "--poses", path("bad.txt"), "--shard",         shard};
        EXPECT_THAT(refused(2, all), HasSubstr("motion: --poses: poses 349 and 350: the motion"));
    }
}

TEST_F(MotionTest, APoseMayBeOff) {
    const auto hits = [&](const Arguments& more) {
        Arguments all{"touch",   "--volume",       "builtin:head:30", "--mesh", "builtin:scalpel:300",
                      "--poses", path("path.txt"), "--format",        "csv"};
        all.insert(all.end(), more.begin(), more.end());
        std::string found;
        const std::vector<std::string> lines = linesOf(output(all));
        for (std::size_t i = 1; i < lines.size(); ++i) {
            found += fieldsOf(lines[i]).at(3);
        }
        return found;
    };
    EXPECT_EQ(hits({"--uncertainty", "0,0"}), "0010");
    EXPECT_EQ(hits({"--uncertainty", "10,2"}), "0010");
    EXPECT_EQ(hits({"--uncertainty", "200,0"}), "1111");
    EXPECT_EQ(hits({"--uncertainty", "0,180"}), "1111"); // the handle is 150 mm long
    const auto line = [&](const Arguments& more) {
        Arguments all{"touch", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300"};
        all.insert(all.end(), more.begin(), more.end());
        return refused(2, all);
    };
    for (const char* wrong : {"1", "1,", ",1", "-1,0", "1,181", "1,2,3", "a,b"}) {
        EXPECT_THAT(line({"--uncertainty", wrong}), HasSubstr("is not MM,DEG")) << wrong;
    }
    EXPECT_THAT(line({"--uncertainty", "1,2", "--margin", "1"}), HasSubstr("--margin"));
    EXPECT_THAT(line({"--uncertainty", "1,2", "--on", "device"}), HasSubstr("--uncertainty needs the host engine"));
}

} // namespace
} // namespace voxtact::test

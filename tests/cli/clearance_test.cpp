// SPDX-License-Identifier: MIT
// voxtact detect --clearance and --margin.
#include "cli_fixture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// A scalpel whose tip goes along z: in the head, 20 mm or so above it, and far away.
class ClearanceTest : public CliTest {
  protected:
    void SetUp() override {
        writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0    0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 120  0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 500  0 0 0 1\n");
    }
    [[nodiscard]] Arguments detect(const Arguments& more) const {
        Arguments all{"detect",  "--volume",        "builtin:head:30", "--mesh", "builtin:scalpel:300",
                      "--poses", path("poses.txt"), "--format",        "csv"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] std::vector<std::map<std::string, std::string>> rows(const Arguments& more,
                                                                       const RunOptions& options = {}) const {
        return rowsOf(output(detect(more), options));
    }
    /// Its output. A number that no voxel has is measured to, with a note.
    static std::string expectMeasured(const Arguments& arguments) {
        const Ran ran = run(arguments);
        const bool nowhere = std::ranges::any_of(
            arguments, [](const std::string& argument) { return argument.find("999") != std::string::npos; });
        EXPECT_EQ(ran.status, 0);
        EXPECT_EQ(withoutProgress(ran.err), nowhere
                                                ? "voxtact: note: --to: no voxel of the label map has the label 999; "
                                                  "clearances to it are infinite\n"
                                                : "");
        return ran.out;
    }
};

TEST_F(ClearanceTest, AddsBoundsToEachRow) {
    const auto found = rows({"--clearance"});
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].at("hit"), "1");
    EXPECT_EQ(found[0].at("clearance_lo"), "0");
    EXPECT_EQ(found[0].at("clearance_hi"), "0");
    EXPECT_EQ(found[1].at("hit"), "0");
    const double lo = std::stod(found[1].at("clearance_lo"));
    const double hi = std::stod(found[1].at("clearance_hi"));
    EXPECT_GT(lo, 10);
    EXPECT_LT(hi, 40);
    EXPECT_LE(hi - lo, 0.010002);
    // 380 mm farther along the same line, nearly.
    EXPECT_NEAR(std::stod(found[2].at("clearance_lo")), lo + 380, 1);
    const auto fine = rows({"--clearance", "--tolerance", "0.0001", "--threads", "1"});
    const double fineLo = std::stod(fine[1].at("clearance_lo"));
    EXPECT_LE(std::stod(fine[1].at("clearance_hi")) - fineLo, 0.000102);
    EXPECT_GE(fineLo, lo);
}

TEST_F(ClearanceTest, GoesNoFartherThanItIsTold) {
    const auto found = rows({"--clearance", "--max-clearance", "100"});
    EXPECT_LT(std::stod(found[1].at("clearance_hi")), 40);
    EXPECT_EQ(found[2].at("clearance_lo"), "100");
    EXPECT_EQ(found[2].at("clearance_hi"), "inf");
}

TEST_F(ClearanceTest, OfNothingIsInfinite) {
    const Arguments how{"--clearance", "--opacity", "0:0"};
    const RunOptions transparent{.note = "nothing touches"};
    EXPECT_EQ(rows(how, transparent)[1].at("clearance_lo"), "inf");
    Arguments json = detect(how);
    json[8] = "json";
    EXPECT_THAT(output(json, transparent), HasSubstr(R"("clearance_lo":"inf","clearance_hi":"inf")"));
}

TEST_F(ClearanceTest, AMarginIsAnsweredLikeATouch) {
    const double clearance = std::stod(rows({"--clearance"})[1].at("clearance_hi"));
    for (const auto& [margin, hits] : {std::pair(0.0, "100"), std::pair(clearance - 1, "100"),
                                       std::pair(clearance + 0.001, "110"), std::pair(1000.0, "111")}) {
        const auto found = rows({"--margin", std::to_string(margin), "--answer", "yes-no"});
        ASSERT_EQ(found.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(found[i].at("hit"), std::string(1, hits[i])) << margin << ", pose " << i;
            EXPECT_EQ(found[i].at("count"), found[i].at("hit"));
            EXPECT_EQ(found[i].at("exact"), "0");
            EXPECT_EQ(found[i].at("method"), "cpu");
            EXPECT_EQ(found[i].at("projection"), "conservative");
        }
    }
}

TEST_F(ClearanceTest, WritesTheClosestPoints) {
    output({"make", "volume", "builtin:head:18", path("labels.nii.gz")});
    output(detect({"--clearance", "--closest", path("closest.csv"), "--labels", path("labels.nii.gz")}));
    const std::string text = readText(path("closest.csv"));
    EXPECT_EQ(linesOf(text).at(0), "pose,mesh,volume,triangle,mesh_x,mesh_y,mesh_z,volume_x,volume_y,volume_z,label,"
                                   "per_x,per_y,per_z,per_rx,per_ry,per_rz");
    const auto found = rowsOf(text);
    ASSERT_EQ(found.size(), 3U);
    const auto& apart = found[1];
    // The tip is at the object's origin: turning does not move it.
    EXPECT_NEAR(std::stod(apart.at("mesh_z")), 120, 1e-6);
    EXPECT_EQ(apart.at("per_rx"), "0");
    EXPECT_GT(std::stod(apart.at("per_z")), 0.99);
    const double away = std::hypot(std::stod(apart.at("mesh_x")) - std::stod(apart.at("volume_x")),
                                   std::stod(apart.at("mesh_y")) - std::stod(apart.at("volume_y")),
                                   std::stod(apart.at("mesh_z")) - std::stod(apart.at("volume_z")));
    EXPECT_NEAR(away, std::stod(rows({"--clearance"})[1].at("clearance_hi")), 1e-4);
    EXPECT_NE(found[0].at("label"), "0");

    output(detect({"--clearance", "--closest", path("closest.ply")}));
    const std::vector<std::string> ply = linesOf(readText(path("closest.ply")));
    EXPECT_THAT(ply, testing::Contains("element vertex 6"));
    EXPECT_THAT(ply, testing::Contains("element edge 3"));
    const auto end = static_cast<std::size_t>(std::find(ply.begin(), ply.end(), "end_header") - ply.begin());
    EXPECT_EQ(ply.size(), end + 1 + 6 + 3);
}

/// A name with a line break does not end a line of the header.
TEST_F(ClearanceTest, APlyFileHasEachNameInALine) {
    const std::string mesh = path("two\nelement lines.stl");
    output({"make", "mesh", "builtin:scalpel:300", mesh});
    output({"detect", "--volume", "builtin:head:30", "--mesh", mesh, "--poses", path("poses.txt"), "--clearance",
            "--closest", path("named.ply")});
    const std::vector<std::string> ply = linesOf(readText(path("named.ply")));
    EXPECT_EQ(std::ranges::count_if(ply, [](const std::string& line) { return line.starts_with("element"); }), 2);
    EXPECT_THAT(ply, testing::Contains(testing::EndsWith("two element lines.stl")));
}

TEST_F(ClearanceTest, WritesTheClearanceToLabels) {
    output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
    const std::string whole = rows({"--clearance"})[1].at("clearance_lo");
    const auto labelled = [&](const Arguments& more) {
        Arguments how{"--clearance", "--labels", path("labels.nii.gz"), "--label-clearance", path("labels.csv")};
        how.insert(how.end(), more.begin(), more.end());
        expectMeasured(detect(how));
        EXPECT_EQ(linesOf(readText(path("labels.csv"))).at(0), "pose,mesh,volume,label,name,clearance_lo,clearance_hi");
        return rowsOf(readText(path("labels.csv")));
    };
    // The voxels are the labels: whatever is opaque has one of them.
    double least = 1e9;
    for (const auto& row : labelled({})) {
        EXPECT_NE(row.at("label"), "0");
        if (row.at("pose") == "1") {
            least = std::min(least, std::stod(row.at("clearance_lo")));
        }
    }
    EXPECT_NEAR(least, std::stod(whole), 0.02);
    const auto two = labelled({"--to", "70,999"});
    EXPECT_EQ(labelled({"--to", "70,999,70"}), two);
    ASSERT_EQ(two.size(), 6U);
    EXPECT_EQ(two[2].at("label"), "70");
    EXPECT_GE(std::stod(two[2].at("clearance_lo")), least);
    EXPECT_EQ(two[3].at("label"), "999");
    EXPECT_EQ(two[3].at("clearance_lo"), "inf");
    EXPECT_EQ(two[3].at("clearance_hi"), "inf");

    // The air around the head is opaque only where it becomes skin, and goes out to the faces at 100 mm.
    EXPECT_GT(std::stod(labelled({"--to", "0"})[1].at("clearance_lo")), 30);
    EXPECT_NEAR(std::stod(labelled({"--to", "0", "--to-any-opacity"})[1].at("clearance_lo")), 20, 1e-3);
    EXPECT_EQ(labelled({"--to", "70", "--to-any-opacity"})[1], two[2]);
}

TEST_F(ClearanceTest, KnowsLabelsByName) {
    output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
    writeText(path("names.txt"), "70 skull\n90 brain\n120 brain\n999 nowhere\n");
    const auto measured = [&](const std::string& to) {
        return detect({"--clearance", "--labels", path("labels.nii.gz"), "--label-names", path("names.txt"),
                       "--label-clearance", path("labels.csv"), "--to", to});
    };
    const auto rowsFor = [&](const std::string& to) {
        output(measured(to));
        return rowsOf(readText(path("labels.csv")));
    };
    const auto byNumber = rowsFor("90,120,70");
    EXPECT_EQ(byNumber[0].at("name"), "brain");
    EXPECT_EQ(rowsFor("brain,skull"), byNumber);
    EXPECT_EQ(rowsFor("brain,70,90,skull"), byNumber);
    EXPECT_THAT(refused(2, measured("skul")),
                HasSubstr("--to: no voxel of the label map has the label 'skul', did you mean skull?"));
    EXPECT_THAT(refused(2, measured("nowhere")), HasSubstr("--to: no voxel of the label map has the label 'nowhere'"));
}

TEST_F(ClearanceTest, RefusesALabelMapOnAnotherGrid) {
    output({"make", "volume", "builtin:head:18", path("coarse.nii.gz")});
    EXPECT_THAT(
        refused(1, detect({"--clearance", "--labels", path("coarse.nii.gz"), "--label-clearance", path("other.csv")})),
        HasSubstr("--label-clearance: '" + path("coarse.nii.gz") +
                  "': the label map is not on the grid of the volume"));
}

TEST_F(ClearanceTest, RefusesWhatDoesNotGoTogether) {
    const auto line = [&](const Arguments& more) { return refused(2, detect(more)); };
    EXPECT_THAT(line({"--margin", "-1"}), HasSubstr("--margin"));
    EXPECT_THAT(line({"--tolerance", "0.1"}), HasSubstr("--tolerance: it is about clearances"));
    EXPECT_THAT(line({"--max-clearance", "5"}), HasSubstr("--max-clearance: it is about clearances"));
    EXPECT_THAT(line({"--closest", "c.csv"}), HasSubstr("--closest: it is about clearances"));
    EXPECT_THAT(line({"--clearance", "--label-clearance", "c.csv"}), HasSubstr("--labels is not given"));
    EXPECT_THAT(line({"--clearance", "--to", "1"}), HasSubstr("--to: it says which labels"));
    EXPECT_THAT(line({"--clearance", "--to-any-opacity"}), HasSubstr("--to-any-opacity: it says what"));
    EXPECT_THAT(line({"--clearance", "--closest", "c.vtk"}), HasSubstr(".csv or .ply"));
    EXPECT_THAT(line({"--clearance", "--tolerance", "0"}), HasSubstr("--tolerance"));
    EXPECT_THAT(line({"--clearance", "--max-clearance", "0"}), HasSubstr("--max-clearance"));
    EXPECT_THAT(line({"--clearance", "--count", "atomic"}), HasSubstr("leave out --count atomic"));
    EXPECT_THAT(line({"--margin", "1", "--projection", "view"}), HasSubstr("leave out --projection view"));
    EXPECT_THAT(line({"--margin", "1", "--count", "atomic"}), HasSubstr("or give --count cpu or compute"));
    EXPECT_THAT(line({"--margin", "1e7", "--count", "compute"}), HasSubstr("is not a number from 0 to 1000000"));
    EXPECT_THAT(line({"--margin", "1", "--clearance", "--count", "compute"}), HasSubstr("leave out --count compute"));
    EXPECT_THAT(line({"--pose-tolerance", "1,2", "--clearance", "--count", "compute"}),
                HasSubstr("leave out --count compute"));
    EXPECT_THAT(line({"--pose-tolerance", "1e7,2", "--count", "compute"}), HasSubstr("the most on a device"));
    EXPECT_THAT(line({"--margin", "1", "--stats"}), HasSubstr("--stats"));
    EXPECT_THAT(line({"--margin", "1", "--contacts", "c.csv"}), HasSubstr("--margin is answered by yes or no"));
    EXPECT_THAT(line({"--margin", "1", "--answer", "count"}), HasSubstr("--answer count asks for a count"));
    EXPECT_THAT(line({"--pose-tolerance", "1,2", "--answer", "count"}),
                HasSubstr("--pose-tolerance is answered by yes"));
    EXPECT_THAT(line({"--clearance", "--closest", path("poses.txt") + "/../poses.txt"}), HasSubstr("--closest"));
    EXPECT_EQ(filesInFolder(), 1U);
}

class ClearanceDeviceTest : public ClearanceTest {
  protected:
    void SetUp() override {
        static const Ran devices = run({"devices", "--format", "csv"});
        if (devices.status != 0 && VOXTACT_REQUIRE_DEVICE != 0) {
            FAIL() << "this build requires a Vulkan device: " << devices.err;
        }
        if (devices.status != 0) {
            GTEST_SKIP() << devices.err;
        }
        ClearanceTest::SetUp();
    }
};

/// A device says the same, but for the method's name.
TEST_F(ClearanceDeviceTest, AMarginIsTheDevicesToo) {
    for (const char* margin : {"0", "5"}) {
        auto onHost = rows({"--margin", margin});
        auto onDevice = rows({"--margin", margin, "--count", "compute"});
        ASSERT_EQ(onDevice.size(), 3U);
        for (std::size_t i = 0; i < onDevice.size(); ++i) {
            EXPECT_EQ(onDevice[i].at("method"), "compute");
            onDevice[i]["method"] = "cpu";
            EXPECT_EQ(onDevice[i], onHost[i]) << margin << ", pose " << i;
        }
    }
    EXPECT_THAT(output(detect({"--margin", "5", "--count", "compute", "--stats"})), HasSubstr("# clusters="));
}

TEST_F(ClearanceDeviceTest, APoseToleranceIsTheDevicesToo) {
    std::string hits;
    for (const char* tolerance : {"5,0", "2,10"}) {
        auto onHost = rows({"--pose-tolerance", tolerance});
        auto onDevice = rows({"--pose-tolerance", tolerance, "--count", "compute"});
        ASSERT_EQ(onDevice.size(), 3U);
        for (std::size_t i = 0; i < onDevice.size(); ++i) {
            EXPECT_EQ(onDevice[i].at("method"), "compute");
            onDevice[i]["method"] = "cpu";
            EXPECT_EQ(onDevice[i], onHost[i]) << tolerance << ", pose " << i;
            hits += onDevice[i].at("hit");
        }
    }
    EXPECT_THAT(hits, HasSubstr("0"));
    EXPECT_THAT(hits, HasSubstr("1"));
    EXPECT_THAT(output(detect({"--pose-tolerance", "2,10", "--count", "compute", "--stats"})),
                HasSubstr("# clusters="));
}

/// Its bounds are others, that overlap.
TEST_F(ClearanceDeviceTest, AClearanceIsTheDevicesToo) {
    // Voxels of 6 mm, and the last pose is 400 mm away: single precision tells no less apart.
    for (const Arguments& more :
         {Arguments{"--tolerance", "0.3"}, Arguments{"--tolerance", "0.2", "--answer", "yes-no"},
          Arguments{"--max-clearance", "100", "--tolerance", "0.02"}, Arguments{"--opacity", "0:0"}}) {
        Arguments asked{"--clearance"};
        asked.insert(asked.end(), more.begin(), more.end());
        const RunOptions noted{.note = more[0] == "--opacity" ? "nothing touches" : ""};
        auto onHost = rows(asked, noted);
        asked.insert(asked.end(), {"--count", "compute"});
        auto onDevice = rows(asked, noted);
        ASSERT_EQ(onDevice.size(), 3U);
        for (std::size_t i = 0; i < onDevice.size(); ++i) {
            SCOPED_TRACE(more[0] + " " + more[1] + ", pose " + std::to_string(i));
            EXPECT_EQ(onDevice[i].at("method"), "compute");
            onDevice[i]["method"] = "cpu";
            EXPECT_LE(std::stod(onDevice[i].at("clearance_lo")), std::stod(onHost[i].at("clearance_hi")));
            EXPECT_GE(std::stod(onDevice[i].at("clearance_hi")), std::stod(onHost[i].at("clearance_lo")));
            if (std::isfinite(std::stod(onDevice[i].at("clearance_hi")))) {
                EXPECT_LE(std::stod(onDevice[i].at("clearance_hi")) - std::stod(onDevice[i].at("clearance_lo")),
                          0.3001);
                onDevice[i]["clearance_lo"] = onHost[i].at("clearance_lo");
                onDevice[i]["clearance_hi"] = onHost[i].at("clearance_hi");
            }
            EXPECT_EQ(onDevice[i], onHost[i]);
        }
    }
    EXPECT_THAT(output(detect({"--clearance", "--max-clearance", "1", "--count", "compute", "--stats"})),
                HasSubstr("# clusters="));
    const auto line = [&](Arguments more) {
        more.insert(more.end(), {"--clearance", "--count", "compute"});
        return refused(2, detect(more));
    };
    EXPECT_THAT(line({"--triangles", "t.csv"}), HasSubstr("--triangles: with --clearance --count compute"));
}

/// The host's rows, with bounds that overlap.
TEST_F(ClearanceDeviceTest, TheClearanceToLabelsIsTheDevicesToo) {
    output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
    const auto labelled = [&](const Arguments& more) {
        Arguments asked{"--clearance",         "--tolerance",       "0.3",        "--labels",
                        path("labels.nii.gz"), "--label-clearance", path("l.csv")};
        asked.insert(asked.end(), more.begin(), more.end());
        // The map is what clearances are measured to, and nothing is counted by label.
        EXPECT_EQ(rowsOf(expectMeasured(detect(asked)))[0].count("labels"), more.back() == "compute" ? 0U : 1U);
        return rowsOf(readText(path("l.csv")));
    };
    std::size_t apart = 0;
    for (const Arguments& more : {Arguments{"--max-clearance", "5"}, Arguments{"--to", "70,999,0", "--to-any-opacity"},
                                  Arguments{"--to", "90,120", "--max-clearance", "30", "--batch", "1"}}) {
        const auto onHost = labelled(more);
        Arguments asked = more;
        asked.insert(asked.end(), {"--count", "compute"});
        auto onDevice = labelled(asked);
        ASSERT_EQ(onDevice.size(), onHost.size());
        for (std::size_t i = 0; i < onDevice.size(); ++i) {
            SCOPED_TRACE(more[0] + " " + more[1] + ", row " + std::to_string(i));
            const auto number = [i](const auto& rows, const char* name) { return std::stod(rows[i].at(name)); };
            EXPECT_LE(number(onDevice, "clearance_lo"), number(onHost, "clearance_hi"));
            EXPECT_GE(number(onDevice, "clearance_hi"), number(onHost, "clearance_lo"));
            if (std::isfinite(number(onDevice, "clearance_hi"))) {
                EXPECT_LE(number(onDevice, "clearance_hi") - number(onDevice, "clearance_lo"), 0.3001);
                apart += number(onDevice, "clearance_lo") > 0 ? 1 : 0;
            }
            EXPECT_EQ(std::isinf(number(onDevice, "clearance_lo")), std::isinf(number(onHost, "clearance_lo")));
            for (const char* bound : {"clearance_lo", "clearance_hi"}) {
                onDevice[i][bound] = onHost[i].at(bound);
            }
            EXPECT_EQ(onDevice[i], onHost[i]);
        }
    }
    EXPECT_GT(apart, 5U);
    EXPECT_EQ(rows({"--clearance", "--max-clearance", "5", "--labels", path("labels.nii.gz"), "--label-clearance",
                    path("l.csv"), "--answer", "yes-no"})[0]
                  .count("labels"),
              0U);
    output({"make", "volume", "builtin:head:18", path("coarse.nii.gz")});
    EXPECT_THAT(refused(1, detect({"--clearance", "--labels", path("coarse.nii.gz"), "--label-clearance",
                                   path("other.csv"), "--count", "compute"})),
                HasSubstr("--label-clearance: '" + path("coarse.nii.gz") + "': the label map is not on the grid"));
    EXPECT_FALSE(std::filesystem::exists(path("other.csv")));
}

/// The host's columns, and points that are as near.
TEST_F(ClearanceDeviceTest, TheClosestPointsAreTheDevicesToo) {
    const auto closest = [&](const Arguments& more) {
        Arguments asked{"--clearance", "--tolerance", "0.3", "--max-clearance", "100", "--closest", path("c.csv")};
        asked.insert(asked.end(), more.begin(), more.end());
        output(detect(asked));
        return readText(path("c.csv"));
    };
    const std::string host = closest({});
    const std::string device = closest({"--count", "compute"});
    EXPECT_EQ(linesOf(device).at(0), linesOf(host).at(0));
    const auto onHost = rowsOf(host);
    const auto onDevice = rowsOf(device);
    ASSERT_EQ(onDevice.size(), 2U); // the third pose is beyond the maximum
    ASSERT_EQ(onHost.size(), 2U);
    const auto number = [](const auto& row, const char* name) { return std::stod(row.at(name)); };
    const auto apart = [&](const auto& row) {
        return std::hypot(number(row, "mesh_x") - number(row, "volume_x"),
                          number(row, "mesh_y") - number(row, "volume_y"),
                          number(row, "mesh_z") - number(row, "volume_z"));
    };
    EXPECT_EQ(onDevice[0].at("pose"), "0");
    EXPECT_EQ(apart(onDevice[0]), 0);
    EXPECT_EQ(onDevice[0].at("per_z"), "0");
    EXPECT_EQ(onDevice[1].at("pose"), "1");
    EXPECT_EQ(onDevice[1].at("mesh"), onHost[1].at("mesh"));
    EXPECT_NEAR(apart(onDevice[1]), apart(onHost[1]), 0.61); // two tolerances
    EXPECT_NEAR(number(onDevice[1], "mesh_z"), 120, 0.3);
    EXPECT_GT(number(onDevice[1], "per_z"), 0.9);
    output(detect({"--clearance", "--tolerance", "0.3", "--max-clearance", "100", "--closest", path("c.ply"), "--count",
                   "compute"}));
    EXPECT_THAT(linesOf(readText(path("c.ply"))), testing::Contains("element edge 2"));
}

} // namespace
} // namespace voxtact::test

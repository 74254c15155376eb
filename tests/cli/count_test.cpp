// SPDX-License-Identifier: MIT
// voxtact count: which pairs, which counts, and what the options change.
#include "cli_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

enum Column : std::size_t { kPose, kMesh, kVolume, kHit, kCount, kExact, kMethod, kProjection };

class DetectTest : public CliDeviceTest {
  protected:
    /// The rows without the header and the comment.
    static std::vector<std::vector<std::string>> rows(const Arguments& arguments, const RunOptions& options = {}) {
        std::vector<std::vector<std::string>> rows;
        const auto lines = linesOf(output(arguments, options));
        for (std::size_t i = 1; i < lines.size(); ++i) {
            if (!lines[i].starts_with("#")) {
                rows.push_back(fieldsOf(lines[i]));
            }
        }
        return rows;
    }
    static std::vector<std::string> column(const Arguments& arguments, std::size_t index,
                                           const RunOptions& options = {}) {
        std::vector<std::string> fields;
        for (const auto& row : rows(arguments, options)) {
            fields.push_back(row.at(index));
        }
        return fields;
    }
    static std::uint64_t onlyCount(const Arguments& arguments, const RunOptions& options = {}) {
        const auto counts = column(arguments, kCount, options);
        EXPECT_EQ(counts.size(), 1U);
        return std::strtoull(counts.at(0).c_str(), nullptr, 10);
    }
};

TEST_F(DetectTest, OneRowWithItsHeader) {
    const auto lines = linesOf(output(detect()));
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], "pose,mesh,volume,touch,count,count_exact,method,projection");
    EXPECT_THAT(lines[1], MatchesRegex("0,builtin:scalpel:500,builtin:head:30,1,[1-9][0-9]*,1,(query|atomic),view"));
}

TEST_F(DetectTest, MethodsAgree) {
    const std::string file = poses(200);
    const auto query = rows(detect({"--poses", file, "--method", "query"}));
    const auto atomic = rows(detect({"--poses", file, "--method", "atomic"}));
    const auto any = rows(detect({"--poses", file, "--method", "query-any"}));
    ASSERT_EQ(query.size(), 200U);
    ASSERT_EQ(atomic.size(), 200U);
    ASSERT_EQ(any.size(), 200U);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < query.size(); ++i) {
        EXPECT_EQ(query[i][kPose], std::to_string(i));
        EXPECT_EQ(query[i][kCount], atomic[i][kCount]) << "pose " << i;
        EXPECT_EQ(query[i][kHit], any[i][kHit]) << "pose " << i;
        EXPECT_EQ(query[i][kHit], query[i][kCount] == "0" ? "0" : "1");
        EXPECT_EQ(any[i][kExact], "0");
        EXPECT_EQ(atomic[i][kExact], "1");
        EXPECT_EQ(query[i][kMethod] + atomic[i][kMethod] + any[i][kMethod], "queryatomicquery-any");
        hits += query[i][kHit] == "1" ? 1 : 0;
    }
    EXPECT_GT(hits, 20U);
    EXPECT_LT(hits, 180U);
}

TEST_F(DetectTest, ThreadsAreOfTheHost) {
    const Ran ran = run(detect({"--method", "atomic", "--threads", "2"}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("note: --threads 2 is not used"));
    EXPECT_THAT(run(detect({"--method", "cpu", "--threads", "2"})).err, Not(HasSubstr("--threads")));
}

TEST_F(DetectTest, BatchesOfAnySizeGiveTheSameRows) {
    const std::string file = poses(50);
    const std::string all = output(detect({"--poses", file, "--mesh", "builtin:ellipsoid:500"}));
    EXPECT_EQ(linesOf(all).size(), 101U);
    for (const char* batch : {"1", "7", "50", "51", "100", "4294967295"}) {
        EXPECT_EQ(output(detect({"--poses", file, "--mesh", "builtin:ellipsoid:500", "--batch", batch})), all) << batch;
    }
}

TEST_F(DetectTest, EveryMeshAgainstEveryVolume) {
    const auto all = rows({"count", "--volume", "builtin:head:30", "--volume", "builtin:ct:32", "--mesh",
                           "builtin:scalpel:500", "--mesh", "builtin:ellipsoid:500", "--poses", poses(3)});
    ASSERT_EQ(all.size(), 12U);
    std::vector<std::string> pairs;
    for (const auto& row : all) {
        pairs.push_back(row[kVolume] + " " + row[kMesh] + " " + row[kPose]);
    }
    EXPECT_EQ(pairs.front(), "builtin:head:30 builtin:scalpel:500 0");
    EXPECT_EQ(pairs.back(), "builtin:ct:32 builtin:ellipsoid:500 2");
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(std::unique(pairs.begin(), pairs.end()), pairs.end());
    // The same as each combination alone.
    const auto alone =
        rows({"count", "--volume", "builtin:ct:32", "--mesh", "builtin:ellipsoid:500", "--poses", path("poses.txt")});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(all[9 + i], alone[i]);
    }
}

TEST_F(DetectTest, ProjectionsAndTheirDefaults) {
    const auto projectionOf = [](const Arguments& arguments) { return rows(arguments).at(0).at(kProjection); };
    const Arguments plain{"count", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500"};
    const auto with = [&](const Arguments& more) {
        Arguments all = plain;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    EXPECT_EQ(projectionOf(plain), "certified");
    for (const char* method : {"compute", "cpu", "auto"}) {
        EXPECT_EQ(projectionOf(with({"--method", method})), "certified");
    }
    for (const char* method : {"query", "query-any", "atomic"}) {
        EXPECT_EQ(projectionOf(with({"--method", method})), "view");
    }
    EXPECT_EQ(projectionOf(with({"--filter", "exact"})), "certified");
    EXPECT_EQ(projectionOf(with({"--method", "compute", "--filter", "hardware"})), "view");
    for (const char* projection : {"view", "two-view", "dominant-axis"}) {
        for (const char* method : {"query", "compute", "cpu"}) {
            EXPECT_EQ(projectionOf(with({"--method", method, "--projection", projection})), projection);
        }
    }
    EXPECT_GT(onlyCount(with({"--projection", "dominant-axis", "--method", "cpu", "--samples-per-voxel", "4"})),
              2 * onlyCount(with({"--projection", "dominant-axis", "--method", "cpu"})));
}

TEST_F(DetectTest, CertifiedIsTheSameOnDeviceAndHost) {
    const std::string file = poses(12);
    const Arguments plain{"count",   "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500",
                          "--poses", file,       "--resolution",    "0.0625"};
    const auto by = [&](const char* method) {
        Arguments all = plain;
        all.insert(all.end(), {"--method", method});
        std::vector<std::vector<std::string>> found = rows(all);
        for (auto& row : found) {
            EXPECT_EQ(row.at(kMethod), method);
            row.at(kMethod).clear();
        }
        return found;
    };
    EXPECT_EQ(by("compute"), by("cpu"));
    // Who names a device wants it used; otherwise a GPU is, and a CPU that acts as one is not.
    Arguments device = plain;
    device.insert(device.end(), {"--device", "0"});
    EXPECT_EQ(rows(device).at(0).at(kMethod), "compute");
}

TEST_F(DetectTest, NoOverlapIsNoHit) {
    writeText(path("far.txt"), "1 0 0 1000 0 1 0 0 0 0 1 0 0 0 0 1\n");
    const Ran ran = run(detect({"--poses", path("far.txt")}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("note: builtin:scalpel:500 does not come near builtin:head:30 at its pose"));
    const auto far = fieldsOf(linesOf(ran.out).at(1));
    EXPECT_EQ(far.at(kHit) + far.at(kCount), "00");
    // However far it is, it is no larger.
    writeText(path("far.txt"), "1 0 0 1e300 0 1 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_THAT(run(detect({"--poses", path("far.txt")})).err, AllOf(HasSubstr("near"), Not(HasSubstr("mm long"))));
}

TEST_F(DetectTest, WhatIsWithinADistanceComesNear) {
    writeText(path("far.txt"), "1 0 0 300 0 1 0 0 0 0 1 0 0 0 0 1\n");
    const auto ask = [&](const Arguments& more) {
        Arguments all{"touch",   "--volume",     "builtin:head:30", "--mesh", "builtin:scalpel:500",
                      "--poses", path("far.txt")};
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    for (const Arguments& asked : {Arguments{"--margin", "400"}, Arguments{"--uncertainty", "400,0"}}) {
        const Ran ran = ask(asked);
        EXPECT_NE(fieldsOf(linesOf(ran.out).at(1)).at(kHit), "0");
        EXPECT_EQ(ran.err, "");
    }
    EXPECT_THAT(ask({"--margin", "1"}).err, HasSubstr("does not come near"));
}

TEST_F(DetectTest, LabelsAreOfAFile) {
    EXPECT_THAT(refused(2, detect({"--labels", "builtin:head:30", "--label-counts"})),
                HasSubstr("--labels needs a file, not 'builtin:head:30'; voxtact make volume writes"));
}

TEST_F(DetectTest, ThresholdAndTransferFunctionDecide) {
    const std::uint64_t standard = onlyCount(detect());
    EXPECT_EQ(onlyCount(detect({"--opacity", "0:0"}), {.note = "nothing touches"}), 0U);
    EXPECT_GT(onlyCount(detect({"--opacity", "0:1"})), standard);
    EXPECT_EQ(onlyCount(detect({"--opacity", "0:0,255:1"})), standard) << "the default is this ramp";
    EXPECT_LT(onlyCount(detect({"--opacity-threshold", "0.9"})), standard);
    EXPECT_EQ(onlyCount(detect({"--opacity-threshold", "0"})), onlyCount(detect({"--opacity", "0:1"})));
    writeText(path("a.tf"), "# text\n0 0\n255 1\n");
    EXPECT_EQ(onlyCount(detect({"--transfer-function", path("a.tf")})), standard);
    writeText(path("a.json"), "{\"points\": [[0, 0], [255, 1]]}");
    EXPECT_EQ(onlyCount(detect({"--transfer-function", path("a.json")})), standard);
}

TEST_F(DetectTest, DomainOfTheTable) {
    const Arguments ct{"count",     "--volume",    "builtin:ct:32", "--mesh", "builtin:scalpel:500",
                       "--opacity", "-100:0,300:1"};
    const auto with = [](Arguments arguments, const Arguments& more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    const std::uint64_t standard = onlyCount(ct);
    EXPECT_GT(standard, 0U);
    EXPECT_EQ(onlyCount(with(ct, {"--tf-domain", "-1024:3071", "--tf-size", "4096"})),
              onlyCount(with(ct, {"--tf-size", "4096"})))
        << "the default is the range of the data";
    const Ran outside = run(with(ct, {"--tf-domain", "0:100", "--projection", "view"}));
    EXPECT_EQ(outside.status, 0);
    EXPECT_THAT(outside.err,
                AllOf(StartsWith("voxtact: note: "), HasSubstr("builtin:ct:32"), HasSubstr("--tf-domain")));
}

TEST_F(DetectTest, ConstantVolumeHasADomain) {
    writeNifti(path("constant.nii"), {.type = 4, .bits = 16, .bytes = 1024, .value = 3});
    const Arguments arguments{"count", "--volume", path("constant.nii"), "--mesh", "builtin:scalpel:500"};
    Arguments opaque = arguments;
    opaque.insert(opaque.end(), {"--opacity", "770:0,771:1"}); // 0x0303
    EXPECT_GT(onlyCount(opaque), 0U);
    Arguments transparent = arguments;
    transparent.insert(transparent.end(), {"--opacity", "771:0,772:1"});
    EXPECT_EQ(onlyCount(transparent, {.note = "none of its values, 771, is opaque"}), 0U);
}

TEST_F(DetectTest, SizeAndCamera) {
    const std::uint64_t standard = onlyCount(detect());
    EXPECT_NEAR(static_cast<double>(onlyCount(detect({"--size", "1024x1024"}))), 4.0 * static_cast<double>(standard),
                0.1 * static_cast<double>(standard));
    EXPECT_GT(onlyCount(detect({"--size", "512x256"})), 0U);
    // Along world x, 200 mm per side.
    writeText(path("camera.txt"), "0 0.01 0 0\n0 0 0.01 0\n-0.002 0 0 0.5\n0 0 0 1\n");
    EXPECT_GT(onlyCount(detect({"--camera", path("camera.txt")})), standard);
    EXPECT_THAT(refused(2, detect({"--size", "99999x99999"})), HasSubstr("--size: 99999x99999"));
    EXPECT_THAT(refused(2, detect({"--tf-size", "4000000000"})), HasSubstr("--tf-size"));
}

TEST_F(DetectTest, BoundaryVariantsAgreeWhereItIsTransparent) {
    const Arguments arguments = detect({"--poses", poses(50), "--boundary"});
    const auto with = [&](const char* boundary) {
        Arguments all = arguments;
        all.push_back(boundary);
        return output(all);
    };
    EXPECT_EQ(with("auto"), with("range"));
    EXPECT_EQ(with("auto"), with("clamp"));
}

TEST_F(DetectTest, MeshSpaceAndScale) {
    output({"make", "mesh", "builtin:scalpel:500", path("scalpel.ply")});
    const Arguments file{"count",        "--volume", "builtin:head:30", "--mesh", path("scalpel.ply"),
                         "--projection", "view",     "--size",          "256x256"};
    const auto with = [&](const Arguments& more) {
        Arguments all = file;
        all.insert(all.end(), more.begin(), more.end());
        return onlyCount(all);
    };
    const std::uint64_t standard = with({});
    EXPECT_EQ(with({"--mesh-space", "lps"}), standard);
    EXPECT_LT(with({"--mesh-scale", "0.5"}), standard);
    // RAS negates x and y: the same as turning the mesh by half a turn about z.
    writeText(path("turn.txt"), "-1 0 0 0 0 -1 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_EQ(with({"--mesh-space", "ras", "--poses", path("turn.txt")}), standard);
}

TEST_F(DetectTest, DeviceByNumberAndName) {
    EXPECT_EQ(output(detect({"--device", "0"})), output(detect({"--device", "0"})));
    EXPECT_THAT(refused(2, detect({"--device", "4711"})), HasSubstr("there are: 0 "));
    EXPECT_THAT(refused(2, detect({"--device", "no such device"})), HasSubstr("there are: 0 "));
}

TEST_F(DetectTest, TimingAddsColumnsAndALastLine) {
    const auto lines = linesOf(output(detect({"--poses", poses(20), "--timing", "--batch", "1"})));
    ASSERT_EQ(lines.size(), 22U);
    EXPECT_EQ(lines.front(), "pose,mesh,volume,touch,count,count_exact,method,projection,gpu_ms,wall_ms");
    EXPECT_THAT(lines.back(), MatchesRegex("# pairs=20 wall_ms=[0-9.e-]+ pairs_per_s=[0-9.e+]+"));
    double sum = 0;
    for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
        const auto fields = fieldsOf(lines[i]);
        ASSERT_EQ(fields.size(), 10U);
        EXPECT_GE(std::stod(fields[9]), std::stod(fields[8])) << "the device's time is part of the wall's";
        sum += std::stod(fields[9]);
    }
    const std::string& last = lines.back();
    EXPECT_GE(std::stod(last.substr(last.find("wall_ms=") + 8)), sum) << "one after the other";
}

/// name=value of a line "# name=value ...".
std::map<std::string, std::uint64_t> numbersOf(const std::string& line) {
    std::map<std::string, std::uint64_t> numbers;
    std::istringstream in(line.substr(1));
    for (std::string word; in >> word;) {
        const std::size_t equals = word.find('=');
        numbers[word.substr(0, equals)] = std::stoull(word.substr(equals + 1));
    }
    return numbers;
}

TEST_F(DetectTest, StatsAreALineBehindTheRows) {
    const std::string file = poses(12);
    const Arguments plain = detect({"--projection", "certified", "--method", "compute", "--poses", file});
    for (const char* batch : {"12", "5"}) { // counters of submissions are added
        Arguments counted = plain;
        counted.insert(counted.end(), {"--stats", "--batch", batch});
        const auto lines = linesOf(output(counted));
        ASSERT_EQ(lines.size(), 14U);
        EXPECT_EQ(std::vector(lines.begin(), lines.end() - 1), linesOf(output(plain)));
        ASSERT_THAT(lines.back(), MatchesRegex("# clusters=[0-9]+ clusters_kept=.*"));
        auto numbers = numbersOf(lines.back());
        EXPECT_EQ(numbers.size(), 24U);
        EXPECT_GT(numbers.at("clusters"), numbers.at("clusters_kept"));
        EXPECT_GT(numbers.at("cells_decided"), 0U);
        EXPECT_GE(numbers.at("lanes"), numbers.at("cells_decided"));
        EXPECT_GE(numbers.at("rounds"), std::string(batch) == "5" ? 2U : 1U);
    }
    // auto takes the device, where the work is that is counted; with times there are two lines.
    const auto both = linesOf(output(detect({"--stats", "--method", "auto", "--timing", "--poses", file})));
    EXPECT_EQ(fieldsOf(both.at(1)).at(6), "compute");
    EXPECT_THAT(both.at(13), StartsWith("# clusters="));
    EXPECT_THAT(both.at(14), StartsWith("# pairs=12 "));
}

TEST_F(DetectTest, StatsAreOfADevicesCertified) {
    EXPECT_THAT(refused(2, detect({"--stats", "--method", "cpu"})), HasSubstr("--stats: the host engine"));
    EXPECT_THAT(refused(2, detect({"--stats", "--projection", "view"})),
                HasSubstr("--stats: it counts passes of --projection certified, not of view"));
    EXPECT_THAT(refused(2, detect({"--stats", "--method", "atomic"})), HasSubstr("not of view"));
}

TEST_F(DetectTest, ValidationIsQuiet) {
    const std::string file = poses(20);
    for (const char* method : {"query", "query-any", "atomic"}) {
        const Arguments plain = detect({"--poses", file, "--method", method, "--batch", "7", "--timing"});
        Arguments validated = plain;
        validated.push_back("--validate");
        EXPECT_EQ(column(validated, kCount), column(plain, kCount));
    }
    EXPECT_EQ(output({"devices", "--format", "csv", "--validate"}), output({"devices", "--format", "csv"}));
}

TEST_F(DetectTest, ValidationMessagesFailTheRun) {
    // Best practices warn of the debug extension that --validate itself needs: a message that is always there.
    const RunOptions noisy{.environment = {{"VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT"}}};
    writeText(path("out.csv"), "as it was");
    EXPECT_THAT(refused(3, detect({"--validate", "--output", path("out.csv")}), noisy), HasSubstr("--validate: "));
    EXPECT_EQ(readText(path("out.csv")), "as it was");
    EXPECT_EQ(filesInFolder(), 1U);
    refused(3, detect({"--validate"}), noisy);
}

} // namespace
} // namespace voxtact::test

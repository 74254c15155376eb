// SPDX-License-Identifier: MIT
// --shard: the parts of a run, one behind the other, are the whole, byte for byte. No device is needed.
#include "child.h"
#include "cli/options/shard.h"
#include "cli/plan/plan_fixture.h"

#include <random>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

TEST(Shard, PartsHaveEveryRowOnce) {
    const auto seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (int round = 0; round < 2000; ++round) {
        const std::uint64_t rows = random() >> (random() % 64);
        const auto count = static_cast<std::uint32_t>((random() >> (random() % 32 + 32)) | 1);
        const auto index = static_cast<std::uint32_t>(random() % count + 1);
        const auto [first, end] = app::Shard{index, count}.range(rows);
        EXPECT_LE(end - first, rows / count + 1) << index << '/' << count << " of " << rows;
        EXPECT_GE(end - first, rows / count) << index << '/' << count << " of " << rows;
        EXPECT_EQ(first, index == 1 ? 0 : app::Shard({index - 1, count}).range(rows).second);
        EXPECT_EQ((app::Shard{count, count}.range(rows).second), rows);
    }
}

/// 40 poses, some of which touch.
class ShardTest : public CliTest {
  protected:
    void SetUp() override {
        output({"make", "poses", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--number", "40",
                "--seed", "7", "--output", path("poses.txt")});
    }
    [[nodiscard]] Arguments detect(const Arguments& more = {}) const {
        return with({"count", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--mesh",
                     "builtin:ellipsoid:100", "--poses", path("poses.txt"), "--threads", "1"},
                    more);
    }
    static Arguments with(Arguments all, const Arguments& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// The rows of all parts, and of each of the files, which the parts write again. Notes are of each part's poses.
    [[nodiscard]] static std::vector<std::string> byShards(const Arguments& command, int shards,
                                                           const std::vector<std::string>& files = {}) {
        std::vector<std::string> all(files.size() + 1);
        for (int shard = 1; shard <= shards; ++shard) {
            const Ran ran = run(with(command, {"--shard", std::to_string(shard) + "/" + std::to_string(shards)}));
            EXPECT_EQ(ran.status, 0) << ran.err;
            all[0] += ran.out;
            for (std::size_t i = 0; i < files.size(); ++i) {
                all[i + 1] += readText(files[i]);
            }
        }
        return all;
    }
};

TEST_F(ShardTest, PartsOfDetectAreTheWhole) {
    Arguments touch = detect({"--volume", "builtin:sphere:16"});
    touch[0] = "touch";
    for (const Arguments& command :
         {detect(), touch, detect({"--volume", "builtin:sphere:16", "--mesh", "builtin:ellipsoid:100"})}) {
        SCOPED_TRACE(command.back());
        const std::string whole = output(command);
        EXPECT_GT(linesOf(whole).size(), 80U);
        for (const int shards : {1, 2, 7, 300}) {
            EXPECT_EQ(byShards(command, shards).front(), whole) << shards << " shards";
        }
    }
}

TEST_F(ShardTest, PartsOfFilesBesideTheRowsAreTheWhole) {
    // A label map must be on the grid of the volume, which a file rounds: both are one file.
    output({"make", "volume", "builtin:head:24", path("labels.nii.gz")});
    const auto expectWhole = [&](const char* question, const Arguments& more, const std::vector<std::string>& files) {
        Arguments command = detect(more);
        command[0] = question;
        command[2] = path("labels.nii.gz");
        std::vector<std::string> whole{output(command)};
        for (const std::string& file : files) {
            whole.push_back(readText(file));
            EXPECT_GT(linesOf(whole.back()).size(), 10U) << file;
        }
        EXPECT_EQ(byShards(command, 3, files), whole) << question;
    };
    const std::string first = path("1.csv");
    const std::string second = path("2.csv");
    const std::string labels = path("labels.nii.gz");
    expectWhole("count", {"--bounds", "--triangles", first, "--contacts", second, "--labels", labels, "--label-counts"},
                {first, second});
    expectWhole("distance", {"--tolerance", "0.5", "--witness", first}, {first});
    expectWhole("distance", {"--tolerance", "0.5", "--labels", labels, "--to", "117,210"}, {});
    expectWhole("area", {"--triangles", second}, {second});
    expectWhole("area", {"--labels", labels, "--in", "117,210"}, {});
}

TEST_F(ShardTest, PosesMayComeFromStandardInput) {
    Arguments command = detect({"--shard", "2/3"});
    const std::string part = output(command);
    command[8] = "-";
    Child child(command);
    child.write(readText(path("poses.txt")));
    child.closeInput();
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out, part);
}

TEST_F(ShardTest, PartsOfMotionsAreTheWhole) {
    const Arguments motion{"motion",
                           "--volume",
                           "builtin:head:18",
                           "--volume",
                           "builtin:sphere:16",
                           "--mesh",
                           "builtin:scalpel:100",
                           "--mesh",
                           "builtin:ellipsoid:60",
                           "--poses",
                           path("poses.txt"),
                           "--resolution",
                           "1",
                           "--threads",
                           "1"};
    const Ran whole = run(motion);
    ASSERT_EQ(whole.status, 0) << whole.err;
    for (const int shards : {2, 7}) {
        EXPECT_EQ(byShards(motion, shards).front(), whole.out) << shards << " shards";
    }
}

TEST_F(ShardTest, OnlyWhatCanBePutTogether) {
    for (const char* shard : {"", "1", "0/2", "3/2", "1/", "/2", "-1/2", "1/2/3", "1/4294967296"}) {
        EXPECT_THAT(refused(2, detect({"--shard", shard})), HasSubstr("--shard")) << shard;
    }
    for (const char* format : {"json", "text"}) {
        EXPECT_THAT(refused(2, detect({"--shard", "1/2", "--format", format})),
                    AllOf(HasSubstr("--format"), HasSubstr("--shard writes CSV")));
    }
    EXPECT_THAT(refused(2, detect({"--shard", "1/2", "--timing"})), HasSubstr("--timing: not with --shard"));
    EXPECT_THAT(refused(2, detect({"--shard", "1/2", "--summary"})), HasSubstr("--summary: not with --shard"));
}

class PlanShardTest : public PlanTest {};

TEST_F(PlanShardTest, PartsAreOfTargets) {
    std::string targets;
    for (int i = 0; i < 5; ++i) {
        targets += std::to_string(20 - 4 * i) + " " + std::to_string(i) + " 30\n";
    }
    writeText(path("targets.txt"), targets);
    const Arguments command =
        plan({"--labels", path("labels.nii.gz"), "--avoid", "Skull", "--margin", "1", "--targets", path("targets.txt"),
              "--threads", "1", "--by-target", path("t.csv"), "--surface", path("s{target}.ply")});
    const std::string rows = output(command);
    const std::string byTarget = readText(path("t.csv"));
    EXPECT_EQ(linesOf(byTarget).size(), 6U);
    std::vector<std::string> surfaces;
    for (int target = 1; target <= 5; ++target) {
        surfaces.push_back(readText(path("s" + std::to_string(target) + ".ply")));
        fs::remove(path("s" + std::to_string(target) + ".ply"));
    }
    for (const int shards : {2, 7}) {
        std::string partRows;
        std::string partTargets;
        for (int shard = 1; shard <= shards; ++shard) {
            Arguments part = command;
            part.insert(part.end(), {"--shard", std::to_string(shard) + "/" + std::to_string(shards)});
            partRows += output(part);
            partTargets += readText(path("t.csv"));
        }
        EXPECT_EQ(partRows, rows) << shards << " shards";
        EXPECT_EQ(partTargets, byTarget) << shards << " shards";
        for (int target = 1; target <= 5; ++target) {
            EXPECT_EQ(readText(path("s" + std::to_string(target) + ".ply")), surfaces.at(target - 1U));
        }
    }
    Arguments report = command;
    report.insert(report.end(), {"--shard", "1/2", "--report", path("r.html")});
    EXPECT_THAT(refused(2, report), HasSubstr("--report: not with --shard"));
}

} // namespace
} // namespace voxtact::test

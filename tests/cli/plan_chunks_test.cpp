// SPDX-License-Identifier: MIT
// voxtact plan in chunks: the same files for any number of shards, and when a process was killed.
#include "child.h"
#include "plan_fixture.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PlanChunksTest : public PlanTest {
  protected:
    void SetUp() override {
        PlanTest::SetUp();
        std::string targets;
        for (int i = 0; i < 9; ++i) {
            targets += std::to_string(20 - 4 * i) + " " + std::to_string(i) + " 30\n";
        }
        writeText(path("targets.txt"), targets);
    }
    [[nodiscard]] Arguments asked(const Arguments& more) const {
        Arguments all{"--labels", path("labels.nii.gz"), "--avoid",           "Skull",     "--margin",
                      "1",        "--targets",           path("targets.txt"), "--threads", "1"};
        all.insert(all.end(), more.begin(), more.end());
        return plan(all);
    }
    /// That are there under their names.
    [[nodiscard]] std::size_t chunks() const {
        std::size_t found = 0;
        std::error_code problem;
        for (fs::directory_iterator entry(path("run"), problem), end; !problem && entry != end;
             entry.increment(problem)) {
            const fs::path& file = entry->path();
            found += file.extension() == ".output" && !file.filename().string().starts_with(".") ? 1 : 0;
        }
        return found;
    }
    /// What each target has of its own; they are no longer there then.
    [[nodiscard]] std::vector<std::string> takeFiles() const {
        std::vector<std::string> found;
        for (int target = 1; target <= 9; ++target) {
            for (const std::string& file :
                 {"s" + std::to_string(target) + ".ply", "m" + std::to_string(target) + ".nii.gz"}) {
                found.push_back(readText(path(file)));
                fs::remove(path(file));
            }
        }
        return found;
    }
    static Arguments with(Arguments all, const Arguments& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

TEST_F(PlanChunksTest, TheFilesAreTheSameHoweverTheyAreDone) {
    for (const std::string format : {"csv", "json"}) {
        Arguments command = asked(
            {"--by-target", path("t.csv"), "--surface", path("s{target}.ply"), "--heat-map", path("m{target}.nii.gz")});
        std::replace(command.begin(), command.end(), std::string("csv"), format);
        const std::string rows = output(command);
        const std::string targets = readText(path("t.csv"));
        EXPECT_EQ(linesOf(targets).size(), 10U);
        const std::vector<std::string> maps = takeFiles();
        EXPECT_THAT(maps, testing::Each(testing::Not("")));
        EXPECT_NE(maps.front(), maps.back());
        for (const int shards : {1, 2, 7}) {
            SCOPED_TRACE(format + ", shards: " + std::to_string(shards));
            fs::remove_all(path("run"));
            for (int shard = shards; shard >= 1; --shard) {
                EXPECT_EQ(output(with(command, {"--resume", path("run"), "--chunk", shards == 2 ? "2" : "1", "--shard",
                                                std::to_string(shard) + "/" + std::to_string(shards)})),
                          "");
            }
            fs::remove(path("t.csv"));
            EXPECT_EQ(output({"merge", path("run"), "--by-target", path("t.csv"), "--surface", path("s{target}.ply"),
                              "--heat-map", path("m{target}.nii.gz")}),
                      rows);
            EXPECT_EQ(readText(path("t.csv")), targets);
            EXPECT_EQ(takeFiles(), maps);
        }
        fs::remove_all(path("run"));
        EXPECT_EQ(output(with(command, {"--resume", path("run")})), rows) << "in one go";
        EXPECT_EQ(readText(path("t.csv")), targets);
        EXPECT_EQ(takeFiles(), maps);
        fs::remove_all(path("run"));
    }
}

TEST_F(PlanChunksTest, MergeRefusesFilesThatCannotBe) {
    output(asked({"--resume", path("run"), "--shard", "1/1", "--heat-map", "wanted.nrrd"}));
    const auto line = [&](const Arguments& more) { return refused(2, with({"merge", path("run")}, more)); };
    EXPECT_THAT(line({"--surface", path("{target}.ply")}), HasSubstr("was not asked for it; leave it out"));
    EXPECT_THAT(line({"--heat-map", path("{target}.nii.gz")}), HasSubstr("--heat-map: the run has it as .nrrd"));
    EXPECT_THAT(line({"--heat-map", path("map.nrrd")}), HasSubstr("--heat-map: there are 9 targets"));
    EXPECT_THAT(line({"--heat-map", path("run/{target}.nrrd")}), HasSubstr("in the folder '" + path("run") + "'"));
    output({"merge", path("run"), "--heat-map", path("{target}.nrrd"), "--output", path("rows.csv")});
    EXPECT_FALSE(readText(path("9.nrrd")).empty());
}

TEST_F(PlanChunksTest, GoesOnWhereItWasKilled) {
    const Arguments command = asked({"--entries", "2562"});
    const std::string rows = output(command);
    int killed = 0;
    for (const std::size_t whole : {1U, 4U, 6U}) {
        Child child(with(command, {"--resume", path("run"), "--output", path("rows.csv")}));
        for (int i = 0; i < 20000 && chunks() < whole; ++i) {
            ::usleep(1000);
        }
        EXPECT_GE(chunks(), whole);
        child.signal(SIGKILL);
        killed += child.end().status == 128 + SIGKILL ? 1 : 0;
    }
    EXPECT_GT(killed, 0);
    const Ran last = run(with(command, {"--resume", path("run"), "--output", path("rows.csv")}));
    EXPECT_EQ(last.status, 0);
    EXPECT_THAT(last.err, HasSubstr("were there already"));
    EXPECT_EQ(readText(path("rows.csv")), rows);
    // What is there is another run's for other targets.
    writeText(path("targets.txt"), "20 0 30\n");
    EXPECT_THAT(refused(2, with(command, {"--resume", path("run")})), HasSubstr("has another run: its content of"));
}

TEST_F(PlanChunksTest, RefusesWhatIsAboutAll) {
    const auto line = [&](const Arguments& more) { return refused(2, asked(with({"--resume", path("run")}, more))); };
    EXPECT_THAT(line({"--report", path("r.html")}), HasSubstr("--report: not with --resume"));
    EXPECT_THAT(line({"--picture", path("p.png")}), HasSubstr("--picture: not with --resume"));
    EXPECT_THAT(line({"--heat-map", path("m.nii.gz")}), HasSubstr("--heat-map: there are 9 targets"));
    EXPECT_THAT(line({"--summary"}), HasSubstr("--by-target says the same"));
    EXPECT_THAT(line({"--timing"}), HasSubstr("--timing: not with --resume"));
    EXPECT_THAT(refused(2, asked({"--shard", "1/2"})), HasSubstr("give its folder by --resume"));
    EXPECT_FALSE(fs::exists(path("run")));
}

} // namespace
} // namespace voxtact::test

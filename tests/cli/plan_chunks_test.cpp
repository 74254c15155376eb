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
    static Arguments with(Arguments all, const Arguments& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

TEST_F(PlanChunksTest, TheFilesAreTheSameHoweverTheyAreDone) {
    for (const std::string format : {"csv", "json"}) {
        Arguments command = asked({"--by-target", path("t.csv")});
        std::replace(command.begin(), command.end(), std::string("csv"), format);
        const std::string rows = output(command);
        const std::string targets = readText(path("t.csv"));
        EXPECT_EQ(linesOf(targets).size(), 10U);
        for (const int shards : {1, 2, 7}) {
            SCOPED_TRACE(format + ", shards: " + std::to_string(shards));
            fs::remove_all(path("run"));
            for (int shard = shards; shard >= 1; --shard) {
                EXPECT_EQ(output(with(command, {"--resume", path("run"), "--chunk", shards == 2 ? "2" : "1", "--shard",
                                                std::to_string(shard) + "/" + std::to_string(shards)})),
                          "");
            }
            fs::remove(path("t.csv"));
            EXPECT_EQ(output({"merge", path("run"), "--by-target", path("t.csv")}), rows);
            EXPECT_EQ(readText(path("t.csv")), targets);
        }
        fs::remove_all(path("run"));
        EXPECT_EQ(output(with(command, {"--resume", path("run")})), rows) << "in one go";
        EXPECT_EQ(readText(path("t.csv")), targets);
        fs::remove_all(path("run"));
    }
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
    EXPECT_THAT(line({"--heat-map", path("m.nii.gz")}), HasSubstr("--heat-map: not with --resume"));
    EXPECT_THAT(line({"--summary"}), HasSubstr("--by-target says the same"));
    EXPECT_THAT(line({"--timing"}), HasSubstr("--timing: not with --resume"));
    EXPECT_THAT(refused(2, asked({"--shard", "1/2"})), HasSubstr("give its folder by --resume"));
    EXPECT_FALSE(fs::exists(path("run")));
}

} // namespace
} // namespace voxtact::test

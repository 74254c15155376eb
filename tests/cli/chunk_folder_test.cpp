// SPDX-License-Identifier: MIT
// What is left of processes that were ended in the middle, and who may remove it.
#include "child.h"

#include "app/mpi/rank_report.h"

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using app::RankEnd;
using app::RankNotes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ChunkFolderTest : public CliTest {
  protected:
    void SetUp() override {
        output({"make", "poses", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--number", "40",
                "--seed", "7", "--output", path("poses.txt")});
    }
    [[nodiscard]] Arguments chunked(const Arguments& more = {}) const {
        Arguments all{"detect",  "--volume",        "builtin:head:24", "--mesh",  "builtin:scalpel:200",
                      "--poses", path("poses.txt"), "--count",         "cpu",     "--threads",
                      "1",       "--resume",        path("run"),       "--chunk", "7"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Files in the run's folder under names that are not to stay.
    [[nodiscard]] std::vector<std::string> temporaryFiles() const {
        std::vector<std::string> found;
        for (const fs::directory_entry& entry : fs::directory_iterator(path("run"))) {
            if (const std::string name = entry.path().filename().string(); name.starts_with(".")) {
                found.push_back(name);
            }
        }
        std::sort(found.begin(), found.end());
        return found;
    }
    void leave(const std::string& name) const { writeText(path("run") + "/" + name, "half a chunk"); }
};

TEST_F(ChunkFolderTest, FilesOfProcessesThatHaveEndedAreRemoved) {
    output(chunked({"--shard", "1/2"}));
    EXPECT_THAT(temporaryFiles(), IsEmpty());
    const std::string dead = ".tmp4711-81-0-00000000-0123456789abcdef.output";
    leave(dead);
    leave(".tmp-manifest-4711-0123456789abcdef");
    leave(".tmpfs-notes"); // somebody's own
    {
        // As long as another process is at work it may be its.
        const int other = ::open((path("run") + "/run.lock").c_str(), O_RDWR | O_CLOEXEC);
        ASSERT_EQ(::flock(other, LOCK_SH | LOCK_NB), 0);
        output(chunked({"--shard", "2/2"}));
        EXPECT_EQ(temporaryFiles().size(), 3U);
        ::close(other);
    }
    EXPECT_EQ(run(chunked({"--shard", "2/2"})).status, 0);
    EXPECT_THAT(temporaryFiles(), ElementsAre(".tmpfs-notes"));
    leave(dead);
    EXPECT_EQ(run(chunked()).status, 0);
    EXPECT_THAT(temporaryFiles(), ElementsAre(".tmpfs-notes"));
    // Who only reads removes nothing.
    leave(dead);
    output({"merge", path("run"), "--output", path("rows.csv")});
    EXPECT_EQ(temporaryFiles().size(), 2U);
}

TEST_F(ChunkFolderTest, AKilledProcessLeavesNothingForLong) {
    std::string many;
    for (int i = 0; i < 100; ++i) {
        many += readText(path("poses.txt"));
    }
    writeText(path("poses.txt"), many);
    const Arguments command = chunked({"--clearance", "--output", path("rows.csv")});
    std::size_t left = 0;
    for (int i = 0; i < 10 && left == 0; ++i) {
        Child child(command);
        for (int wait = 0; wait < 20000 && (!fs::exists(path("run")) || temporaryFiles().empty()); ++wait) {
            ::usleep(500);
        }
        child.signal(SIGKILL);
        child.end();
        left = temporaryFiles().size();
    }
    EXPECT_GT(left, 0U) << "the test is too slow";
    // Two at once: none takes the other's.
    Child one(chunked({"--clearance", "--shard", "1/2"}));
    Child two(chunked({"--clearance", "--shard", "2/2"}));
    EXPECT_EQ(one.end().status, 0);
    EXPECT_EQ(two.end().status, 0);
    EXPECT_EQ(run({"merge", path("run"), "--output", path("rows.csv")}).status, 0);
    EXPECT_EQ(linesOf(readText(path("rows.csv"))).size(), 4001U);
    EXPECT_EQ(run(command).status, 0);
    EXPECT_THAT(temporaryFiles(), IsEmpty());
}

TEST(RankReport, EndsAreReadAsTheyWereWritten) {
    for (const RankEnd& end : {RankEnd{0, true, "a note\nanother\n"}, RankEnd{2, false, "why: 1\n"},
                               RankEnd{137, true, ""}, RankEnd{0, false, "\n\n"}}) {
        const RankEnd read = RankEnd::of(end.message());
        EXPECT_EQ(read.status, end.status);
        EXPECT_EQ(read.done, end.done);
        EXPECT_EQ(read.text, end.text);
    }
    EXPECT_FALSE(RankEnd::of("").done);
}

TEST(RankReport, NotesAreSaidOnceAndNamed) {
    RankNotes notes;
    notes.add(2, "of all");
    notes.add(0, "of one");
    notes.add(0, "of all");
    notes.add(1, "of all");
    notes.add(1, "of two");
    notes.add(1, "of two");
    notes.add(2, "of two");
    EXPECT_THAT(notes.lines(3), ElementsAre("all ranks: of all", "rank 0: of one", "ranks 1, 2: of two"));
    RankNotes alone;
    alone.add(0, "a note");
    EXPECT_THAT(alone.lines(1), ElementsAre("a note"));
    EXPECT_THAT(RankNotes().lines(3), IsEmpty());
}

} // namespace
} // namespace voxtact::test

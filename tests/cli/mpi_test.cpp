// SPDX-License-Identifier: MIT
// voxtact-mpi: the ranks of a job do one run. Where it is not built there is nothing to test.
#include "cli_fixture.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

#ifdef VOXTACT_MPIRUN
constexpr const char* kMpirun = VOXTACT_MPIRUN;
constexpr const char* kProgram = VOXTACT_MPI_PROGRAM;
#else
constexpr const char* kMpirun = "";
constexpr const char* kProgram = "";
#endif

class MpiTest : public CliTest {
  protected:
    void SetUp() override {
        if (kMpirun[0] == '\0') {
            GTEST_SKIP() << "this build has no voxtact-mpi";
        }
        output({"make", "poses", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--number", "40",
                "--seed", "7", "--output", path("poses.txt")});
    }
    [[nodiscard]] Arguments detect(const Arguments& more = {}) const {
        Arguments all{"detect",
                      "--volume",
                      "builtin:head:24",
                      "--volume",
                      "builtin:sphere:16",
                      "--mesh",
                      "builtin:scalpel:200",
                      "--poses",
                      path("poses.txt"),
                      "--count",
                      "cpu",
                      "--threads",
                      "1"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Begins a job of so many ranks.
    [[nodiscard]] pid_t begin(int ranks, const Arguments& arguments) const {
        std::vector<std::string> words{kMpirun, "--oversubscribe", "-n", std::to_string(ranks), kProgram};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        for (std::string& word : words) {
            pointers.push_back(word.data());
        }
        pointers.push_back(nullptr);
        const pid_t job = ::fork();
        if (job == 0) {
            ::dup2(::open(path("out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
            ::dup2(::open(path("err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
            ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
            ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
            ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
            // In a container one process may not read another's memory.
            ::setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);
            setCaches();
            ::execv(kMpirun, pointers.data());
            ::_exit(127);
        }
        return job;
    }
    [[nodiscard]] Ran end(pid_t job) const {
        int state = 0;
        ::waitpid(job, &state, 0);
        return {WIFEXITED(state) ? WEXITSTATUS(state) : -1, readText(path("out")), readText(path("err"))};
    }
    [[nodiscard]] Ran runRanks(int ranks, const Arguments& arguments) const { return end(begin(ranks, arguments)); }

    [[nodiscard]] std::size_t chunks() const {
        std::size_t count = 0;
        std::error_code problem;
        for (std::filesystem::directory_iterator entry(path("run"), problem), last; !problem && entry != last;
             entry.increment(problem)) {
            count += entry->path().extension() == ".output" && entry->path().filename().string()[0] != '.' ? 1 : 0;
        }
        return count;
    }
    /// The processes of the ranks: children of the job's.
    static std::vector<pid_t> ranksOf(pid_t job) {
        std::ifstream list("/proc/" + std::to_string(job) + "/task/" + std::to_string(job) + "/children");
        std::vector<pid_t> ranks;
        for (pid_t rank = 0; list >> rank;) {
            ranks.push_back(rank);
        }
        return ranks;
    }
};

TEST_F(MpiTest, TheFileIsTheSameForAnyNumberOfRanks) {
    for (const char* format : {"csv", "json"}) {
        const std::string plain = output(detect({"--format", format}));
        for (const int ranks : {1, 2, 4}) {
            std::filesystem::remove_all(path("run"));
            const Ran ran = runRanks(ranks, detect({"--format", format, "--resume", path("run"), "--chunk", "3"}));
            EXPECT_EQ(ran.status, 0) << ran.err;
            EXPECT_EQ(ran.out, plain) << ranks;
            std::size_t all = 0;
            for (int rank = 0; rank < ranks; ++rank) {
                const std::string words = "rank " + std::to_string(rank) + ": ";
                const std::size_t at = ran.err.find(words);
                ASSERT_NE(at, std::string::npos) << ran.err;
                all += static_cast<std::size_t>(std::atoi(ran.err.c_str() + at + words.size()));
            }
            EXPECT_EQ(all, 28U) << ran.err;
            EXPECT_THAT(ran.err, AllOf(HasSubstr(" s busy, "), HasSubstr(" s idle")));
        }
    }
    // All is there: nothing is dealt.
    const Ran again = runRanks(2, detect({"--format", "json", "--resume", path("run"), "--chunk", "3"}));
    EXPECT_EQ(again.status, 0);
    EXPECT_THAT(again.err, AllOf(HasSubstr("rank 0: 0 chunks"), HasSubstr("28 chunks were there already")));
}

TEST_F(MpiTest, PlansAreDealtByTarget) {
    Arguments plan{"plan",      "--volume", "builtin:head:24", "--avoid-opacity", "200:0,201:1",
                   "--entries", "42",       "--target",        "20,0,30",         "--target",
                   "0,0,20",    "--target", "-20,5,30",        "--format",        "csv",
                   "--threads", "1"};
    const std::string plain = output(plan);
    plan.insert(plan.end(), {"--resume", path("run")});
    const Ran ran = runRanks(2, plan);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out, plain);
    EXPECT_EQ(chunks(), 3U);
}

TEST_F(MpiTest, NotesOfAllRanksAreSaidOnceAndNamed) {
    std::string far;
    for (int i = 0; i < 12; ++i) {
        far += "1 0 0 1e11 0 1 0 0 0 0 1 0 0 0 0 1\n";
    }
    writeText(path("poses.txt"), far);
    for (const int ranks : {1, 3}) {
        std::filesystem::remove_all(path("run"));
        const Ran ran = runRanks(ranks, {"detect", "--volume", "builtin:sphere:16", "--mesh", "builtin:ellipsoid:60",
                                         "--poses", path("poses.txt"), "--clearance", "--tolerance", "1e-6",
                                         "--threads", "1", "--resume", path("run"), "--chunk", "1"});
        EXPECT_EQ(ran.status, 0) << ran.err;
        std::size_t all = 0;
        std::size_t lines = 0;
        for (const std::string& line : linesOf(ran.err)) {
            const std::size_t at = line.find("the bounds of ");
            if (at == std::string::npos) {
                continue;
            }
            ++lines;
            // "all ranks: ", "ranks 0, 2: ", "rank 1: ", or nothing of one rank alone
            const std::string who = line.substr(0, at);
            const std::size_t saying = who.find("all ranks: ") != std::string::npos ? static_cast<std::size_t>(ranks)
                                       : who.find("rank") != std::string::npos
                                           ? 1 + static_cast<std::size_t>(std::count(who.begin(), who.end(), ','))
                                           : 1;
            EXPECT_EQ(who.find("rank") == std::string::npos, ranks == 1) << line;
            all += saying * static_cast<std::size_t>(std::atoi(line.c_str() + at + 14));
        }
        EXPECT_EQ(all, 12U) << ran.err;
        EXPECT_GE(lines, 1U);
    }
}

TEST_F(MpiTest, ARankThatDiesEndsTheJobAndTheRunGoesOn) {
    std::string many;
    for (int i = 0; i < 50; ++i) {
        many += readText(path("poses.txt"));
    }
    writeText(path("poses.txt"), many);
    const Arguments command = detect(
        {"--clearance", "--tolerance", "1", "--resume", path("run"), "--chunk", "50", "--output", path("rows.csv")});
    const pid_t job = begin(2, command);
    for (int i = 0; i < 60000 && chunks() < 3; ++i) {
        ::usleep(1000);
    }
    // The one that does not deal, where there still is one.
    if (const std::vector<pid_t> ranks = ranksOf(job); ranks.size() == 2) {
        ::kill(ranks.back(), SIGKILL);
    }
    const Ran ran = end(job);
    const bool wasFast = ran.status == 0;
    EXPECT_EQ(std::filesystem::exists(path("rows.csv")), wasFast) << ran.err;
    EXPECT_GE(chunks(), 3U);
    // With another number of ranks, or none.
    const Ran last = runRanks(3, command);
    EXPECT_EQ(last.status, 0) << last.err;
    EXPECT_THAT(last.err, HasSubstr("were there already"));
    EXPECT_EQ(readText(path("rows.csv")), output(detect({"--clearance", "--tolerance", "1"})));
    EXPECT_EQ(run({"merge", path("run")}).out, readText(path("rows.csv")));
}

TEST_F(MpiTest, WhatIsWrongIsSaidOnce) {
    const auto linesWith = [](const std::string& text, const char* words) {
        const std::vector<std::string> lines = linesOf(text);
        return std::count_if(lines.begin(), lines.end(),
                             [&](const std::string& line) { return line.find(words) != std::string::npos; });
    };
    const auto refusal = [&](const Arguments& arguments, const char* words) {
        const Ran ran = runRanks(3, arguments);
        EXPECT_NE(ran.status, 0);
        EXPECT_EQ(ran.out, "");
        EXPECT_EQ(linesWith(ran.err, words), 1) << ran.err;
        EXPECT_EQ(linesWith(ran.err, "voxtact detect:") + linesWith(ran.err, "voxtact:"), 1) << ran.err;
    };
    refusal(detect(), "--resume is required");
    refusal(detect({"--resume", path("run"), "--shard", "1/2"}), "--shard: the first rank deals the chunks");
    refusal({"info", "builtin:head:24"}, "the ranks of a job do detect, motion or plan");
    refusal(detect({"--resume", path("run"), "--timing"}), "--timing: not with --resume");
    refusal(detect({"--resume", path("run"), "--mesh", path("none.stl")}), "none.stl");
    refusal(detect({"--resume", path("run"), "--no-such"}), "unknown argument");
    writeText(path("run"), "a file");
    refusal(detect({"--resume", path("run")}), "it is a file");
    const Ran help = runRanks(2, {"--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(linesWith(help.out, "Usage:"), 1);
}

} // namespace
} // namespace voxtact::test

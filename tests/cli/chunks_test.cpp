// SPDX-License-Identifier: MIT
// A run in chunks: --resume, --shard, voxtact merge. What comes out is what comes out without, whatever happens on the
// way. No device is needed.
#include "child.h"
#include "chunks_fixture.h"

#include <algorithm>
#include <csignal>
#include <random>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST_F(ChunksTest, TheFileIsTheSameHoweverItIsDone) {
    writeText(path("jobs.csv"), "builtin:scalpel:200,builtin:head:24," + path("poses.txt") +
                                    "\nbuiltin:ellipsoid:100,builtin:sphere:16," + path("poses.txt") +
                                    "\nbuiltin:ellipsoid:100,builtin:sphere:16\nbuiltin:scalpel:200,builtin:head:24\n");
    const std::vector<Arguments> commands{
        detect(),
        detect({"--format", "json"}),
        detect({"--answer", "yes-no", "--volume", "builtin:sphere:16"}),
        {"detect", "--jobs", path("jobs.csv"), "--count", "cpu", "--projection", "view", "--threads", "1"}};
    for (const Arguments& command : commands) {
        SCOPED_TRACE(command.back());
        const std::string plain = output(command);
        EXPECT_GT(linesOf(plain).size(), 80U);
        for (const int shards : {1, 2, 7, 30}) {
            EXPECT_EQ(byShards(command, shards), plain) << shards << " shards";
        }
        removeRun();
        EXPECT_EQ(output(with(command, {"--resume", path("run"), "--chunk", "9"})), plain) << "in one go";
        removeRun();
        output(with(command, {"--resume", path("run"), "--output", path("rows.csv")}));
        EXPECT_EQ(readText(path("rows.csv")), plain);
        EXPECT_EQ(chunkFiles().size(), command[1] == "--jobs"                  ? 3U
                                       : command.back() == "builtin:sphere:16" ? 2U
                                                                               : 1U)
            << "a chunk of 10,000 rows has one volume";
    }
}

TEST_F(ChunksTest, FilesBesideTheRowsAreTheSame) {
    // A label map must be on the grid of the volume, which a file rounds: both are one file.
    output({"make", "volume", "builtin:head:24", path("labels.nii.gz")});
    Arguments clearance =
        detect({"--clearance", "--tolerance", "0.5", "--labels", path("labels.nii.gz"), "--triangles", path("t.csv"),
                "--closest", path("c.csv"), "--label-clearance", path("l.csv"), "--to", "117,210", "--bounds"});
    clearance[2] = path("labels.nii.gz");
    const std::string rows = output(clearance);
    const std::vector<std::pair<std::string, std::string>> files{
        {"--triangles", "t.csv"}, {"--closest", "c.csv"}, {"--label-clearance", "l.csv"}};
    std::vector<std::string> plain;
    for (const auto& file : files) {
        plain.push_back(readText(path(file.second)));
        EXPECT_GT(linesOf(plain.back()).size(), 10U) << file.second;
        fs::remove(path(file.second));
    }
    EXPECT_EQ(byShards(clearance, 3,
                       {"--triangles", path("T.csv"), "--closest", path("C.csv"), "--label-clearance", path("L.csv")}),
              rows);
    EXPECT_EQ(readText(path("T.csv")), plain[0]);
    EXPECT_EQ(readText(path("C.csv")), plain[1]);
    EXPECT_EQ(readText(path("L.csv")), plain[2]);
    EXPECT_FALSE(fs::exists(path("t.csv"))) << "a shard writes no output";
    // The same folder, without shards: all chunks are there, and the command's own paths are written.
    const Ran again = run(with(clearance, {"--resume", path("run"), "--chunk", "7"}));
    EXPECT_EQ(again.status, 0);
    EXPECT_EQ(again.out, rows);
    EXPECT_THAT(again.err, HasSubstr("12 chunks of 12 in"));
    for (std::size_t i = 0; i < files.size(); ++i) {
        EXPECT_EQ(readText(path(files[i].second)), plain[i]);
    }
    // Only what is asked for is merged, and only what there is.
    EXPECT_EQ(output({"merge", path("run")}), rows);
    EXPECT_THAT(refused(2, {"merge", path("run"), "--closest", path("C.ply")}), HasSubstr("the run has it as .csv"));
    static_cast<void>(byShards(detect(), 1));
    EXPECT_THAT(refused(2, {"merge", path("run"), "--triangles", path("x.csv")}), HasSubstr("was not asked for it"));
}

TEST_F(ChunksTest, NotesAreOfAllChunks) {
    std::string far;
    for (int i = 0; i < 4; ++i) {
        far += "1 0 0 1e11 0 1 0 0 0 0 1 0 0 0 0 1\n";
    }
    writeText(path("poses.txt"), far);
    const Arguments command{"detect",  "--volume",        "builtin:sphere:16", "--mesh",      "builtin:ellipsoid:60",
                            "--poses", path("poses.txt"), "--clearance",       "--tolerance", "1e-6"};
    const Ran plain = run(command);
    const Ran chunks = run(with(command, {"--resume", path("run"), "--chunk", "1"}));
    EXPECT_EQ(chunks.out, plain.out);
    EXPECT_EQ(chunks.err, plain.err);
    EXPECT_THAT(plain.err, AllOf(HasSubstr("of 4 poses"), HasSubstr("the bounds of 4 of 4 clearances")));
}

TEST_F(ChunksTest, MotionsAreTheSame) {
    for (const char* format : {"csv", "json"}) {
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
                               "--resolution-mm",
                               "1",
                               "--threads",
                               "1",
                               "--format",
                               format};
        const Ran plain = run(motion);
        ASSERT_EQ(plain.status, 0) << plain.err;
        for (const int shards : {1, 2, 7}) {
            removeRun();
            for (int shard = 1; shard <= shards; ++shard) {
                const Ran part = run(with(motion, {"--resume", path("run"), "--chunk", "11", "--shard",
                                                   std::to_string(shard) + "/" + std::to_string(shards)}));
                EXPECT_EQ(part.status, 0) << part.err;
                EXPECT_EQ(part.out, "");
            }
            EXPECT_EQ(output({"merge", path("run")}), plain.out) << shards;
        }
        const Ran again = run(with(motion, {"--resume", path("run"), "--chunk", "11"}));
        EXPECT_EQ(again.out, plain.out);
        EXPECT_THAT(again.err, HasSubstr("were there already"));
        removeRun();
    }
    EXPECT_THAT(refused(2, {"motion", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:100", "--poses",
                            path("poses.txt"), "--resume", path("run"), "--timing"}),
                HasSubstr("--timing: not with --resume"));
    EXPECT_THAT(refused(2, {"motion", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:100", "--poses",
                            path("poses.txt"), "--resume", path("run"), "--count", "compute", "--validate"}),
                HasSubstr("--validate: not with --resume"));
    EXPECT_FALSE(fs::exists(path("run")));
}

/// Killed again and again at any moment, however far it is then.
TEST_F(ChunksTest, KilledItGoesOn) {
    const std::string plain = output(detect({"--triangles", path("t.csv")}));
    const std::string triangles = readText(path("t.csv"));
    fs::remove(path("t.csv"));
    const auto seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Arguments command = detect({"--resume", path("run"), "--chunk", "2", "--triangles", path("t.csv")});
    for (std::size_t kill = 1; kill <= 5; ++kill) {
        Child child(command);
        for (int i = 0; i < 5000 && chunkFiles().size() < 4 * kill; ++i) {
            ::usleep(2000);
        }
        ::usleep(static_cast<useconds_t>(random() % 5000));
        child.signal(SIGKILL);
        child.end();
    }
    EXPECT_GE(chunkFiles().size(), 20U);
    fs::remove(path("t.csv")); // it may have been fast
    const Ran last = run(command);
    EXPECT_EQ(last.status, 0) << last.err;
    EXPECT_EQ(last.out, plain);
    EXPECT_EQ(readText(path("t.csv")), triangles);
    EXPECT_THAT(last.err, AllOf(HasSubstr("were there already"), Not(HasSubstr("damaged"))));
}

/// Whoever did them: of a job of many processes each one knows its own.
TEST_F(ChunksTest, ItCountsWhatIsThereAndWaitsForNoPipe) {
    const std::string plain = output(chunked());
    const std::size_t all = chunkFiles().size();
    ASSERT_GT(all, 4U);
    fs::remove(chunkFiles()[1]);
    const fs::path pipe = chunkFiles().back();
    fs::remove(pipe);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const Ran ran = run(chunked());
    EXPECT_EQ(ran.status, 1);
    EXPECT_THAT(ran.err, AllOf(HasSubstr(pipe.string() + "': what is there is not a file"),
                               HasSubstr("; " + std::to_string(all - 1) + " chunks in ")));
    fs::remove(pipe);
    EXPECT_EQ(run(chunked()).out, plain);
    const fs::path manifest = pipe.parent_path() / "voxtact-run.json";
    fs::remove(manifest);
    ASSERT_EQ(::mkfifo(manifest.c_str(), 0600), 0);
    EXPECT_THAT(run(chunked()).err, HasSubstr("voxtact-run.json': it is not a file"));
}

TEST_F(ChunksTest, InterruptedItSaysWhatIsThere) {
    std::string many;
    for (int i = 0; i < 200; ++i) {
        many += readText(path("poses.txt"));
    }
    writeText(path("poses.txt"), many);
    Child child(chunked({"--clearance"}));
    for (int i = 0; i < 60000 && chunkFiles().empty(); ++i) {
        ::usleep(2000);
    }
    child.signal(SIGINT);
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 128 + SIGINT);
    EXPECT_EQ(ran.out, "");
    EXPECT_FALSE(chunkFiles().empty());
    EXPECT_THAT(ran.err, testing::ContainsRegex("[^0-9]" + std::to_string(chunkFiles().size()) + " chunk"));
    EXPECT_THAT(ran.err, HasSubstr("are done, and the same command goes on from there"));
    // Nothing half done is left.
    for (const auto& entry : fs::directory_iterator(path("run"))) {
        EXPECT_FALSE(entry.path().filename().string().starts_with(".tmp")) << entry.path();
    }
}

TEST_F(ChunksTest, MergeSaysWhatIsMissing) {
    for (const char* shard : {"1/3", "3/3"}) {
        output(chunked({"--shard", shard}));
    }
    const std::string line = refused(1, {"merge", path("run"), "--output", path("rows.csv")});
    EXPECT_THAT(line, AllOf(HasSubstr("4 of 12 chunks are missing"), HasSubstr("number 4")));
    EXPECT_FALSE(fs::exists(path("rows.csv")));
    fs::remove(chunkFiles().back());
    EXPECT_THAT(refused(1, {"merge", path("run")}),
                AllOf(HasSubstr("5 of 12 chunks are missing"), HasSubstr("of shard 3/3")));
    fs::create_directory(path("empty"));
    EXPECT_THAT(refused(1, {"merge", path("empty")}), HasSubstr("is no folder of a run"));
    EXPECT_THAT(refused(1, {"merge", path("none")}), HasSubstr("is no folder of a run"));
    EXPECT_THAT(refused(2, {"merge"}), HasSubstr("DIR is required"));
    EXPECT_THAT(refused(2, {"merge", path("run"), "--output", path("run/rows.csv")}), HasSubstr("--output"));
}

TEST_F(ChunksTest, MergeLeavesWhatTheRunHasRead) {
    writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n");
    output({"make", "mesh", "builtin:scalpel:100", path("tool.stl")});
    output({"make", "volume", "builtin:head:18", path("head.nii")});
    output({"detect", "--volume", path("head.nii"), "--mesh", path("tool.stl"), "--poses", path("poses.txt"), "--count",
            "cpu", "--resume", path("run"), "--shard", "1/1"});
    for (const char* name : {"poses.txt", "tool.stl", "head.nii"}) {
        const std::string before = readText(path(name));
        EXPECT_THAT(refused(2, {"merge", path("run"), "--output", path(name)}),
                    AllOf(HasSubstr(name), HasSubstr("that the run reads"), HasSubstr("not overwritten")));
        EXPECT_EQ(readText(path(name)), before);
    }
    output({"merge", path("run"), "--output", path("rows.csv")});
}

TEST_F(ChunksTest, AnotherRunIsRefused) {
    output(chunked());
    const std::size_t files = chunkFiles().size();
    EXPECT_THAT(refused(2, chunked({"--output", path("run/o.csv")})), HasSubstr("in the folder"));
    const auto other = [&](const Arguments& more) { return refused(2, chunked(more)); };
    EXPECT_THAT(other({"--threshold", "0.3"}),
                AllOf(HasSubstr("has another run"), HasSubstr("its --threshold is not given, here it is '0.3'")));
    EXPECT_THAT(other({"--format", "json"}), HasSubstr("its --format is 'csv', here it is 'json'"));
    EXPECT_THAT(other({"--triangles", path("t.csv")}), HasSubstr("its --triangles is not given"));
    EXPECT_THAT(refused(2, detect({"--resume", path("run")})), HasSubstr("its --chunk is '7', here it is '10000'"));
    writeText(path("poses.txt"), readText(path("poses.txt")) + "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_THAT(refused(2, chunked()), HasSubstr("its content of '" + path("poses.txt")));
    EXPECT_EQ(chunkFiles().size(), files) << "nothing is lost";
}

TEST_F(ChunksTest, WhatIsNoFolderOfARunIsRefused) {
    writeText(path("run"), "a file");
    EXPECT_THAT(refused(1, chunked()), HasSubstr("it is a file"));
    fs::remove(path("run"));
    fs::create_directory(path("run"));
    writeText(path("run") + "/notes.txt", "mine");
    EXPECT_THAT(refused(1, chunked()), AllOf(HasSubstr("'notes.txt'"), HasSubstr("is no folder of a run")));
    EXPECT_EQ(std::distance(fs::directory_iterator(path("run")), fs::directory_iterator()), 1);
    fs::remove(path("run") + "/notes.txt");
    EXPECT_EQ(output(chunked()), output(detect())) << "an empty folder is a new one";
    EXPECT_THAT(refused(1, with(detect(), {"--resume", path("no/such")})),
                HasSubstr("the folder '" + path("no") + "' does not exist: make it first"));
}

TEST_F(ChunksTest, TwoProcessesDoNotDoTheSame) {
    output(chunked({"--shard", "1/2"}));
    {
        const HeldLock lock(path("run") + "/run.lock", LOCK_SH);
        EXPECT_THAT(refused(1, chunked()), HasSubstr("other processes do this run"));
        output(chunked({"--shard", "2/2"}));
    }
    {
        const HeldLock lock(path("run") + "/shard-1-of-2.lock", LOCK_EX);
        EXPECT_THAT(refused(1, chunked({"--shard", "1/2"})), HasSubstr("another process does shard 1/2"));
    }
    {
        const HeldLock lock(path("run") + "/run.lock", LOCK_EX);
        EXPECT_THAT(refused(1, chunked({"--shard", "1/2"})), HasSubstr("another process does the whole run"));
    }
    EXPECT_EQ(output({"merge", path("run")}), output(detect()));
    // Really at once.
    removeRun();
    Child one(chunked({"--shard", "1/2"}));
    Child two(chunked({"--shard", "2/2"}));
    EXPECT_EQ(one.end().status, 0);
    EXPECT_EQ(two.end().status, 0);
    EXPECT_EQ(output({"merge", path("run")}), output(detect()));
}

/// The first poses are far away; then every triangle is touched, and a chunk's list of them is long.
TEST_F(ChunksTest, AFullDiskLeavesWhatIsDone) {
    std::string poses;
    for (int i = 0; i < 28; ++i) {
        poses += i < 21 ? "1 0 0 900 0 1 0 0 0 0 1 0 0 0 0 1\n" : "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
    }
    writeText(path("poses.txt"), poses);
    const Arguments command{"detect",      "--volume",        "builtin:sphere:16", "--mesh",  "builtin:ellipsoid:2000",
                            "--poses",     path("poses.txt"), "--count",           "cpu",     "--triangles",
                            path("t.csv"), "--resume",        path("run"),         "--chunk", "7"};
    Child child(command, 8000);
    const Ran full = child.end();
    EXPECT_EQ(full.status, 1);
    EXPECT_EQ(linesOf(full.err).size(), 1U) << full.err;
    EXPECT_THAT(full.err, AllOf(HasSubstr("cannot write"), HasSubstr("too large"), HasSubstr("3 chunks in"),
                                HasSubstr("goes on from there")));
    EXPECT_EQ(chunkFiles(".triangles").size(), 3U);
    const Ran again = run(command);
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_THAT(again.err, HasSubstr("3 chunks of 4"));
    Arguments plain(command.begin(), command.end() - 4);
    const std::string triangles = readText(path("t.csv"));
    EXPECT_EQ(again.out, output(plain));
    EXPECT_EQ(triangles, readText(path("t.csv")));
}

TEST_F(ChunksTest, OptionsThatDoNotFitAreRefused) {
    for (const char* wrong : {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2/3", "-1/2", "1/0", "99999999999/2"}) {
        EXPECT_THAT(refused(2, chunked({"--shard", wrong})), AllOf(HasSubstr("--shard"), HasSubstr("is not I/N")))
            << wrong;
    }
    EXPECT_THAT(refused(2, detect({"--shard", "1/2"})), HasSubstr("--shard: it is about a run in chunks"));
    EXPECT_THAT(refused(2, detect({"--chunk", "9"})), HasSubstr("--chunk: it is about a run in chunks"));
    EXPECT_THAT(refused(2, chunked({"--shard", "1/2", "--output", path("o.csv")})),
                HasSubstr("--output: not with --shard and --resume"));
    EXPECT_THAT(refused(2, chunked({"--output", path("run")})), HasSubstr("--output: not with --resume"));
    EXPECT_THAT(refused(2, chunked({"--chunk", "0"})), HasSubstr("--chunk"));
    EXPECT_THAT(refused(2, chunked({"--format", "text"})), HasSubstr("--format text: not with --resume"));
    EXPECT_THAT(refused(2, chunked({"--timing"})), HasSubstr("--timing: not with --resume"));
    EXPECT_THAT(refused(2, chunked({"--contacts", path("c.csv")})), HasSubstr("--contacts: not with --resume"));
    EXPECT_THAT(refused(2, chunked({"--clearance", "--closest", path("c.ply")})), HasSubstr("--closest: not with"));
    EXPECT_THAT(refused(2, {"detect", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--poses", "-",
                            "--resume", path("run")}),
                HasSubstr("--poses -: not with --resume"));
    EXPECT_THAT(refused(2, {"plan", "--volume", "builtin:head:24", "--target", "0,0,0", "--avoid-opacity",
                            "100:0,160:1", "--shard", "1/2"}),
                HasSubstr("--shard: it is about a run in chunks"));
    EXPECT_FALSE(fs::exists(path("run")));
}

TEST_F(ChunksTest, MemoryDoesNotGrowWithThePoses) {
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
        removeRun();
        Child child({"detect", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--poses", path(name),
                     "--count", "cpu", "--resume", path("run"), "--output", path("rows.csv")});
        child.closeInput();
        const Ran ran = child.end();
        EXPECT_EQ(ran.status, 0) << ran.err;
        const std::string out = readText(path("rows.csv"));
        EXPECT_EQ(static_cast<std::size_t>(std::count(out.begin(), out.end(), '\n')), rows + 1);
        return child.mostMemory();
    };
    const long some = memory("some.txt", 100000);
    const long more = memory("more.txt", 400000);
    EXPECT_LT(more, some + 15000) << "KiB; the rows alone would take 25,000 more";
}

} // namespace
} // namespace voxtact::test

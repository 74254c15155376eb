// SPDX-License-Identifier: MIT
// What becomes of a run in chunks whose files are damaged: its chunks, and its manifest. No device is needed.
#include "chunks_fixture.h"

#include <chrono>
#include <memory>
#include <thread>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class ChunkDamageTest : public ChunksTest {};

TEST_F(ChunkDamageTest, DamagedChunksAreDoneAgain) {
    const std::string plain = output(detect());
    EXPECT_EQ(output(chunked()), plain);
    const std::vector<fs::path> files = chunkFiles();
    ASSERT_EQ(files.size(), 12U);
    const std::string whole = readText(files[5]);
    const std::vector<std::string> damages{
        "", whole.substr(0, whole.size() - 1), whole.substr(0, whole.size() / 2), whole + "x", readText(files[4]), [&] {
            std::string flipped = whole;
            flipped[whole.size() / 2] ^= 1;
            return flipped;
        }()};
    for (const std::string& damage : damages) {
        writeText(files[5], damage);
        writeText(path("rows.csv"), "as it was");
        EXPECT_THAT(refused(1, {"merge", path("run"), "--output", path("rows.csv")}),
                    AllOf(HasSubstr("1 of 12 chunks are damaged"), HasSubstr("number 5")));
        EXPECT_EQ(readText(path("rows.csv")), "as it was");
        const Ran ran = run(chunked());
        EXPECT_EQ(ran.status, 0);
        EXPECT_EQ(ran.out, plain);
        EXPECT_THAT(ran.err, AllOf(HasSubstr("1 chunk in"), HasSubstr("was damaged and done again"),
                                   HasSubstr("11 chunks of 12")));
        EXPECT_EQ(readText(files[5]), whole);
    }
    // Of another run, whole in itself.
    removeRun();
    output(chunked({"--threshold", "0.3"}));
    const std::string other = readText(chunkFiles()[5]);
    removeRun();
    output(chunked());
    writeText(files[5], other);
    EXPECT_THAT(refused(1, {"merge", path("run")}), HasSubstr("1 of 12 chunks are damaged"));
    fs::remove(files[3]);
    fs::remove(files[8]);
    EXPECT_THAT(refused(1, {"merge", path("run")}),
                HasSubstr("1 of 12 chunks are damaged or cannot be read, the first is number 5, and 2 of 12 chunks are "
                          "missing, the first is "
                          "number 3; run the same commands"));
}

TEST_F(ChunkDamageTest, ADamagedManifestIsWrittenAnew) {
    const std::string whole = output(chunked());
    const std::string file = path("run") + "/voxtact-run.json";
    const std::string manifest = readText(file);
    for (const std::string& damage :
         {std::string(), std::string("{}"), manifest.substr(0, manifest.size() / 2), "[" + manifest + "]",
          std::string(manifest).replace(manifest.find("pose,"), 4, "POSE")}) {
        writeText(file, damage);
        EXPECT_THAT(refused(1, {"merge", path("run")}), HasSubstr("is damaged; the command that made it"));
        EXPECT_THAT(refused(1, chunked({"--threshold", "0.3"})), HasSubstr("no chunk there is of this command"));
        EXPECT_EQ(readText(file), damage) << "nothing is written but by the command that made it";
        const Ran ran = run(chunked());
        EXPECT_EQ(ran.status, 0);
        EXPECT_EQ(ran.out, whole);
        EXPECT_THAT(ran.err, AllOf(HasSubstr("was damaged and is written anew"), HasSubstr("were there already")));
        EXPECT_EQ(readText(file), manifest);
        EXPECT_EQ(output({"merge", path("run")}), whole);
    }
    // One that says that it is of another version is this one's all the same where its chunks are.
    std::string other = manifest;
    other.replace(other.find(": 2"), 3, ": 1");
    writeText(file, other);
    EXPECT_THAT(refused(1, {"merge", path("run")}), HasSubstr("is of another version of voxtact; begin anew"));
    EXPECT_EQ(run(chunked()).out, whole);
    EXPECT_EQ(readText(file), manifest);
    for (const fs::path& chunk : chunkFiles()) {
        fs::remove(chunk);
    }
    writeText(file, other);
    EXPECT_THAT(refused(1, chunked()), HasSubstr("is of another version of voxtact; begin anew"));
}

TEST_F(ChunkDamageTest, ADamagedManifestWaitsForOthers) {
    const std::string whole = output(chunked());
    const std::string file = path("run") + "/voxtact-run.json";
    const std::string manifest = readText(file);
    writeText(file, "");
    {
        const HeldLock other(path("run") + "/run.lock", LOCK_SH);
        EXPECT_THAT(refused(1, chunked()), HasSubstr("is damaged, and other processes are at work"));
    }
    auto held = std::make_unique<HeldLock>(path("run") + "/run.lock", LOCK_EX);
    std::thread goes([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        held.reset();
    });
    EXPECT_EQ(run(chunked()).out, whole);
    goes.join();
    // Whoever had the lock has written it meanwhile.
    writeText(file, "");
    held = std::make_unique<HeldLock>(path("run") + "/run.lock", LOCK_SH);
    std::thread writes([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        writeText(file, manifest);
    });
    EXPECT_EQ(run(chunked({"--shard", "1/2"})).status, 0);
    writes.join();
    EXPECT_EQ(readText(file), manifest);
}

} // namespace
} // namespace voxtact::test

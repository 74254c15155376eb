// SPDX-License-Identifier: MIT
#pragma once

#include "cli_fixture.h"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace voxtact::test {

/// A file that holds an flock() as another process would.
class HeldLock {
  public:
    HeldLock(const std::string& path, int how) : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
        EXPECT_EQ(::flock(file_, how | LOCK_NB), 0);
    }
    HeldLock(const HeldLock&) = delete;
    HeldLock& operator=(const HeldLock&) = delete;
    ~HeldLock() { ::close(file_); }

  private:
    int file_;
};

/// A run of `detect` in chunks, and the same without.
class ChunksTest : public CliTest {
  protected:
    /// 40 poses, some of which touch.
    void SetUp() override {
        output({"make", "poses", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--number", "40",
                "--seed", "7", "--output", path("poses.txt")});
    }
    [[nodiscard]] Arguments detect(const Arguments& more = {}) const {
        return with({"detect", "--volume", "builtin:head:24", "--mesh", "builtin:scalpel:200", "--mesh",
                     "builtin:ellipsoid:100", "--poses", path("poses.txt"), "--count", "cpu", "--threads", "1"},
                    more);
    }
    [[nodiscard]] Arguments chunked(const Arguments& more = {}) const {
        return with(detect({"--resume", path("run"), "--chunk", "7"}), more);
    }
    static Arguments with(Arguments all, const Arguments& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Files of chunks that are there under their names.
    [[nodiscard]] std::vector<std::filesystem::path> chunkFiles(const std::string& ending = ".output") const {
        std::vector<std::filesystem::path> files;
        std::error_code problem;
        for (std::filesystem::directory_iterator entry(path("run"), problem), end; !problem && entry != end;
             entry.increment(problem)) {
            if (entry->path().extension() == ending && !entry->path().filename().string().starts_with(".")) {
                files.push_back(entry->path());
            }
        }
        std::sort(files.begin(), files.end());
        return files;
    }
    void removeRun() const { std::filesystem::remove_all(path("run")); }
    /// The merged rows of the run by so many shards, the last of which comes first.
    [[nodiscard]] std::string byShards(const Arguments& command, int shards, const Arguments& merge = {}) const {
        removeRun();
        for (int shard = shards; shard >= 1; --shard) {
            EXPECT_EQ(output(with(command, {"--resume", path("run"), "--chunk", "7", "--shard",
                                            std::to_string(shard) + "/" + std::to_string(shards)})),
                      "");
        }
        return output(with({"merge", path("run")}, merge));
    }
};

} // namespace voxtact::test

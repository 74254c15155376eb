// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace voxtact::test {

using Arguments = std::vector<std::string>;

struct RunOptions {
    std::map<std::string, std::string> environment{}; ///< set in addition to the tests' own
    std::string output{};                             ///< a file for standard output: /dev/full. Empty: captured
    bool closedPipe = false;                          ///< standard output is a pipe that nobody reads
    bool keepExisting = false;                        ///< without --force, which an output that exists gets here
    std::string program{};                            ///< a copy of the program; empty: the built one
    std::string note{};                               ///< for output(): what the only note says; empty: there is none
};

struct Ran {
    int status = -1; ///< exit status; -1 when a signal ended it
    std::string out;
    std::string err;
};

/// For a process that becomes the program. What is measured is kept in a folder of this build and not in the user's; of
/// Mesa's compiled shaders, which change no answer and take seconds each, there is one store for all tests.
void setCaches();

/// With --force where an output exists.
Arguments withForce(Arguments arguments);
/// The path of the built program.
std::string builtProgram();
/// Runs the built program and waits for it.
Ran run(const Arguments& arguments, const RunOptions& options = {});

/// Standard error without the lines that say how far the program is: one for each minute that a run takes, which a slow
/// machine may add to any.
std::string withoutProgress(const std::string& err);

std::vector<std::string> linesOf(const std::string& text);
/// Fields without quotes only.
std::vector<std::string> fieldsOf(const std::string& line);
/// Of CSV: by the names of its first line.
std::vector<std::map<std::string, std::string>> rowsOf(const std::string& text);
std::string readText(const std::filesystem::path& path);
void writeText(const std::filesystem::path& path, const std::string& text);

/// A file of the cache folder, as the program writes it: a line with size and XXH3 sum before the content.
std::string sealed(const std::string& content);

/// A NIfTI-1 file, written by hand: sizes as in its header, `type` and `bits` as the standard numbers them, and so
/// many bytes of voxels, all `value`.
struct HandNifti {
    std::array<std::int16_t, 8> sizes{3, 8, 8, 8, 1, 1, 1, 1};
    std::int16_t type = 2; ///< uint8
    std::int16_t bits = 8;
    std::size_t bytes = 512;
    char value = 0;
};
void writeNifti(const std::filesystem::path& path, const HandNifti& nifti);

/// A folder of its own for each test, removed afterwards.
class CliTest : public testing::Test {
  protected:
    CliTest();
    ~CliTest() override;

    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::size_t filesInFolder() const;

    /// The refusal that the contract asks for: the status, nothing on standard output, one line on standard error
    /// (and progress) that begins with "voxtact COMMAND: ". Returns that line.
    static std::string refused(int status, const Arguments& arguments, const RunOptions& options = {});
    /// A good run: status 0, and nothing on standard error but progress and RunOptions::note. Returns standard output.
    static std::string output(const Arguments& arguments, const RunOptions& options = {});

  private:
    std::filesystem::path folder_;
};

/// Tests that need a device: without one they fail, or are skipped where the build says that none is required.
class CliDeviceTest : public CliTest {
  protected:
    void SetUp() override;

    /// detect on a small head with a scalpel, and what is added; by query unless that says otherwise.
    static Arguments detect(const Arguments& more = {});
    /// `count` poses in a file.
    [[nodiscard]] std::string poses(int count) const;
};

} // namespace voxtact::test

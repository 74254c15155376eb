// SPDX-License-Identifier: MIT
#include "failing_reads.h"
#include "io_test_support.h"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;

Result<void> writeNew(std::ostream& stream) {
    stream << "new " << 1234567 << ' ' << 0.5;
    return {};
}

TEST(WriteFile, ReplacesAndLeavesNothingBehind) {
    const TemporaryFolder folder;
    const auto path = folder.write("a.csv", "old");
    ASSERT_TRUE(isOk(io::writeFile(path, writeNew)));
    EXPECT_EQ(contentOf(path), "new 1234567 0.5");
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(WriteFile, FailureLeavesTheOldFile) {
    const TemporaryFolder folder;
    const auto path = folder.write("a.csv", "old");
    expectRefused(io::writeFile(path,
                                [](std::ostream& stream) -> Result<void> {
                                    stream << "half";
                                    return Error{ErrorCode::File, 0, "changed my mind"};
                                }),
                  "changed my mind");
    const auto thrown = io::writeFile(path, [](std::ostream&) -> Result<void> { throw std::runtime_error("thrown"); });
    expectRefused(thrown, "thrown");
    EXPECT_EQ(contentOf(path), "old");
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(WriteFile, NamesWhatIsWrongWithTheFolder) {
    const TemporaryFolder folder;
    const auto path = folder / "absent" / "y.csv";
    const auto result = io::writeFile(path, writeNew);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().text,
              "cannot write '" + path.string() + "': the folder '" + path.parent_path().string() + "' does not exist");
    EXPECT_EQ(result.error().code, ErrorCode::File);
    folder.write("file", "");
    expectRefused(io::writeFile(folder / "file" / "y.csv", writeNew), "is not a folder");
    expectRefused(io::writeFile(folder.path(), writeNew), "it is a folder, not a file");
    expectRefused(io::writeFile(folder.path() / "", writeNew), "it is a folder, not a file");
}

TEST(WriteFile, FollowsLinksAndKeepsPermissions) {
    const TemporaryFolder folder;
    const auto path = folder.write("a.csv", "old");
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
    const fs::perms before = fs::status(path).permissions();
    fs::create_symlink(path, folder / "link.csv");
    ASSERT_TRUE(isOk(io::writeFile(folder / "link.csv", writeNew)));
    EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
    EXPECT_EQ(contentOf(path), "new 1234567 0.5");
    EXPECT_EQ(fs::status(path).permissions(), before);
}

TEST(WriteFile, LongNames) {
    const TemporaryFolder folder;
    const auto path = folder / (std::string(251, 'a') + ".csv");
    ASSERT_TRUE(isOk(io::writeFile(path, writeNew)));
    EXPECT_EQ(contentOf(path), "new 1234567 0.5");
}

TEST(WriteFile, DevicesAreWrittenToAndNotReplaced) {
    if (!fs::is_character_file("/dev/full")) {
        GTEST_SKIP() << "no /dev/full";
    }
    expectRefused(io::writeFile("/dev/full", writeNew), "cannot write '/dev/full': No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(OutputFile, IsThereOnceItIsCommitted) {
    const TemporaryFolder folder;
    const auto path = folder.write("a.csv", "old");
    {
        Result<io::OutputFile> file = io::OutputFile::create(path);
        ASSERT_TRUE(isOk(file));
        file->stream() << "given up" << std::flush;
        EXPECT_EQ(contentOf(path), "old");
    }
    EXPECT_EQ(contentOf(path), "old");
    EXPECT_EQ(folder.entries(), 1U);
    Result<io::OutputFile> file = io::OutputFile::create(path);
    ASSERT_TRUE(isOk(file));
    file->stream() << "new " << 0.5;
    ASSERT_TRUE(isOk(file->close()));
    EXPECT_EQ(contentOf(path), "old");
    ASSERT_TRUE(isOk(file->commit()));
    EXPECT_EQ(contentOf(path), "new 0.5");
    EXPECT_EQ(folder.entries(), 1U);
}

/// Of a folder: "a" and "b" with what is said, and "c" new.
class SeveralFiles : public testing::Test {
  protected:
    void make() {
        for (const char* const name : {"a", "b", "c"}) {
            files_.push_back(take(io::OutputFile::create(folder_ / name)));
            files_.back().stream() << "new " << name;
        }
    }
    Result<void> commitAll(bool backwards = false) {
        std::vector<io::OutputFile*> all;
        for (io::OutputFile& file : files_) {
            all.insert(backwards ? all.begin() : all.end(), &file);
        }
        Result<void> done = io::OutputFile::commitAll(all);
        files_.clear();
        return done;
    }
    static io::OutputFile take(Result<io::OutputFile> file) {
        EXPECT_TRUE(isOk(file));
        return std::move(*file);
    }

    TemporaryFolder folder_;
    fs::path a_ = folder_.write("a", "old a");
    fs::path b_ = folder_.write("b", "old b");
    std::vector<io::OutputFile> files_;
};

TEST_F(SeveralFiles, AllGetTheirNames) {
    make();
    ASSERT_TRUE(isOk(commitAll()));
    EXPECT_EQ(contentOf(a_), "new a");
    EXPECT_EQ(contentOf(b_), "new b");
    EXPECT_EQ(contentOf(folder_ / "c"), "new c");
    EXPECT_EQ(folder_.entries(), 3U);
}

TEST_F(SeveralFiles, KeepPermissionsWhereThereAreNoLinks) {
    const FailingLinks links;
    for (const fs::path& path : {a_, b_}) {
        fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
    }
    make();
    ASSERT_TRUE(isOk(commitAll()));
    for (const fs::path& path : {a_, b_}) {
        EXPECT_EQ(contentOf(path), "new " + path.filename().string());
        EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    }
    EXPECT_EQ(folder_.entries(), 3U);
}

TEST_F(SeveralFiles, OrNoneWhereThereAreNoLinks) {
    const FailingLinks links;
    make();
    fs::create_directory(folder_ / "c");
    expectRefused(commitAll(), std::generic_category().message(EISDIR), folder_ / "c");
    EXPECT_EQ(contentOf(a_), "old a");
    EXPECT_EQ(contentOf(b_), "old b");
    EXPECT_EQ(folder_.entries(), 3U);
}

TEST_F(SeveralFiles, OrNone) {
    // Whichever cannot be put in its place: a folder is there by now.
    for (const auto& [blocked, backwards] :
         {std::pair("a", false), {"b", false}, {"c", false}, {"a", true}, {"b", true}, {"c", true}}) {
        make();
        const fs::path place = folder_ / blocked;
        fs::remove(place);
        fs::create_directory(place);
        expectRefused(commitAll(backwards), std::generic_category().message(EISDIR), place);
        fs::remove(place);
        for (const char* const name : {"a", "b"}) {
            if (std::string(name) != blocked) {
                EXPECT_EQ(contentOf(folder_ / name), std::string("old ") + name);
            }
        }
        EXPECT_FALSE(fs::exists(folder_ / "c"));
        EXPECT_EQ(folder_.entries(), std::string(blocked) == "c" ? 2U : 1U);
        static_cast<void>(folder_.write("a", "old a"));
        static_cast<void>(folder_.write("b", "old b"));
    }
}

TEST(OutputFile, SaysTheFirstReason) {
    if (!fs::is_character_file("/dev/full")) {
        GTEST_SKIP() << "no /dev/full";
    }
    Result<io::OutputFile> file = io::OutputFile::create("/dev/full");
    ASSERT_TRUE(isOk(file));
    file->stream() << std::string(1U << 20U, 'x');
    errno = EINVAL; // what comes later is not the reason
    expectRefused(file->commit(), "cannot write '/dev/full': No space left on device");
    // A writer that notices the stream's failure, and does not know why.
    expectRefused(io::writeFile("/dev/full",
                                [](std::ostream& stream) -> Result<void> {
                                    stream << std::string(1U << 20U, 'x');
                                    return stream ? Result<void>() : Error{ErrorCode::File, 0, "it stopped"};
                                }),
                  "No space left on device");
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
// What --count auto measures, and where it is kept.
#include "cli_fixture.h"

#include <sys/stat.h>

#include <algorithm>
#include <optional>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kNote = "voxtact: note: auto chose ";

class CacheTest : public CliDeviceTest {
  protected:
    /// A cache folder of the test's own. What Mesa keeps is still shared: compiling takes seconds.
    [[nodiscard]] RunOptions own() const { return {.environment = {{"XDG_CACHE_HOME", path("xdg")}}}; }
    [[nodiscard]] fs::path folder() const { return path("xdg/voxtact"); }

    static Arguments automatic(const Arguments& more = {}) {
        // Measured are the methods of the projections that all of them do.
        Arguments all{"--count", "auto", "--projection", "view"};
        all.insert(all.end(), more.begin(), more.end());
        return detect(all);
    }
    /// The method that the rows name.
    static std::string methodOf(const Ran& ran) {
        EXPECT_EQ(ran.status, 0) << ran.err;
        const auto lines = linesOf(ran.out);
        return lines.size() == 2 ? fieldsOf(lines[1]).at(6) : "";
    }
    [[nodiscard]] Ran runOwn(const Arguments& more = {}) const { return run(automatic(more), own()); }

    static std::vector<fs::path> filesOf(const fs::path& folder, const std::string& prefix) {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder, ignored)) {
            if (entry.path().filename().string().starts_with(prefix)) {
                files.push_back(entry.path());
            }
        }
        return files;
    }
    /// The only file with measured speeds.
    [[nodiscard]] fs::path speeds() const {
        const auto files = filesOf(folder(), "speeds-");
        EXPECT_EQ(files.size(), 1U);
        return files.empty() ? fs::path() : files.front();
    }
};

TEST_F(CacheTest, MeasuredOnce) {
    const Ran first = runOwn();
    const std::string method = methodOf(first);
    EXPECT_THAT(first.err, AllOf(StartsWith(kNote + method + ": "), HasSubstr(" pairs/s"), HasSubstr("--count")));
    EXPECT_EQ(linesOf(first.err).size(), 1U);
    EXPECT_NE(method, "query-any");
    const Ran second = runOwn();
    EXPECT_EQ(second.err, "");
    EXPECT_EQ(second.out, first.out);
    EXPECT_THAT(speeds().filename().string(), testing::EndsWith("-default"));
    // Other filters are other measurements.
    const Ran hardware = runOwn({"--filter", "hardware"});
    EXPECT_THAT(hardware.err, AllOf(StartsWith(kNote + methodOf(hardware)), testing::Not(HasSubstr("cpu"))));
    EXPECT_EQ(runOwn({"--filter", "hardware"}).err, "");
    EXPECT_EQ(filesOf(folder(), "speeds-").size(), 2U);
}

TEST_F(CacheTest, DevicesSaysWhatAutoTakes) {
    const auto lines = linesOf(output({"devices", "--format", "csv"}, own()));
    const std::string method = methodOf(run(automatic(), own()));
    EXPECT_EQ(runOwn().err, "") << "devices has measured";
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.find("," + method + ",1,1,") != std::string::npos && line.ends_with(",1");
    }));
    EXPECT_EQ(linesOf(output({"devices", "--format", "csv"}, own())), lines);
}

TEST_F(CacheTest, DamagedAndForeignFilesAreReplaced) {
    const std::string method = methodOf(runOwn());
    const fs::path file = speeds();
    const std::string good = readText(file);
    std::string json = good.substr(good.find('\n') + 1);
    EXPECT_EQ(sealed(json), good);
    std::string otherMachine = json;
    otherMachine.insert(otherMachine.find("\"processors\": ") + 14, "9");
    std::string noMethods = json.substr(0, json.find("\"methods\"")) + "\"methods\": []}";
    std::string flipped = good;
    flipped[flipped.size() / 2] ^= 1;
    for (const std::string& bad : {std::string(), std::string("nonsense"), good.substr(0, good.size() / 2), flipped,
                                   sealed("{}"), sealed("[1"), sealed(otherMachine), sealed(noMethods)}) {
        writeText(file, bad);
        const Ran ran = runOwn();
        EXPECT_FALSE(methodOf(ran).empty());
        EXPECT_THAT(ran.err, StartsWith(kNote)) << bad;
        EXPECT_EQ(linesOf(ran.err).size(), 1U) << ran.err;
        EXPECT_EQ(readText(file).substr(0, 14), "voxtact cache ") << "replaced";
    }
    EXPECT_EQ(runOwn().err, "");
    EXPECT_EQ(filesOf(folder(), "").size(), 1U + filesOf(folder(), "pipelines-").size()) << "nothing is left over";
}

TEST_F(CacheTest, APipeInTheirPlaceIsNotWaitedFor) {
    methodOf(runOwn());
    const fs::path file = speeds();
    fs::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_FALSE(methodOf(runOwn()).empty());
    EXPECT_TRUE(fs::is_fifo(file));
}

TEST_F(CacheTest, PipelinesOfOthersAreNotUsed) {
    methodOf(runOwn());
    std::string name = speeds().filename().string();
    name.replace(0, std::string("speeds").size(), "pipelines");
    name.resize(name.size() - std::string("-default").size());
    const std::string foreign = std::string("\x20\0\0\0\1\0\0\0", 8) + std::string(24, '\x5a') + std::string(999, 'x');
    const std::string expected = output(detect(), own());
    for (const std::string& blob : {std::string("nonsense"), sealed(""), sealed("short"), sealed(foreign)}) {
        writeText(folder() / name, blob);
        EXPECT_EQ(output(detect(), own()), expected);
        EXPECT_EQ(output(detect({"--validate"}), own()), expected);
    }
}

TEST_F(CacheTest, OffAndFoldersThatCannotBe) {
    writeText(path("file"), "as it was");
    const Arguments off = automatic({"--cache", "off"});
    for (int i = 0; i < 2; ++i) {
        const Ran ran = run(off, own());
        EXPECT_FALSE(methodOf(ran).empty());
        EXPECT_THAT(ran.err, StartsWith(kNote));
    }
    const RunOptions nowhere{
        .environment = {{"HOME", ""}, {"XDG_CACHE_HOME", "relative"}, {"MESA_SHADER_CACHE_DISABLE", "true"}}};
    for (const Ran& ran : {run(automatic(), nowhere), run(automatic({"--cache", "/proc/no/such"})),
                           run(automatic({"--cache", path("file")}))}) {
        EXPECT_FALSE(methodOf(ran).empty());
        EXPECT_THAT(ran.err, StartsWith(kNote));
        EXPECT_EQ(linesOf(ran.err).size(), 1U) << ran.err;
    }
    EXPECT_EQ(readText(path("file")), "as it was");
    EXPECT_EQ(filesInFolder(), 1U);
}

TEST_F(CacheTest, AFolderOfTheUsersChoice) {
    EXPECT_THAT(run(automatic({"--cache", path("a/b")}), own()).err, StartsWith(kNote));
    EXPECT_EQ(filesOf(path("a/b"), "speeds-").size(), 1U);
    EXPECT_EQ(run(automatic({"--cache", path("a/b")}), own()).err, "");
    EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(CacheTest, WhoNamesADeviceOrValidatesGetsADevice) {
    for (const Arguments& more : {Arguments{"--device", "0"}, Arguments{"--validate"}}) {
        EXPECT_NE(methodOf(run(automatic(more))), "cpu");
    }
    // What the validation layer slows down is not remembered.
    EXPECT_THAT(runOwn({"--validate"}).err, StartsWith(kNote));
    EXPECT_THAT(filesOf(folder(), "speeds-"), IsEmpty());
}

} // namespace
} // namespace voxtact::test

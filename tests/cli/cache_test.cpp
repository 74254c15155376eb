// SPDX-License-Identifier: MIT
// --method auto with options that ask for a device, and where pipelines are kept.
#include "cli/options/cache_folder.h"
#include "cli/options/open_session.h"
#include "cli_fixture.h"

#include <sys/stat.h>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;

class CacheTest : public CliDeviceTest {
  protected:
    /// A cache folder of the test's own. What Mesa keeps is still shared: compiling takes seconds.
    [[nodiscard]] RunOptions own() const { return {.environment = {{"XDG_CACHE_HOME", path("xdg")}}}; }
    [[nodiscard]] fs::path folder() const { return path("xdg/voxtact"); }

    static std::vector<fs::path> filesOf(const fs::path& folder) {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder, ignored)) {
            files.push_back(entry.path());
        }
        return files;
    }
    /// Where pipelines are kept. lavapipe, whose cache is a header alone, writes none: its folder is made here.
    [[nodiscard]] fs::path pipelines() const {
        app::DeviceChoice choice;
        choice.cache = "off";
        const auto session = app::openSession(choice);
        fs::create_directories(folder());
        return session.ok() ? folder() / ("pipelines-" + app::cacheKey(session->device.physical())) : fs::path();
    }
};

TEST_F(CacheTest, AutoTakesADeviceWhereAnOptionAsksForOne) {
    const auto methodOf = [](const Arguments& more) { return rowsOf(output(detect(more))).at(0).at("method"); };
    for (const Arguments& asked : {Arguments{"--device", "0"}, Arguments{"--validate"}}) {
        for (const auto& [projection, method] : {std::pair("certified", "compute"), std::pair("view", "query")}) {
            Arguments all{"--method", "auto", "--projection", projection};
            all.insert(all.end(), asked.begin(), asked.end());
            EXPECT_EQ(methodOf(all), method) << asked.front();
        }
    }
    EXPECT_EQ(methodOf({"--method", "auto", "--filter", "hardware"}), "query");
    EXPECT_EQ(methodOf({"--method", "auto"}), "cpu");
}

TEST_F(CacheTest, PipelinesOfOthersAreNotUsed) {
    const std::string expected = output(detect(), own());
    const fs::path file = pipelines();
    const std::string foreign = std::string("\x20\0\0\0\1\0\0\0", 8) + std::string(24, '\x5a') + std::string(999, 'x');
    std::string flipped = sealed(foreign);
    flipped[flipped.size() / 2] ^= 1;
    for (const std::string& blob : {std::string(), std::string("nonsense"), sealed(foreign).substr(0, 500), flipped,
                                    sealed(""), sealed("short"), sealed(foreign)}) {
        writeText(file, blob);
        EXPECT_EQ(output(detect(), own()), expected);
        EXPECT_EQ(output(detect({"--validate"}), own()), expected);
    }
    EXPECT_EQ(filesOf(folder()).size(), 1U) << "nothing is left over";
}

TEST_F(CacheTest, APipeInTheirPlaceIsNotWaitedFor) {
    const std::string expected = output(detect(), own());
    const fs::path file = pipelines();
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_EQ(output(detect(), own()), expected);
    EXPECT_TRUE(fs::is_fifo(file));
}

TEST_F(CacheTest, OffAndFoldersThatCannotBe) {
    writeText(path("file"), "as it was");
    const std::string expected = output(detect({"--cache", "off"}), own());
    EXPECT_FALSE(fs::exists(folder()));
    const RunOptions nowhere{
        .environment = {{"HOME", ""}, {"XDG_CACHE_HOME", "relative"}, {"MESA_SHADER_CACHE_DISABLE", "true"}}};
    EXPECT_EQ(output(detect(), nowhere), expected);
    for (const std::string& cache : {std::string("/proc/no/such"), path("file")}) {
        EXPECT_EQ(output(detect({"--cache", cache})), expected);
    }
    EXPECT_EQ(readText(path("file")), "as it was");
    EXPECT_EQ(filesInFolder(), 1U);
}

} // namespace
} // namespace voxtact::test

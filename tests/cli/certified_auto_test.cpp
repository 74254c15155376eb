// SPDX-License-Identifier: MIT
// Whom --count auto asks in the projection conservative, on a machine that calls its device a GPU.
#include "app/detect/certified_speed.h"
#include "cli_fixture.h"

#include <nlohmann/json.hpp>

#include <regex>
#include <thread>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kNote = "voxtact: note: auto chose ";

class CertifiedAutoTest : public CliDeviceTest {
  protected:
    /// A GPU, as far as the program can tell, and a cache folder of the test's own.
    [[nodiscard]] RunOptions gpu() const {
        return {.environment = {{"XDG_CACHE_HOME", path("xdg")},
                                {"VK_ADD_LAYER_PATH", VOXTACT_TEST_LAYERS},
                                {"VK_INSTANCE_LAYERS", "VK_LAYER_VOXTACT_gpu"}}};
    }
    [[nodiscard]] Arguments detect(const Arguments& more) const {
        Arguments all{"detect",  "--volume",       "builtin:head:30", "--mesh", "builtin:scalpel:500",
                      "--poses", path("poses.txt")};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// The method that all rows name.
    static std::string methodOf(const std::string& csv) {
        const auto lines = linesOf(csv);
        std::string method;
        for (std::size_t i = 1; i < lines.size(); ++i) {
            const std::string of = fieldsOf(lines[i]).at(6);
            EXPECT_TRUE(method.empty() || of == method);
            method = of;
        }
        return method;
    }
    /// Rows without their method.
    static std::string answers(const std::string& csv) {
        return std::regex_replace(csv, std::regex(",(cpu|compute),conservative"), "");
    }
    [[nodiscard]] std::vector<fs::path> measured() const {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(path("xdg/voxtact"), ignored)) {
            if (entry.path().filename().string().starts_with("speeds-")) {
                files.push_back(entry.path());
            }
        }
        std::sort(files.begin(), files.end());
        return files;
    }
    /// Measures, and then remembers that compute is so much faster than the host, or that it is not trusted.
    void remember(const Arguments& asked, double times, bool trusted = true) const {
        ASSERT_EQ(run(detect(asked), gpu()).status, 0);
        ASSERT_EQ(measured().size(), 1U);
        const std::string text = readText(measured().front());
        auto json = nlohmann::ordered_json::parse(text.substr(text.find('\n') + 1));
        auto& methods = json.at("methods");
        methods.at(0).at("pairs_per_s") = times * methods.at(1).at("pairs_per_s").get<double>();
        methods.at(0).at("trusted") = trusted;
        writeText(measured().front(), sealed(json.dump(1) + "\n"));
    }
};

TEST_F(CertifiedAutoTest, FewPairsAreTheHostsAndNoDeviceIsAsked) {
    static_cast<void>(poses(1023));
    EXPECT_EQ(methodOf(output(detect({}), gpu())), "cpu");
    EXPECT_TRUE(measured().empty());
    EXPECT_EQ(methodOf(output(detect({"--device", "0"}), gpu())), "compute") << "who names a device wants it used";
}

TEST_F(CertifiedAutoTest, ManyAreMeasuredOnce) {
    static_cast<void>(poses(1024));
    for (const Arguments& asked : {Arguments{}, Arguments{"--answer", "yes-no"}}) {
        const Ran first = run(detect(asked), gpu());
        ASSERT_EQ(first.status, 0) << first.err;
        const std::string method = methodOf(first.out);
        EXPECT_THAT(first.err, AllOf(StartsWith(kNote + method + ": "),
                                     HasSubstr(method == "cpu" ? "; compute " : "; cpu "), HasSubstr(" pairs/s")));
        EXPECT_EQ(linesOf(first.err).size(), 1U);
        EXPECT_EQ(output(detect(asked), gpu()), first.out) << "remembered";
    }
    ASSERT_EQ(measured().size(), 2U) << "a count and yes or no are two questions";
    EXPECT_THAT(measured()[0].filename().string(), testing::EndsWith("-conservative"));
    EXPECT_THAT(measured()[1].filename().string(), testing::EndsWith("-conservative-yes-no"));
}

TEST_F(CertifiedAutoTest, TheFasterOneAnswers) {
    static_cast<void>(poses(1024));
    remember({}, 1.01);
    const std::string byDevice = output(detect({}), gpu());
    EXPECT_EQ(methodOf(byDevice), "compute");
    EXPECT_EQ(answers(byDevice), answers(output(detect({"--count", "cpu"}))));
    remember({}, 0.99);
    EXPECT_EQ(methodOf(output(detect({}), gpu())), "cpu");
    const bool oneProcessor = std::thread::hardware_concurrency() < 2;
    EXPECT_EQ(methodOf(output(detect({"--threads", "1"}), gpu())), oneProcessor ? "cpu" : "compute")
        << "the host was measured with all its processors";
    remember({}, 100, false);
    EXPECT_EQ(methodOf(output(detect({}), gpu())), "cpu") << "compute is not trusted";
}

TEST_F(CertifiedAutoTest, AMeasurementOfOthersIsMadeAnew) {
    static_cast<void>(poses(1024));
    remember({}, 1.01);
    const std::string text = readText(measured().front());
    auto json = nlohmann::ordered_json::parse(text.substr(text.find('\n') + 1));
    std::swap(json.at("methods").at(0), json.at("methods").at(1));
    writeText(measured().front(), sealed(json.dump(1) + "\n"));
    EXPECT_THAT(run(detect({}), gpu()).err, StartsWith(kNote));
    EXPECT_EQ(run(detect({}), gpu()).err, "");
}

/// Processes that share a run must choose alike, whatever each would measure.
TEST_F(CertifiedAutoTest, ARunInChunksGoesOnAsItBegan) {
    static_cast<void>(poses(1024));
    const Arguments first = detect({"--resume", path("run"), "--chunk", "400", "--shard", "1/2"});
    const Arguments second = detect({"--resume", path("run"), "--chunk", "400", "--shard", "2/2"});
    const RunOptions noDriver{
        .environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
    EXPECT_EQ(run(first, noDriver).status, 0);
    const Ran onGpu = run(second, gpu());
    EXPECT_EQ(onGpu.status, 0) << onGpu.err;
    EXPECT_EQ(output({"merge", path("run")}), output(detect({"--count", "cpu"})));
    EXPECT_TRUE(measured().empty());
    // And the other way round: what began on a GPU needs one.
    EXPECT_EQ(run(detect({"--resume", path("other"), "--shard", "1/2"}), gpu()).status, 0);
    EXPECT_THAT(refused(1, detect({"--resume", path("other"), "--shard", "2/2"}), noDriver),
                AllOf(HasSubstr("no Vulkan device"), HasSubstr("other' was begun by compute")));
    EXPECT_EQ(run(detect({"--resume", path("other"), "--shard", "2/2"}), gpu()).status, 0);
    EXPECT_EQ(methodOf(output({"merge", path("other")})), "compute");
}

TEST(OtherAnswers, AreCounted) {
    const auto answer = [](bool hit, std::uint64_t count, Exactness exactness = Exactness::Exact) {
        return PairAnswer{.hit = hit, .count = count, .exactness = exactness};
    };
    PairAnswer possible = answer(false, 0);
    possible.possible = true;
    const std::vector host{answer(true, 7), answer(false, 0), answer(true, 9, Exactness::LowerBound), possible};
    EXPECT_EQ(app::otherAnswers(host, host), "");
    std::vector device = host;
    device[2].count = 8; // of a lower bound
    EXPECT_EQ(app::otherAnswers(device, host), "");
    device[0].count = 8;
    EXPECT_EQ(app::otherAnswers(device, host), "answers 1 of 4 pairs otherwise than cpu");
    device[1].hit = true;
    device[3].possible = false;
    EXPECT_EQ(app::otherAnswers(device, host), "answers 3 of 4 pairs otherwise than cpu");
    EXPECT_EQ(app::otherAnswers({}, host), "answers 4 of 4 pairs otherwise than cpu");
}

} // namespace
} // namespace voxtact::test

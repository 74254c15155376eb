// SPDX-License-Identifier: MIT
// voxtact count --method cpu, and the host standing in for a device. No Vulkan driver is there.
#include "cli_fixture.h"

#include <nlohmann/json.hpp>

#include <array>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

class HostTest : public CliTest {
  protected:
    static Arguments detect(const Arguments& more) {
        Arguments all{"count", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] std::string poses(int count) const {
        std::string file = path("poses.txt");
        output({"make", "poses", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--number",
                std::to_string(count), "--seed", "7", "--output", file});
        return file;
    }

    const RunOptions noDriver_{
        .environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
};

TEST_F(HostTest, CountsWithoutADriver) {
    const auto lines = linesOf(output(detect({"--method", "cpu"}), noDriver_));
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], "pose,mesh,volume,touch,count,count_exact,method,projection");
    EXPECT_THAT(lines[1], MatchesRegex("0,builtin:scalpel:500,builtin:head:30,1,[1-9][0-9]*,1,cpu,certified"));
}

/// glibc fills what malloc gives out and takes back with a byte and its complement: a mesh beside the volume is a
/// certain miss whatever they are, and the rows are the same.
TEST_F(HostTest, FarPosesAreMissesWhateverMemoryHeld) {
    constexpr std::array<std::array<const char*, 3>, 4> kPlaces{
        {{"1000", "0", "0"}, {"0", "-500", "300"}, {"1e6", "1e6", "1e6"}, {"0", "0", "-1e30"}}};
    std::string text;
    for (const auto& [x, y, z] : kPlaces) {
        text += std::string("0.5 0 0.866025 ") + x + " 0 1 0 " + y + " -0.866025 0 0.5 " + z + " 0 0 0 1\n";
    }
    writeText(path("far.txt"), text);
    for (const char* fill : {"0", "1", "85", "128", "170", "255"}) {
        const RunOptions dirty{.environment = {{"MALLOC_PERTURB_", fill},
                                               {"VK_ICD_FILENAMES", "/nonexistent"},
                                               {"VK_DRIVER_FILES", "/nonexistent"}}};
        const Ran ran = run(detect({"--method", "cpu", "--poses", path("far.txt")}), dirty); // a note: all are far
        ASSERT_EQ(ran.status, 0) << ran.err;
        const auto lines = linesOf(ran.out);
        ASSERT_EQ(lines.size(), kPlaces.size() + 1);
        for (std::size_t pose = 0; pose < kPlaces.size(); ++pose) {
            EXPECT_EQ(lines[pose + 1],
                      std::to_string(pose) + ",builtin:scalpel:500,builtin:head:30,0,0,1,cpu,certified")
                << "filled with " << fill;
        }
    }
}

TEST_F(HostTest, CountsWithoutALoader) {
    const Arguments inView{"--method", "cpu", "--projection", "view"};
    const std::string withDriver = output(detect(inView));
    writeText(path("libvulkan.so.1"), "");
    writeText(path("libvulkan.so"), "");
    const RunOptions noLoader{.environment = {{"LD_LIBRARY_PATH", path("")}}};
    EXPECT_EQ(output(detect(inView), noLoader), withDriver);
    EXPECT_EQ(output(detect({"--projection", "view"}), noLoader), withDriver);
    EXPECT_THAT(refused(1, detect({"--method", "query"}), noLoader),
                AllOf(HasSubstr("libvulkan1"), HasSubstr("mesa-vulkan-drivers")));
}

TEST_F(HostTest, BatchesOfAnySizeGiveTheSameRows) {
    const Arguments arguments = detect(
        {"--method", "cpu", "--mesh", "builtin:ellipsoid:500", "--volume", "builtin:ct:32", "--poses", poses(50)});
    const std::string all = output(arguments, noDriver_);
    EXPECT_EQ(linesOf(all).size(), 201U);
    EXPECT_THAT(linesOf(all).back(), StartsWith("49,builtin:ellipsoid:500,builtin:ct:32,"));
    for (const char* batch : {"1", "7", "50", "51", "4294967295"}) {
        Arguments cut = arguments;
        cut.insert(cut.end(), {"--batch", batch});
        EXPECT_EQ(output(cut, noDriver_), all) << batch;
    }
}

TEST_F(HostTest, TimingHasNoDeviceTime) {
    const auto lines = linesOf(output(detect({"--method", "cpu", "--poses", poses(20), "--timing"}), noDriver_));
    ASSERT_EQ(lines.size(), 22U);
    EXPECT_EQ(lines.front(), "pose,mesh,volume,touch,count,count_exact,method,projection,gpu_ms,wall_ms");
    for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
        const auto fields = fieldsOf(lines[i]);
        EXPECT_EQ(fields.at(8), "0");
        EXPECT_GT(std::stod(fields.at(9)), 0);
    }
    EXPECT_THAT(lines.back(), MatchesRegex("# pairs=20 wall_ms=[0-9.e-]+ pairs_per_s=[0-9.e+]+"));
}

TEST_F(HostTest, JsonNamesTheHost) {
    const auto json = nlohmann::json::parse(output(detect({"--method", "cpu", "--format", "json"}), noDriver_));
    EXPECT_EQ(json.at("device"), "host");
    EXPECT_THAT(json.at("driver").get<std::string>(), StartsWith("cpu, "));
}

TEST_F(HostTest, WhatItCannotDo) {
    const auto bad = [&](const Arguments& more) {
        Arguments all = detect({"--method", "cpu"});
        all.insert(all.end(), more.begin(), more.end());
        return refused(2, all, noDriver_);
    };
    EXPECT_THAT(bad({"--filter", "hardware"}), HasSubstr("--filter hardware: the host engine"));
    EXPECT_THAT(bad({"--validate"}), HasSubstr("--validate: the host engine"));
    EXPECT_THAT(bad({"--projection", "view", "--size", "99999x5"}),
                AllOf(HasSubstr("--size: 99999x5"), HasSubstr("16384x16384")));
    EXPECT_THAT(bad({"--tf-size", "4000000000"}), HasSubstr("--tf-size"));
    EXPECT_EQ(output(detect({"--method", "cpu", "--filter", "exact"}), noDriver_),
              output(detect({"--method", "cpu"}), noDriver_));
}

TEST_F(HostTest, ADeviceIsNotLookedFor) {
    const Ran ran = run(detect({"--method", "cpu", "--device", "4711"}), noDriver_);
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("note: --device 4711 is not used"));
    EXPECT_THAT(linesOf(ran.out).at(1), HasSubstr(",cpu,"));
}

TEST_F(HostTest, AutoIsTheHost) {
    const std::string many = poses(1024);
    for (const Arguments& asked :
         {Arguments{"--poses", many}, Arguments{"--projection", "view"}, Arguments{"--filter", "exact"}}) {
        Arguments byHost = asked;
        byHost.insert(byHost.end(), {"--method", "cpu"});
        EXPECT_EQ(output(detect(asked)), output(detect(byHost), noDriver_)) << "with a driver or without";
    }
}

TEST_F(HostTest, WhoNeedsADeviceIsToldThatThereIsNone) {
    for (const Arguments& more :
         {Arguments{"--method", "query"}, Arguments{"--method", "compute"}, Arguments{"--device", "0"},
          Arguments{"--filter", "hardware"}, Arguments{"--method", "auto", "--filter", "hardware"}}) {
        EXPECT_THAT(refused(1, detect(more), noDriver_), HasSubstr("mesa-vulkan-drivers"));
    }
    EXPECT_EQ(run(detect({"--validate"}), noDriver_).status, 1);
}

} // namespace
} // namespace voxtact::test

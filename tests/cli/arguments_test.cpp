// SPDX-License-Identifier: MIT
// What the program says of its arguments. No device is needed.
#include "cli_fixture.h"

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

class ArgumentsTest : public CliTest {
  protected:
    /// detect, with an argument that must be refused.
    static std::string badDetect(const Arguments& more) {
        Arguments all{"detect", "--volume", "builtin:head:16", "--mesh", "builtin:scalpel:500"};
        all.insert(all.end(), more.begin(), more.end());
        return refused(2, all);
    }
};

TEST_F(ArgumentsTest, Version) {
    const auto lines = linesOf(output({"--version"}));
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_THAT(lines[0], MatchesRegex("voxtact [0-9]+\\.[0-9]+\\.[0-9]+"));
    EXPECT_THAT(lines[1], MatchesRegex("git revision (unknown|[0-9a-f]{12,40}(-dirty)?)"));
    EXPECT_THAT(lines[2], MatchesRegex("Vulkan headers 1\\.[0-9]+\\.[0-9]+"));
    EXPECT_THAT(lines[3], MatchesRegex("glslang [0-9]+\\.[0-9]+.*"));
}

TEST_F(ArgumentsTest, HelpOfEverythingHasAnExample) {
    const std::vector<Arguments> commands{
        {}, {"detect"}, {"devices"}, {"make"}, {"make", "mesh"}, {"make", "volume"}, {"make", "poses"}};
    for (Arguments command : commands) {
        command.push_back("--help");
        EXPECT_THAT(output(command), HasSubstr("Example")) << testing::PrintToString(command);
    }
}

TEST_F(ArgumentsTest, CommandsThatAreNot) {
    EXPECT_THAT(refused(2, {}), HasSubstr("a command is needed"));
    EXPECT_THAT(refused(2, {"detekt"}), HasSubstr("unknown command 'detekt'"));
    EXPECT_THAT(refused(2, {"make"}), AllOf(HasSubstr("voxtact make: "), HasSubstr("a command is needed")));
    EXPECT_THAT(refused(2, {"make", "tea"}), HasSubstr("unknown command 'tea'"));
}

TEST_F(ArgumentsTest, UnknownOptionsNameTheHelp) {
    EXPECT_THAT(badDetect({"--treshold", "0.2"}),
                AllOf(HasSubstr("voxtact detect: unknown argument '--treshold'"), HasSubstr("voxtact detect --help")));
    EXPECT_THAT(badDetect({"--labels", "x.nii"}), HasSubstr("'--labels'"));
    EXPECT_THAT(badDetect({"left-over"}), HasSubstr("'left-over'"));
    EXPECT_THAT(refused(2, {"devices", "--poses", "x"}), HasSubstr("voxtact devices: unknown argument '--poses'"));
    EXPECT_THAT(refused(2, {"--nonsense"}), HasSubstr("voxtact: unknown argument '--nonsense'"));
}

TEST_F(ArgumentsTest, WhatIsRequired) {
    EXPECT_THAT(refused(2, {"detect", "--mesh", "builtin:scalpel"}), HasSubstr("--volume is required"));
    EXPECT_THAT(refused(2, {"detect", "--volume", "builtin:head"}), HasSubstr("--mesh is required"));
    EXPECT_THAT(refused(2, {"make", "mesh", "builtin:scalpel"}), HasSubstr("OUTPUT is required"));
}

TEST_F(ArgumentsTest, NamesNobodyKnowsAndNamesOfOtherVersions) {
    EXPECT_THAT(badDetect({"--count", "fingers"}),
                AllOf(HasSubstr("'fingers' is not known"),
                      HasSubstr("query, query-any, atomic, subgroup, compute, cpu, auto")));
    for (const char* projection : {"two-view", "dominant-axis", "conservative"}) {
        EXPECT_THAT(badDetect({"--projection", projection}),
                    AllOf(HasSubstr("not in this version"), HasSubstr("view")));
    }
    EXPECT_THAT(badDetect({"--filter", "nearest"}), AllOf(HasSubstr("nearest"), HasSubstr("hardware, exact")));
    EXPECT_THAT(badDetect({"--boundary", "wrap"}), HasSubstr("auto, range, clamp"));
    EXPECT_THAT(badDetect({"--format", "xml"}), HasSubstr("csv, json, text"));
    EXPECT_THAT(badDetect({"--progress", "always"}), HasSubstr("auto, never"));
    EXPECT_THAT(badDetect({"--mesh-space", "lpi"}), HasSubstr("lps, ras"));
}

TEST_F(ArgumentsTest, NumbersThatCannotBeUsed) {
    for (const char* size : {"0x0", "0x5", "5x0", "512", "512X512", "-1x5", "5x", "x5", "5x5x5", "99999999999x5", ""}) {
        EXPECT_THAT(badDetect({"--size", size}), HasSubstr("--size")) << size;
    }
    for (const char* threshold : {"-0.1", "1.1", "nan", "inf", "x", "0.1x", ""}) {
        EXPECT_THAT(badDetect({"--threshold", threshold}), HasSubstr("--threshold")) << threshold;
    }
    for (const char* domain : {"5:5", "5:1", "5", "a:b", "0:inf", ":", ""}) {
        EXPECT_THAT(badDetect({"--tf-domain", domain}), HasSubstr("--tf-domain")) << domain;
    }
    for (const char* whole : {"0", "-1", "1.5", "x", "99999999999", ""}) {
        EXPECT_THAT(badDetect({"--batch", whole}), HasSubstr("--batch")) << whole;
    }
    EXPECT_THAT(badDetect({"--tf-size", "1"}), HasSubstr("--tf-size"));
    EXPECT_THAT(badDetect({"--mesh-scale", "0"}), HasSubstr("--mesh-scale"));
    EXPECT_THAT(badDetect({"--threshold", "0.1", "--threshold", "0.2"}), HasSubstr("--threshold"));
}

TEST_F(ArgumentsTest, EmptyPathsAreNotTheDefault) {
    for (const char* option : {"--poses", "--camera", "--transfer-function", "--output", "--device", "--cache"}) {
        EXPECT_THAT(badDetect({option, ""}), HasSubstr(option));
    }
    EXPECT_THAT(badDetect({"--mesh", ""}), HasSubstr("--mesh"));
    EXPECT_THAT(badDetect({"--opacity", ""}), HasSubstr("--opacity"));
}

TEST_F(ArgumentsTest, OpacityOnTheCommandLine) {
    EXPECT_THAT(badDetect({"--opacity", "0:0,100:1.5"}), AllOf(HasSubstr("--opacity"), HasSubstr("1.5")));
    EXPECT_THAT(badDetect({"--opacity", "0:-0.5"}), HasSubstr("-0.5"));
    EXPECT_THAT(badDetect({"--opacity", "100:0,50:1"}), AllOf(HasSubstr("50"), HasSubstr("ascend")));
    EXPECT_THAT(badDetect({"--opacity", "nonsense"}), HasSubstr("value:opacity"));
    EXPECT_THAT(badDetect({"--opacity", "0:0", "--transfer-function", "x.tf"}),
                AllOf(HasSubstr("--opacity"), HasSubstr("--transfer-function")));
}

TEST_F(ArgumentsTest, BuiltinsThatAreNot) {
    EXPECT_THAT(refused(2, {"detect", "--volume", "builtin:brain", "--mesh", "builtin:scalpel"}),
                AllOf(HasSubstr("brain"), HasSubstr("head"), HasSubstr("sphere")));
    EXPECT_THAT(refused(2, {"detect", "--volume", "builtin:head:16", "--mesh", "builtin:scalpel:3069"}),
                AllOf(HasSubstr("3068"), HasSubstr("3070")));
    EXPECT_THAT(refused(2, {"make", "mesh", "scalpel", path("x.stl")}), HasSubstr("builtin:"));
}

TEST_F(ArgumentsTest, NoDeviceNamesTheDriverPackage) {
    const RunOptions none{.environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
    for (const Arguments& arguments :
         {Arguments{"detect", "--volume", "builtin:head:16", "--mesh", "builtin:scalpel:500", "--count", "query"},
          Arguments{"devices"}}) {
        EXPECT_THAT(refused(1, arguments, none), AllOf(HasSubstr("mesa-vulkan-drivers"), HasSubstr("lavapipe")));
    }
}

TEST_F(ArgumentsTest, NoLoaderNamesItsPackage) {
    // Empty files in the way: the loader's library is found, and cannot be loaded.
    writeText(path("libvulkan.so.1"), "");
    writeText(path("libvulkan.so"), "");
    EXPECT_THAT(refused(1, {"devices"}, {.environment = {{"LD_LIBRARY_PATH", path("")}}}), HasSubstr("libvulkan1"));
}

TEST_F(ArgumentsTest, NoValidationLayerNamesItsPackage) {
    const Ran ran = run({"devices", "--validate"}, {.environment = {{"VK_LAYER_PATH", path("")}}});
    EXPECT_EQ(ran.status, 1);
    EXPECT_THAT(ran.err, HasSubstr("vulkan-validationlayers"));
}

} // namespace
} // namespace voxtact::test

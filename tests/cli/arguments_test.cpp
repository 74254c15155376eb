// SPDX-License-Identifier: MIT
// What the program says of its arguments. No device is needed.
#include "cli_fixture.h"

#include <sstream>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

class ArgumentsTest : public CliTest {
  protected:
    /// detect, with an argument that must be refused.
    static std::string badDetect(const Arguments& more) {
        Arguments all{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500"};
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
    const std::vector<Arguments> commands{{},       {"touch"},        {"count"},          {"distance"},
                                          {"area"}, {"motion"},       {"devices"},        {"info"},
                                          {"make"}, {"make", "mesh"}, {"make", "volume"}, {"make", "poses"}};
    for (Arguments command : commands) {
        command.push_back("--help");
        EXPECT_THAT(output(command), HasSubstr("Example")) << testing::PrintToString(command);
    }
}

/// Returns the commands that a help text lists.
std::vector<std::string> commandsIn(const std::string& help) {
    std::vector<std::string> commands;
    const std::size_t list = help.find("Subcommands:\n");
    std::istringstream lines(list == std::string::npos ? "" : help.substr(list));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line) && !line.empty();) {
        std::string& command = commands.emplace_back();
        std::istringstream(line) >> command;
    }
    return commands;
}

TEST_F(ArgumentsTest, HelpFitsAScreen) {
    constexpr std::size_t kMaxLines = 45;
    constexpr std::size_t kMaxColumns = 80;
    std::vector<Arguments> commands{{}};
    for (std::size_t i = 0; i < commands.size(); ++i) {
        Arguments asked = commands[i];
        asked.push_back("--help");
        const Ran ran = run(asked);
        if (ran.err.find("is not in the folder of this program") != std::string::npos) {
            continue; // a build without the window or the measurements
        }
        const std::string& help = ran.out;
        const auto lines = linesOf(help);
        EXPECT_FALSE(lines.empty()) << ran.err;
        EXPECT_LE(lines.size(), kMaxLines) << testing::PrintToString(asked);
        for (const std::string& line : lines) {
            EXPECT_LE(line.size(), kMaxColumns) << testing::PrintToString(asked) << line;
        }
        for (const std::string& command : commandsIn(help)) {
            commands.push_back(commands[i]);
            commands.back().push_back(command);
        }
    }
    EXPECT_EQ(commands.size(), 18U);
}

TEST_F(ArgumentsTest, HelpIsACommand) {
    EXPECT_EQ(output({"help"}), output({"--help"}));
    EXPECT_EQ(output({"help", "touch"}), output({"touch", "--help"}));
    EXPECT_EQ(output({"help", "make", "mesh"}), output({"make", "mesh", "--help"}));
    EXPECT_THAT(refused(2, {"help", "tuch"}), HasSubstr("unknown command 'tuch', did you mean touch?"));
}

TEST_F(ArgumentsTest, SpacesInCapitals) {
    output({"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--mesh-space", "LPS"});
    EXPECT_THAT(badDetect({"--mesh-space", "LPI"}), HasSubstr("lps, ras"));
}

TEST_F(ArgumentsTest, CommandsThatAreNot) {
    EXPECT_THAT(refused(2, {}), HasSubstr("no command"));
    EXPECT_THAT(refused(2, {"detekt"}), HasSubstr("unknown command 'detekt'"));
    EXPECT_THAT(refused(2, {"make"}), AllOf(HasSubstr("voxtact make: "), HasSubstr("no command")));
    EXPECT_THAT(refused(2, {"make", "tea"}), HasSubstr("unknown command 'tea'"));
}

TEST_F(ArgumentsTest, UnknownOptionsNameTheHelp) {
    EXPECT_THAT(badDetect({"--treshold", "0.2"}),
                AllOf(HasSubstr("voxtact count: unknown argument '--treshold'"), HasSubstr("voxtact count --help")));
    EXPECT_THAT(badDetect({"--label", "x.nii"}), HasSubstr("'--label'"));
    EXPECT_THAT(badDetect({"left-over"}), HasSubstr("'left-over'"));
    EXPECT_THAT(refused(2, {"devices", "--poses", "x"}), HasSubstr("voxtact devices: unknown argument '--poses'"));
    EXPECT_THAT(refused(2, {"--nonsense"}), HasSubstr("voxtact: unknown argument '--nonsense'"));
}

TEST_F(ArgumentsTest, WhatIsRequired) {
    EXPECT_THAT(refused(2, {"count", "--mesh", "builtin:scalpel"}), HasSubstr("--volume is required"));
    EXPECT_THAT(refused(2, {"count", "--volume", "builtin:head"}), HasSubstr("--mesh is required"));
    EXPECT_THAT(refused(2, {"make", "mesh", "builtin:scalpel"}), HasSubstr("OUTPUT is required"));
}

TEST_F(ArgumentsTest, NamesNobodyKnows) {
    EXPECT_THAT(
        badDetect({"--method", "fingers"}),
        AllOf(HasSubstr("'fingers' is unknown"), HasSubstr("query, query-any, atomic, subgroup, compute, cpu, auto")));
    EXPECT_THAT(badDetect({"--projection", "sideways"}),
                AllOf(HasSubstr("'sideways' is unknown"), HasSubstr("view, two-view, dominant-axis, certified")));
    EXPECT_THAT(badDetect({"--filter", "nearest"}), AllOf(HasSubstr("nearest"), HasSubstr("hardware, exact")));
    EXPECT_THAT(badDetect({"--boundary", "wrap"}), HasSubstr("auto, range, clamp"));
    EXPECT_THAT(badDetect({"--format", "xml"}), HasSubstr("csv, json, text"));
    EXPECT_THAT(badDetect({"--progress", "always"}), HasSubstr("auto, never"));
    EXPECT_THAT(badDetect({"--mesh-space", "lpi"}), HasSubstr("lps, ras"));
}

TEST_F(ArgumentsTest, ProjectionsAndWhatGoesWithThem) {
    for (const char* method : {"query", "query-any", "atomic", "subgroup"}) {
        EXPECT_THAT(badDetect({"--projection", "certified", "--method", method}),
                    AllOf(HasSubstr(std::string("--method ") + method), HasSubstr("compute, cpu or auto")));
    }
    EXPECT_THAT(badDetect({"--projection", "certified", "--filter", "hardware"}), HasSubstr("--filter hardware: "));
    EXPECT_THAT(badDetect({"--boundary", "clamp"}), HasSubstr("--boundary clamp: --projection certified"));
    for (const char* projection : {"certified", "dominant-axis"}) {
        EXPECT_THAT(badDetect({"--projection", projection, "--size", "256x256"}),
                    AllOf(HasSubstr("--size: "), HasSubstr(projection), HasSubstr("--projection view")));
        EXPECT_THAT(badDetect({"--projection", projection, "--camera", "x.txt"}),
                    AllOf(HasSubstr("--camera: "), HasSubstr(projection)));
    }
    EXPECT_THAT(badDetect({"--size", "256x256"}), AllOf(HasSubstr("--size: "), HasSubstr("certified")));
    EXPECT_THAT(badDetect({"--samples-per-voxel", "2"}),
                AllOf(HasSubstr("--samples-per-voxel: "), HasSubstr("dominant-axis"), HasSubstr("certified")));
    EXPECT_THAT(badDetect({"--method", "query", "--resolution", "0.5"}),
                AllOf(HasSubstr("--resolution: "), HasSubstr("view")));
    for (const char* samples : {"0", "17", "1.5", ""}) {
        EXPECT_THAT(badDetect({"--projection", "dominant-axis", "--samples-per-voxel", samples}),
                    AllOf(HasSubstr("--samples-per-voxel"), HasSubstr("1 to 16")));
    }
    for (const char* resolution : {"0", "1.1", "0.0001", "nan", ""}) {
        EXPECT_THAT(badDetect({"--resolution", resolution}), HasSubstr("--resolution"));
    }
}

TEST_F(ArgumentsTest, OutputsBesideTheCounts) {
    EXPECT_THAT(badDetect({"--contacts", path("c.txt")}),
                AllOf(HasSubstr("--contacts: "), HasSubstr(".csv, .ply, .vtp or .mrk.json")));
    EXPECT_THAT(badDetect({"--contacts", path("c")}), HasSubstr("--contacts: "));
    EXPECT_THAT(badDetect({"--max-depth", "3"}), AllOf(HasSubstr("--max-depth: "), HasSubstr("--contacts")));
    EXPECT_THAT(badDetect({"--max-contacts", "3"}), AllOf(HasSubstr("--max-contacts: "), HasSubstr("--contacts")));
    EXPECT_THAT(badDetect({"--label-names", "x"}), AllOf(HasSubstr("--label-names: "), HasSubstr("--labels")));
    for (const char* depth : {"0", "-1", "inf", "x"}) {
        EXPECT_THAT(badDetect({"--contacts", path("c.csv"), "--max-depth", depth}), HasSubstr("--max-depth"));
    }
    for (const char* most : {"0", "-1", "4294967296"}) {
        EXPECT_THAT(badDetect({"--contacts", path("c.csv"), "--max-contacts", most}), HasSubstr("--max-contacts"));
    }
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(ArgumentsTest, OneFileForTwoOutputs) {
    const std::string file = path("x.csv");
    const std::string same = path("./x.csv");
    EXPECT_THAT(badDetect({"--output", file, "--contacts", same}),
                AllOf(HasSubstr("--output and --contacts: both are"), HasSubstr("x.csv")));
    EXPECT_THAT(badDetect({"--triangles", file, "--contacts", same}), HasSubstr("--triangles and --contacts: "));
    EXPECT_THAT(badDetect({"--triangles", file, "--output", file}), HasSubstr("--output and --triangles: "));
    writeText(file, "as it was");
    std::filesystem::create_symlink(file, path("link.csv"));
    EXPECT_THAT(badDetect({"--triangles", file, "--contacts", path("link.csv")}), HasSubstr("both are"));
    EXPECT_EQ(readText(file), "as it was");
}

TEST_F(ArgumentsTest, NumbersThatCannotBeUsed) {
    for (const char* size : {"0x0", "0x5", "5x0", "512", "512X512", "-1x5", "5x", "x5", "5x5x5", "99999999999x5", ""}) {
        EXPECT_THAT(badDetect({"--size", size}), HasSubstr("--size")) << size;
    }
    for (const char* threshold : {"-0.1", "1.1", "nan", "inf", "x", "0.1x", ""}) {
        EXPECT_THAT(badDetect({"--opacity-threshold", threshold}), HasSubstr("--opacity-threshold")) << threshold;
    }
    for (const char* domain : {"5:5", "5:1", "5", "a:b", "0:inf", ":", ""}) {
        EXPECT_THAT(badDetect({"--tf-domain", domain}), HasSubstr("--tf-domain")) << domain;
    }
    EXPECT_THAT(badDetect({"--tf-domain", "-1e308:1e308"}),
                AllOf(HasSubstr("--tf-domain"), HasSubstr("-1e+308:1e+308 is too wide")));
    for (const char* whole : {"0", "-1", "1.5", "x", "99999999999", ""}) {
        EXPECT_THAT(badDetect({"--batch", whole}), HasSubstr("--batch")) << whole;
    }
    EXPECT_THAT(badDetect({"--tf-size", "1"}), HasSubstr("--tf-size"));
    EXPECT_THAT(badDetect({"--mesh-scale", "0"}), HasSubstr("--mesh-scale"));
    EXPECT_THAT(badDetect({"--opacity-threshold", "0.1", "--opacity-threshold", "0.2"}),
                HasSubstr("--opacity-threshold"));
}

TEST_F(ArgumentsTest, WhatIsOneIsNotGivenTwice) {
    const std::vector<std::pair<Arguments, Arguments>> cases{
        {{"touch", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:200"}, {"--uncertainty", "1,2"}},
        {{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:200"}, {"--shard", "1/2"}},
        {{"render", "--volume", "builtin:head:18", "--output", path("x.png")}, {"--slice", "axial"}},
        {{"render", "--volume", "builtin:head:18", "--output", path("x.png"), "--slice", "axial"},
         {"--window", "-1:2"}},
        {{"plan", "--volume", "builtin:head:18", "--target", "0,0,0"}, {"--tip", "-1,2,3"}},
        {{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:200"}, {"--threads", "1"}},
        {{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:200"}, {"--output", "-"}}};
    for (const auto& [command, twice] : cases) {
        Arguments all = command;
        all.insert(all.end(), twice.begin(), twice.end());
        all.insert(all.end(), twice.begin(), twice.end());
        EXPECT_THAT(refused(2, all),
                    HasSubstr(": " + twice[0] + " is given twice; leave out all but one; see voxtact " + command[0] +
                              " --help"));
    }
}

/// Where the current folder is gone, a path says so.
TEST_F(ArgumentsTest, NoCurrentFolder) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::create_directory(path("gone"));
    std::filesystem::current_path(path("gone"));
    std::filesystem::remove(path("gone"));
    const std::string text = refused(1, {"make", "mesh", "builtin:scalpel:200", "x.stl"});
    const std::string rows = refused(1, {"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:200",
                                         "--method", "cpu", "--output", "x.csv"});
    std::filesystem::current_path(before);
    EXPECT_THAT(text, AllOf(HasSubstr("'x.stl'"), HasSubstr("voxtact make")));
    EXPECT_THAT(rows, HasSubstr("x.csv"));
}

TEST_F(ArgumentsTest, EmptyPathsAreNotTheDefault) {
    for (const char* option : {"--poses", "--camera", "--transfer-function", "--output", "--device", "--cache",
                               "--triangles", "--contacts", "--labels", "--label-names"}) {
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
    EXPECT_THAT(refused(2, {"count", "--volume", "builtin:brain", "--mesh", "builtin:scalpel"}),
                AllOf(HasSubstr("brain"), HasSubstr("head"), HasSubstr("sphere")));
    EXPECT_THAT(refused(2, {"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:3069"}),
                AllOf(HasSubstr("3068"), HasSubstr("3070")));
    EXPECT_THAT(refused(2, {"make", "mesh", "scalpel", path("x.stl")}), HasSubstr("builtin:"));
}

TEST_F(ArgumentsTest, NoDeviceNamesTheDriverPackage) {
    const RunOptions none{.environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
    for (const Arguments& arguments :
         {Arguments{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--method", "query"},
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

TEST_F(ArgumentsTest, ProgramsBesideThisOneAreStartedByName) {
    const Ran help = run({"bench", "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("--latency"));
    EXPECT_THAT(run({"help", "compare"}).out, HasSubstr("--oracle"));
    EXPECT_THAT(run({"help", "compar"}).err, HasSubstr("did you mean compare?"));

    RunOptions alone;
    alone.program = path("voxtact");
    std::filesystem::copy_file(builtProgram(), alone.program);
    EXPECT_THAT(refused(1, {"bench", "--help"}, alone),
                HasSubstr("voxtact-bench: is not in the folder of this program"));
}

} // namespace
} // namespace voxtact::test

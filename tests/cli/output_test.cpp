// SPDX-License-Identifier: MIT
// Where the rows go and what they look like there.
#include "cli_fixture.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace voxtact::test {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class OutputTest : public CliDeviceTest {};

std::string jsonText(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

std::vector<std::string> wordsOf(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) {
        words.push_back(word);
    }
    return words;
}

TEST_F(OutputTest, FormatsAgree) {
    const std::string file = poses(30);
    const auto csv = linesOf(output(detect({"--poses", file, "--format", "csv"})));
    const auto text = linesOf(output(detect({"--poses", file, "--format", "text"})));
    const Json json = Json::parse(output(detect({"--poses", file, "--format", "json"})));
    ASSERT_EQ(csv.size(), 31U);
    ASSERT_EQ(text.size(), 31U);
    ASSERT_EQ(json.at("rows").size(), 30U);
    const auto columns = fieldsOf(csv[0]);
    EXPECT_EQ(wordsOf(text[0]), columns);
    for (std::size_t row = 0; row < 30; ++row) {
        const auto fields = fieldsOf(csv[row + 1]);
        auto words = wordsOf(text[row + 1]);
        EXPECT_EQ(words.at(3), fields.at(3) == "1" ? "yes" : "no");
        words[3] = fields[3];
        EXPECT_EQ(words, fields);
        for (std::size_t column = 0; column < columns.size(); ++column) {
            const std::string expected = column == 3 ? (fields[3] == "1" ? "yes" : "no") : fields[column];
            EXPECT_EQ(jsonText(json["rows"][row].at(columns[column])), expected) << columns[column];
        }
    }
}

TEST_F(OutputTest, JsonSaysWhatItCameFrom) {
    const Json json = Json::parse(output(detect({"--format", "json", "--timing"})));
    EXPECT_TRUE(json.at("device").is_string());
    EXPECT_TRUE(json.at("driver").is_string());
    EXPECT_THAT(output({"--version"}), HasSubstr("voxtact " + json.at("voxtact").get<std::string>() + "\n"));
    EXPECT_EQ(json.at("timing").at("pairs"), 1);
    EXPECT_GT(json.at("timing").at("wall_ms").get<double>(), 0);
    EXPECT_GT(json.at("timing").at("pairs_per_s").get<double>(), 0);
    EXPECT_TRUE(json.at("rows").at(0).contains("gpu_ms"));
    EXPECT_GT(json.at("rows").at(0).at("wall_ms").get<double>(), 0);
}

TEST_F(OutputTest, JsonHasStats) {
    const Json json = Json::parse(output(detect({"--format", "json", "--stats", "--timing", "--method", "compute"})));
    EXPECT_GE(json.at("stats").at("clusters"), 1);
    EXPECT_EQ(json.at("stats").size(), 24U);
    EXPECT_EQ(json.at("timing").at("pairs"), 1);
}

TEST_F(OutputTest, TextIsAligned) {
    const auto lines = linesOf(output({"count", "--volume", "builtin:head:30", "--volume", "builtin:sphere:32",
                                       "--mesh", "builtin:scalpel:500", "--poses", poses(12), "--format", "text"}));
    const std::size_t at = lines.at(0).find("method");
    for (const std::string& line : lines) {
        EXPECT_EQ(line.at(at - 1), ' ');
        EXPECT_NE(line.at(at), ' ');
    }
}

TEST_F(OutputTest, NamesWithCommasAreQuoted) {
    const std::string name = path("a,\"b\".stl");
    output({"make", "mesh", "builtin:scalpel:500", name});
    const std::string text = output({"count", "--volume", "builtin:head:30", "--mesh", name});
    EXPECT_THAT(text, HasSubstr(",\"" + path("a,\"\"b\"\".stl") + "\","));
    const Json json = Json::parse(output({"count", "--volume", "builtin:head:30", "--mesh", name, "--format", "json"}));
    EXPECT_EQ(json["rows"][0]["mesh"], name);
}

TEST_F(OutputTest, TextHasNoControlCharacters) {
    const std::string name = path("a\x1b[31m\xff.stl");
    output({"make", "mesh", "builtin:scalpel:500", name});
    const auto as = [&](const char* format) {
        return output({"count", "--volume", "builtin:head:30", "--mesh", name, "--method", "cpu", "--format", format});
    };
    EXPECT_THAT(as("text"), HasSubstr("a\\x1b[31m\\xff.stl "));
    EXPECT_THAT(as("csv"), HasSubstr(name + ","));
}

TEST_F(OutputTest, FileHoldsWhatStandardOutputWould) {
    EXPECT_EQ(output(detect({"--output", path("out.csv")})), "");
    EXPECT_EQ(readText(path("out.csv")), output(detect()));
    EXPECT_EQ(filesInFolder(), 1U) << "no temporary file is left";
    output(detect({"--output", path("out.csv"), "--format", "json"}));
    EXPECT_THAT(readText(path("out.csv")), StartsWith("{"));
}

TEST_F(OutputTest, FolderThatDoesNotExist) {
    const std::string file = path("no/folder/out.csv");
    for (const Arguments& arguments : {detect({"--output", file}), Arguments{"devices", "--output", file},
                                       Arguments{"make", "mesh", "builtin:scalpel:500", path("no/folder/out.stl")},
                                       Arguments{"make", "volume", "builtin:head:18", path("no/folder/out.nii")},
                                       Arguments{"make", "poses", "--volume", "builtin:head:18", "--mesh",
                                                 "builtin:scalpel:500", "--output", file}}) {
        EXPECT_THAT(refused(1, arguments), AllOf(HasSubstr(path("no/folder")), HasSubstr("does not exist")));
    }
    EXPECT_THAT(refused(1, detect({"--output", path("")})), HasSubstr("folder"));
}

/// Before anything is read, let alone counted.
TEST_F(OutputTest, NameThatIsTooLong) {
    writeText(path("no.nii"), "no volume");
    const std::string file = path(std::string(300, 'a') + ".csv");
    EXPECT_THAT(refused(1, {"count", "--volume", path("no.nii"), "--mesh", "builtin:scalpel:500", "--output", file}),
                AllOf(HasSubstr("cannot write '" + file), HasSubstr("too long")));
}

TEST_F(OutputTest, NothingIsWrittenOnFailure) {
    writeText(path("out.csv"), "as it was");
    refused(2, detect({"--output", path("out.csv"), "--size", "99999x99999"}));
    refused(2, detect({"--output", path("out.csv"), "--device", "4711"}));
    refused(1, {"count", "--volume", path("no.nii"), "--mesh", "builtin:scalpel:500", "--output", path("out.csv")});
    EXPECT_EQ(readText(path("out.csv")), "as it was");
    EXPECT_EQ(filesInFolder(), 1U);
}

TEST_F(OutputTest, WhatExistsIsKept) {
    writeText(path("out.csv"), "as it was");
    std::filesystem::create_symlink(path("out.csv"), path("link.csv"));
    const RunOptions keep{.keepExisting = true};
    const std::vector<Arguments> all{detect({"--output", path("out.csv")}),
                                     detect({"--output", path("link.csv")}),
                                     detect({"--contacts", path("out.csv")}),
                                     {"info", "builtin:head:16", "--output", path("out.csv")},
                                     {"make", "mesh", "builtin:scalpel:500", path("out.csv")}};
    for (const Arguments& arguments : all) {
        EXPECT_THAT(refused(2, arguments, keep), AllOf(HasSubstr("exists"), HasSubstr("--force")));
    }
    EXPECT_EQ(readText(path("out.csv")), "as it was");
    output(detect({"--output", path("out.csv"), "--force"}), keep);
    EXPECT_THAT(readText(path("out.csv")), HasSubstr("pose,mesh"));
    output(detect({"--output", path("new.csv")}), keep);
}

TEST_F(OutputTest, StandardOutputThatCannotBeWritten) {
    for (const Arguments& arguments : {detect(), Arguments{"devices"}, Arguments{"--version"}, Arguments{"--help"}}) {
        EXPECT_THAT(refused(1, arguments, {.output = "/dev/full"}), HasSubstr("standard output"));
        const Ran ended = run(arguments, {.closedPipe = true}); // as by `| head`
        EXPECT_EQ(ended.status, 0);
        EXPECT_EQ(withoutProgress(ended.err), "");
    }
    EXPECT_THAT(refused(1, detect({"--output", "/dev/full"})), HasSubstr("/dev/full"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

} // namespace
} // namespace voxtact::test

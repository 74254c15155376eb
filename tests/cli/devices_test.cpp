// SPDX-License-Identifier: MIT
// voxtact devices.
#include "cli_fixture.h"

#include <nlohmann/json.hpp>

#include <set>

namespace voxtact::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class DevicesTest : public CliDeviceTest {};

/// Nothing for a device that cannot be used.
std::string jsonMethod(const Json& row) {
    return row.at("method").is_null() ? "" : row.at("method").get<std::string>();
}

TEST_F(DevicesTest, EveryMethodOfEveryDeviceHasAVerdict) {
    const Json rows = Json::parse(output({"devices", "--format", "json"})).at("rows");
    ASSERT_FALSE(rows.empty());
    std::set<std::pair<int, std::string>> methods;
    std::set<int> defaults;
    for (const Json& row : rows) {
        EXPECT_FALSE(row.at("name").get<std::string>().empty());
        EXPECT_FALSE(row.at("driver").get<std::string>().empty());
        EXPECT_THAT(row.at("api").get<std::string>(), testing::MatchesRegex("1\\.[0-9]+\\.[0-9]+"));
        EXPECT_FALSE(row.at("verdict").get<std::string>().empty());
        EXPECT_LE(row.at("trusted").get<int>(), row.at("available").get<int>());
        EXPECT_TRUE(methods.emplace(row.at("index"), jsonMethod(row)).second) << "listed twice";
        if (row.at("default") == 1) {
            defaults.insert(row.at("index").get<int>());
            EXPECT_GT(row.at("subgroup_size").get<int>(), 0);
        }
    }
    ASSERT_EQ(defaults.size(), 1U);
    for (const char* method : {"query", "query-any", "atomic", "cpu"}) {
        EXPECT_EQ(methods.count({*defaults.begin(), method}), 1U) << method;
    }
}

TEST_F(DevicesTest, CsvHeader) {
    EXPECT_EQ(linesOf(output({"devices", "--format", "csv"})).at(0),
              "index,name,type,api,driver,subgroup_size,default,method,available,trusted,verdict");
}

TEST_F(DevicesTest, OneDevice) {
    const Json all = Json::parse(output({"devices", "--format", "json"})).at("rows");
    const Json one = Json::parse(output({"devices", "--format", "json", "--device", "0"})).at("rows");
    ASSERT_FALSE(one.empty());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one.at(i).at("index"), 0);
        EXPECT_EQ(one.at(i), all.at(i));
    }
    EXPECT_THAT(refused(2, {"devices", "--device", "4711"}), HasSubstr("there are: 0 "));
}

TEST_F(DevicesTest, TextHasAllColumns) {
    const auto lines = linesOf(output({"devices", "--format", "text"}));
    for (const char* column : {"index", "name", "type", "api", "driver", "subgroup_size", "method", "verdict"}) {
        EXPECT_THAT(lines.at(0), HasSubstr(column));
    }
}

} // namespace
} // namespace voxtact::test

// SPDX-License-Identifier: MIT
// The page of --report, of made-up measurements.
#include "bench/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <sstream>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string page(const char* json) {
    std::ostringstream out;
    lab::writeReport(out, "a <title>", nlohmann::ordered_json::parse(json));
    return out.str();
}

TEST(Report, HasTablesOfMedians) {
    const std::string all = page(R"({"command": "voxtact compare --mesh 'a&b'", "summary": ["1 < 2"], "agrees": true,
        "machine": {"cpu": "<script>alert(1)</script>"},
        "rows": [{"mesh": "one", "gpu": {"frame_ms": {"median": 1.5, "samples": [1, 2]}}}, {"more": null}],
        "parts": {"ways": [{"queries": 7}]}})");
    EXPECT_THAT(all, AllOf(HasSubstr("<title>a &lt;title&gt;</title>"), HasSubstr("a&amp;b"),
                           HasSubstr("<li>1 &lt; 2</li>"), HasSubstr("&lt;script&gt;"), Not(HasSubstr("<script"))));
    EXPECT_THAT(all, HasSubstr("<tr><th>mesh</th><th>gpu frame_ms</th><th>more</th></tr>\n"
                               "<tr><td>one</td><td>1.5</td><td></td></tr>\n<tr><td></td><td></td><td></td></tr>"));
    EXPECT_THAT(all, AllOf(HasSubstr("<h2>parts ways</h2>"), HasSubstr("<td>7</td>"), Not(HasSubstr("<svg"))));
}

TEST(Report, DrawsRatesOfBatches) {
    const std::string all = page(R"({"command": "", "series": [
        {"sweep": "batch", "method": "query", "mode": "pipelined", "batch": 1, "pairs_per_s": 10},
        {"sweep": "batch", "method": "query", "mode": "pipelined", "batch": 100, "pairs_per_s": 1000},
        {"sweep": "batch", "method": "query", "mode": "sync", "batch": 10, "pairs_per_s": 5},
        {"sweep": "voxels", "method": "query", "mode": "pipelined", "batch": 10, "pairs_per_s": 5}]})");
    EXPECT_THAT(all, HasSubstr("from 10 to 1000"));
    EXPECT_THAT(all, HasSubstr("points=\"0,360 640,0 \""));
}

} // namespace
} // namespace voxtact::test

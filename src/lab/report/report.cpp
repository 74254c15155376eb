// SPDX-License-Identifier: MIT
#include "lab/report/report.h"

#include "core/base/escaped.h"
#include "lab/report/report_assets.h"

#include <nlohmann/json.hpp>

#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::lab {

namespace {

using Json = nlohmann::ordered_json;

/// JSON inside a script element must not end it.
std::string inScript(const Json& data) {
    std::string out;
    for (const char c : data.dump(-1, ' ', true, Json::error_handler_t::replace)) {
        out += c == '<' ? "\\u003c" : std::string(1, c);
    }
    return out;
}

std::string listItems(const std::vector<std::string>& sentences) {
    std::string out;
    for (const std::string& sentence : sentences) {
        const bool bad = sentence.starts_with("DISAGREEMENT");
        out += std::string(bad ? "<li class=\"bad\">" : "<li>") + inHtml(sentence) + ".</li>\n";
    }
    return out;
}

} // namespace

Result<void> reportPossible() {
    if (kChartLibrary.empty()) {
        return Error{ErrorCode::Unsupported, 0,
                     "--report: this program was built without Chart.js, which draws the charts; install Debian's "
                     "package libjs-chart.js, configure and build again"};
    }
    return {};
}

Result<void> writeReport(std::ostream& out, ReportKind kind, const Json& data) {
    const bool paper = kind == ReportKind::Paper;
    const std::map<std::string_view, std::string> parts{
        {"NAME", paper ? "voxtact bench --paper" : "voxtact compare"},
        {"TITLE", paper ? "The paper's measurements, made again" : "The same pairs by every method"},
        {"SUMMARY", listItems(data.at("summary").get<std::vector<std::string>>())},
        {"BODY", std::string(paper ? kPaperBody : kCompareBody)},
        {"DATA", inScript(data)},
        {"STYLE", std::string(kReportStyle)},
        {"LIBRARY", std::string(kChartLibrary)},
        {"LICENCE", inHtml(kChartLicence)},
        {"COMMON", std::string(kReportCommon)},
        {"SCRIPT", std::string(paper ? kPaperScript : kCompareScript)}};
    // The frame has {{NAME}} where a part belongs.
    std::string_view rest = kReportFrame;
    for (std::size_t open = rest.find("{{"); open != std::string_view::npos; open = rest.find("{{")) {
        const std::size_t close = rest.find("}}", open);
        const auto part = parts.find(rest.substr(open + 2, close - open - 2));
        out << rest.substr(0, open) << (part == parts.end() ? std::string() : part->second);
        rest.remove_prefix(close + 2);
    }
    out << rest;
    return {};
}

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "app/report.h"

#include "app/report_assets.h"

#include <nlohmann/json.hpp>

#include <ostream>
#include <string_view>

namespace voxtact::app {

namespace {

using Json = nlohmann::ordered_json;

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    }
    return out;
}

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
        out += std::string(bad ? "<li class=\"bad\">" : "<li>") + escaped(sentence) + ".</li>\n";
    }
    return out;
}

/// What stands for `name` in the page; nothing for a name that is not known.
std::string partFor(std::string_view name, const std::vector<std::string>& summary, const Json& data) {
    if (name == "STYLE") {
        return std::string(kReportStyle);
    }
    if (name == "SUMMARY") {
        return listItems(summary);
    }
    if (name == "DATA") {
        return inScript(data);
    }
    if (name == "LIBRARY") {
        return std::string(kChartLibrary);
    }
    if (name == "LICENCE") {
        return escaped(kChartLicence);
    }
    return name == "SCRIPT" ? std::string(kReportScript) : std::string();
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

Result<void> writeReport(std::ostream& out, const std::vector<std::string>& summary, const Json& data) {
    // The page has {{NAME}} where a part belongs.
    std::string_view rest = kReportPage;
    for (std::size_t open = rest.find("{{"); open != std::string_view::npos; open = rest.find("{{")) {
        const std::size_t close = rest.find("}}", open);
        out << rest.substr(0, open) << partFor(rest.substr(open + 2, close - open - 2), summary, data);
        rest.remove_prefix(close + 2);
    }
    out << rest;
    return {};
}

} // namespace voxtact::app

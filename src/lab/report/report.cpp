// SPDX-License-Identifier: MIT
#include "lab/report/report.h"

#include "lab/report/report_assets.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <ostream>
#include <string_view>
#include <utility>

namespace voxtact::lab {

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

struct Page {
    std::string_view name;
    std::string_view title;
    std::string_view body;
    std::string_view script;
};

Page pageOf(ReportKind kind) {
    return kind == ReportKind::Paper
               ? Page{"voxtact bench --paper", "The paper's measurements, made again", kPaperBody, kPaperScript}
               : Page{"voxtact compare", "The same pairs by every method", kCompareBody, kCompareScript};
}

/// What stands for `name` in the frame; nothing for a name that is not known.
std::string partFor(std::string_view name, const Page& page, const std::vector<std::string>& summary,
                    const Json& data) {
    if (name == "SUMMARY") {
        return listItems(summary);
    }
    if (name == "DATA") {
        return inScript(data);
    }
    if (name == "LICENCE") {
        return escaped(kChartLicence);
    }
    const std::array<std::pair<std::string_view, std::string_view>, 7> texts{{{"NAME", page.name},
                                                                              {"TITLE", page.title},
                                                                              {"BODY", page.body},
                                                                              {"SCRIPT", page.script},
                                                                              {"STYLE", kReportStyle},
                                                                              {"COMMON", kReportCommon},
                                                                              {"LIBRARY", kChartLibrary}}};
    const auto* const found = std::ranges::find(texts, name, &std::pair<std::string_view, std::string_view>::first);
    return found == texts.end() ? std::string() : std::string(found->second);
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

Result<void> writeReport(std::ostream& out, ReportKind kind, const std::vector<std::string>& summary,
                         const Json& data) {
    const Page page = pageOf(kind);
    // The frame has {{NAME}} where a part belongs.
    std::string_view rest = kReportFrame;
    for (std::size_t open = rest.find("{{"); open != std::string_view::npos; open = rest.find("{{")) {
        const std::size_t close = rest.find("}}", open);
        out << rest.substr(0, open) << partFor(rest.substr(open + 2, close - open - 2), page, summary, data);
        rest.remove_prefix(close + 2);
    }
    out << rest;
    return {};
}

} // namespace voxtact::lab

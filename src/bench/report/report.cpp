// SPDX-License-Identifier: MIT
#include "bench/report/report.h"

#include "core/base/escaped.h"
#include "core/base/text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::lab {

namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::pair<std::string, std::string>>;

std::string valueText(const Json& value) {
    return value.is_string()         ? inHtml(value.get<std::string>())
           : value.is_number_float() ? number(value.get<double>())
           : value.is_null()         ? ""
                                     : inHtml(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// The members of an object by name; those of an object in it with both names, and of a spread the median. Lists are
/// left out.
void addCells(const std::string& before, const Json& object, Cells& cells) {
    for (const auto& [name, value] : object.items()) {
        if (value.is_object() && value.contains("median")) {
            cells.emplace_back(before + name, valueText(value.at("median")));
        } else if (value.is_object() && name != "machine") { // which is that of the page
            addCells(before + name + ' ', value, cells);
        } else if (!value.is_structured()) {
            cells.emplace_back(before + name, valueText(value));
        }
    }
}

bool isRows(const Json& value) {
    return value.is_array() && !value.empty() && value.front().is_object();
}

/// A table whose columns are those of any row.
void writeRows(std::ostream& out, const std::string& name, const Json& list) {
    std::vector<Cells> rows;
    std::vector<std::string> columns;
    for (const Json& row : list) {
        addCells("", row, rows.emplace_back());
        for (const auto& cell : rows.back()) {
            if (std::ranges::find(columns, cell.first) == columns.end()) {
                columns.push_back(cell.first);
            }
        }
    }
    out << "<h2>" << inHtml(name) << "</h2>\n<table>\n<tr>";
    for (const std::string& column : columns) {
        out << "<th>" << inHtml(column) << "</th>";
    }
    for (const Cells& row : rows) {
        out << "</tr>\n<tr>";
        for (const std::string& column : columns) {
            const auto cell = std::ranges::find(row, column, &Cells::value_type::first);
            out << "<td>" << (cell == row.end() ? "" : cell->second) << "</td>";
        }
    }
    out << "</tr>\n</table>\n";
}

void writeObject(std::ostream& out, const std::string& name, const Json& object) {
    Cells cells;
    addCells("", object, cells);
    out << "<h2>" << inHtml(name) << "</h2>\n<table>\n";
    for (const auto& [member, value] : cells) {
        out << "<tr><th>" << inHtml(member) << "</th><td>" << value << "</td></tr>\n";
    }
    out << "</table>\n";
}

/// Pairs per second against pairs in a batch, both on logarithmic axes, a line for each method.
void writeDiagram(std::ostream& out, const Json& series) {
    constexpr double kWidth = 640;
    constexpr double kHeight = 360;
    constexpr std::array kLineColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
    std::map<std::string, std::map<double, double>> lines;
    double maxPairs = 1;
    double minRate = HUGE_VAL;
    double maxRate = 0;
    for (const Json& point : series) {
        const auto text = [&](const char* name) { return valueText(point.value(name, Json())); };
        const Json rate = point.value("pairs_per_s", Json());
        if (rate.is_number() && rate > 0 && text("sweep") == "batch" && text("mode") != "sync") {
            const double pairs = point.at("batch").get<double>();
            lines[text("method")][pairs] = rate.get<double>();
            maxPairs = std::max(maxPairs, pairs);
            minRate = std::min(minRate, rate.get<double>());
            maxRate = std::max(maxRate, rate.get<double>());
        }
    }
    if (lines.empty() || maxPairs == 1 || minRate == maxRate) {
        return;
    }
    const auto place = [](double value, double least, double most, double length) {
        return number(std::round(length * std::log(value / least) / std::log(most / least)));
    };
    out << "<h2>pairs per second by pairs in a batch, from " << number(minRate) << " to " << number(maxRate)
        << "</h2>\n<svg width=\"" << kWidth + 120 << "\" height=\"" << kHeight + 20
        << "\" viewBox=\"-10 -10 760 380\">\n<rect width=\"" << kWidth << "\" height=\"" << kHeight
        << "\" fill=\"none\" stroke=\"#999\"/>\n";
    std::size_t index = 0;
    for (const auto& [method, points] : lines) {
        const char* const colour = kLineColours.at(index++ % kLineColours.size());
        const std::string end = place(maxRate / points.rbegin()->second, 1, maxRate / minRate, kHeight);
        out << "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" << colour << "\" points=\"";
        for (const auto& [pairs, rate] : points) {
            out << place(pairs, 1, maxPairs, kWidth) << ',' << place(maxRate / rate, 1, maxRate / minRate, kHeight)
                << ' ';
        }
        out << "\"/>\n<text x=\"" << kWidth + 5 << "\" y=\"" << end << "\" fill=\"" << colour << "\">" << method
            << "</text>\n";
    }
    out << "</svg>\n";
}

void writeList(std::ostream& out, const Json& sentences) {
    out << "<ul>\n";
    for (const Json& sentence : sentences) {
        out << "<li>" << valueText(sentence) << "</li>\n";
    }
    out << "</ul>\n";
}

} // namespace

void writeReport(std::ostream& out, const std::string& title, const Json& data) {
    out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" << inHtml(title)
        << "</title>\n<style>body{font:15px/1.4 sans-serif;margin:2em}table{border-collapse:collapse;font-size:13px}"
           "td,th{border:1px solid #ccc;padding:2px 6px;text-align:right}</style></head><body>\n<h1>"
        << inHtml(title) << "</h1>\n<p><code>" << valueText(data.at("command")) << "</code></p>\n";
    for (const char* list : {"summary", "notes"}) {
        if (data.contains(list)) {
            writeList(out, data.at(list));
        }
    }
    if (data.contains("series")) {
        writeDiagram(out, data.at("series"));
    }
    for (const auto& [name, value] : data.items()) {
        if (isRows(value)) {
            writeRows(out, name, value);
        } else if (value.is_object()) {
            writeObject(out, name, value);
            for (const auto& [member, list] : value.items()) {
                if (isRows(list)) {
                    writeRows(out, name + ' ' + member, list);
                }
            }
        }
    }
    out << "</body></html>\n";
}

} // namespace voxtact::lab

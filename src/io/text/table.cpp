// SPDX-License-Identifier: MIT
#include "io/text/table.h"

#include "core/base/escaped.h"
#include "core/base/text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace voxtact::io {

namespace {

using Json = nlohmann::ordered_json;

std::string inQuotes(const std::string& field) {
    std::string out = "\"";
    for (const char c : field) {
        out += c == '"' ? "\"\"" : std::string(1, c);
    }
    return out + '"';
}

/// Among names with counts behind colons, semicolons between them.
std::string listName(const std::string& name) {
    if (name.find_first_of(",;:\"\r\n") == std::string::npos) {
        return name;
    }
    return inQuotes(name);
}

std::string listText(const std::vector<NamedCount>& counts) {
    std::string text;
    for (const NamedCount& entry : counts) {
        text += (text.empty() ? "" : ";") + listName(entry.name) + ":" + std::to_string(entry.count);
    }
    return text;
}

/// Formats a field of CSV or, with words, of text.
std::string cellText(const Cell& cell, std::string_view nothing, bool words) {
    if (const auto* whole = std::get_if<std::uint64_t>(&cell)) {
        return std::to_string(*whole);
    }
    if (const auto* real = std::get_if<double>(&cell)) {
        return number(*real);
    }
    if (const auto* text = std::get_if<std::string>(&cell)) {
        return *text;
    }
    if (const auto* both = std::get_if<NumberWord>(&cell)) {
        return words ? both->word : std::to_string(both->number);
    }
    if (const auto* file = std::get_if<PathName>(&cell)) {
        return words ? file->name : file->path;
    }
    if (const auto* counts = std::get_if<std::vector<NamedCount>>(&cell); counts != nullptr && !counts->empty()) {
        return listText(*counts);
    }
    return std::string(nothing);
}

std::string csvText(const Cell& cell) {
    return cellText(cell, "", false);
}

/// A terminal obeys control characters.
std::string wordText(const Cell& cell) {
    return escaped(cellText(cell, "-", true));
}

/// Numbers go to the right of their column.
bool isRight(const Cell& cell) {
    return std::holds_alternative<std::monostate>(cell) || std::holds_alternative<std::uint64_t>(cell) ||
           std::holds_alternative<double>(cell);
}

Json toJson(const Cell& cell) {
    if (const auto* whole = std::get_if<std::uint64_t>(&cell)) {
        return *whole;
    }
    if (const auto* real = std::get_if<double>(&cell)) {
        return std::isinf(*real) ? Json(number(*real)) : Json(*real);
    }
    if (const auto* text = std::get_if<std::string>(&cell)) {
        return *text;
    }
    if (const auto* both = std::get_if<NumberWord>(&cell)) {
        return both->word;
    }
    if (const auto* file = std::get_if<PathName>(&cell)) {
        return file->path;
    }
    if (const auto* counts = std::get_if<std::vector<NamedCount>>(&cell)) {
        Json list = Json::array();
        for (const NamedCount& entry : *counts) {
            list.push_back({{"label", entry.label}, {"name", entry.name}, {"count", entry.count}});
        }
        return list;
    }
    return nullptr;
}

/// File names may hold any bytes; the ones that are not UTF-8 are replaced.
std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json cellsJson(const NamedCells& cells) {
    Json object = Json::object();
    for (const auto& [name, cell] : cells) {
        object[name] = toJson(cell);
    }
    return object;
}

Json rowJson(const Table& table, std::size_t row) {
    Json object = Json::object();
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        object[table.columns[column]] = toJson(table.cell(row, column));
    }
    return object;
}

} // namespace

Json rowsJson(const Table& table) {
    Json rows = Json::array();
    for (std::size_t row = 0; row < table.rows; ++row) {
        rows.push_back(rowJson(table, row));
    }
    return rows;
}

TableWriter::TableWriter(std::ostream& out, Format format) : out_(out), format_(format) {}

void TableWriter::addCsv(const Table& part) {
    for (std::size_t column = 0; !begun_ && column < part.columns.size(); ++column) {
        out_ << (column == 0 ? "" : ",") << part.columns[column] << (column + 1 == part.columns.size() ? "\n" : "");
    }
    for (std::size_t row = 0; row < part.rows; ++row) {
        for (std::size_t column = 0; column < part.columns.size(); ++column) {
            out_ << (column == 0 ? "" : ",") << csvField(csvText(part.cell(row, column)));
        }
        out_ << '\n';
    }
}

void TableWriter::addText(const Table& part) {
    widths_.resize(part.columns.size());
    for (std::size_t column = 0; column < part.columns.size(); ++column) {
        std::size_t& width = widths_[column];
        width = std::max(width, part.columns[column].size());
        for (std::size_t row = 0; row < part.rows; ++row) {
            width = std::max(width, wordText(part.cell(row, column)).size());
        }
    }
    const auto writeField = [&](const std::string& field, std::size_t column, bool right) {
        const std::string padding(widths_[column] - field.size(), ' ');
        const bool last = column + 1 == widths_.size();
        out_ << (column == 0 ? "" : "  ") << (right ? padding : "") << field << (right || last ? "" : padding)
             << (last ? "\n" : "");
    };
    for (std::size_t column = 0; !begun_ && column < part.columns.size(); ++column) {
        const bool right = part.rows > 0 && isRight(part.cell(0, column));
        writeField(part.columns[column], column, right);
    }
    for (std::size_t row = 0; row < part.rows; ++row) {
        for (std::size_t column = 0; column < part.columns.size(); ++column) {
            const Cell cell = part.cell(row, column);
            writeField(wordText(cell), column, isRight(cell));
        }
    }
}

void TableWriter::addJson(const Table& part) {
    if (!begun_) {
        out_ << "{\n";
        for (const auto& [name, cell] : part.facts) {
            out_ << dump(name) << ": " << dump(toJson(cell)) << ",\n";
        }
        out_ << "\"rows\": [";
    }
    for (std::size_t row = 0; row < part.rows; ++row) {
        out_ << (rows_ + row == 0 ? "\n" : ",\n") << dump(rowJson(part, row));
    }
}

void TableWriter::add(const Table& part) {
    switch (format_) {
    case Format::Csv:
        addCsv(part);
        break;
    case Format::Json:
        addJson(part);
        break;
    case Format::Text:
        addText(part);
        break;
    }
    begun_ = true;
    rows_ += part.rows;
}

void TableWriter::beginArray(const std::string& name) {
    out_ << "\n],\n" << dump(name) << ": [";
    rows_ = 0;
}

void TableWriter::end(std::span<const TableEnd> ends, bool whole) {
    const bool json = format_ == Format::Json;
    out_ << (json ? "\n]" : "");
    for (const TableEnd& end : ends) {
        if (end.cells.empty()) {
            continue;
        }
        if (json) {
            out_ << ",\n" << dump(end.name) << ": " << dump(cellsJson(end.cells));
            continue;
        }
        out_ << '#';
        for (const auto& [name, cell] : end.cells) {
            out_ << ' ' << name << '='
                 << (format_ == Format::Text ? escaped(cellText(cell, "-", false)) : cellText(cell, "-", false));
        }
        out_ << '\n';
    }
    if (json) {
        out_ << (whole ? "\n}\n" : ",\n\"interrupted\": true\n}\n");
    }
}

void writeTable(std::ostream& out, Format format, const Table& table) {
    TableWriter writer(out, format);
    writer.add(table);
    const TableEnd timing{"timing", table.timing};
    writer.end({&timing, 1});
}

std::string csvField(const std::string& field) {
    return field.find_first_of(",\"\r\n") == std::string::npos ? field : inQuotes(field);
}

} // namespace voxtact::io

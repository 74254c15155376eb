// SPDX-License-Identifier: MIT
#include "app/output.h"

#include "app/outcome.h"
#include "app/standard_streams.h"
#include "core/text.h"
#include "voxtact/io.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <sstream>
#include <system_error>
#include <unistd.h>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;
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

/// As a field of CSV or, where there are words, of text.
std::string cellText(const Cell& cell, std::string_view nothing, bool words = false) {
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
    if (const auto* counts = std::get_if<std::vector<NamedCount>>(&cell); counts != nullptr && !counts->empty()) {
        return listText(*counts);
    }
    return std::string(nothing);
}

void writeTimingComment(std::ostream& out, const Table& table) {
    if (table.timing.empty()) {
        return;
    }
    out << '#';
    for (const auto& [name, cell] : table.timing) {
        out << ' ' << name << '=' << cellText(cell, "-");
    }
    out << '\n';
}

void writeCsv(std::ostream& out, const Table& table) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        out << (column == 0 ? "" : ",") << table.columns[column];
    }
    out << '\n';
    for (std::size_t row = 0; row < table.rows; ++row) {
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            out << (column == 0 ? "" : ",") << csvField(cellText(table.cell(row, column), ""));
        }
        out << '\n';
    }
    writeTimingComment(out, table);
}

/// Numbers go to the right of their column.
bool isRight(const Cell& cell) {
    return std::holds_alternative<std::monostate>(cell) || std::holds_alternative<std::uint64_t>(cell) ||
           std::holds_alternative<double>(cell);
}

void writeText(std::ostream& out, const Table& table) {
    std::vector<std::size_t> widths;
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        std::size_t width = table.columns[column].size();
        for (std::size_t row = 0; row < table.rows; ++row) {
            width = std::max(width, cellText(table.cell(row, column), "-", true).size());
        }
        widths.push_back(width);
    }
    const auto writeField = [&](const std::string& field, std::size_t column, bool right) {
        const std::string padding(widths[column] - field.size(), ' ');
        const bool last = column + 1 == widths.size();
        out << (column == 0 ? "" : "  ") << (right ? padding : "") << field << (right || last ? "" : padding);
    };
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        const bool right = table.rows > 0 && isRight(table.cell(0, column));
        writeField(table.columns[column], column, right);
    }
    out << '\n';
    for (std::size_t row = 0; row < table.rows; ++row) {
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            const Cell cell = table.cell(row, column);
            writeField(cellText(cell, "-", true), column, isRight(cell));
        }
        out << '\n';
    }
    writeTimingComment(out, table);
}

Json toJson(const Cell& cell) {
    if (const auto* whole = std::get_if<std::uint64_t>(&cell)) {
        return *whole;
    }
    if (const auto* real = std::get_if<double>(&cell)) {
        return *real;
    }
    if (const auto* text = std::get_if<std::string>(&cell)) {
        return *text;
    }
    if (const auto* both = std::get_if<NumberWord>(&cell)) {
        return both->number;
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

Json rowJson(const Table& table, std::size_t row) {
    Json object = Json::object();
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        object[table.columns[column]] = toJson(table.cell(row, column));
    }
    return object;
}

void writeJson(std::ostream& out, const Table& table) {
    out << "{\n";
    for (const auto& [name, cell] : table.facts) {
        out << dump(name) << ": " << dump(toJson(cell)) << ",\n";
    }
    out << "\"rows\": [";
    for (std::size_t row = 0; row < table.rows; ++row) {
        out << (row == 0 ? "\n" : ",\n") << dump(rowJson(table, row));
    }
    out << "\n]";
    if (!table.timing.empty()) {
        Json timing = Json::object();
        for (const auto& [name, cell] : table.timing) {
            timing[name] = toJson(cell);
        }
        out << ",\n\"timing\": " << dump(timing);
    }
    out << "\n}\n";
}

Error fileError(const fs::path& path, const std::string& why) {
    return Error{ErrorCode::File, 0, "cannot write '" + path.string() + "': " + why};
}

/// A device, a pipe: io::writeFile() writes it as it is, so that its folder does not matter.
bool isSpecial(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The deliveries from number `next` on, each written before the ones after it are put in their places.
Result<void> deliverFrom(const std::vector<Delivery>& deliveries, std::size_t next) {
    if (next == deliveries.size()) {
        return {};
    }
    const Delivery& delivery = deliveries[next];
    return deliver(delivery.path, [&](std::ostream& out) -> Result<void> {
        if (Result<void> written = delivery.write(out); !written.ok()) {
            return written;
        }
        errno = 0;
        if (!out.flush()) {
            return fileError(delivery.path, errno != 0 ? std::generic_category().message(errno) : "writing stopped");
        }
        return deliverFrom(deliveries, next + 1);
    });
}

} // namespace

Json rowsJson(const Table& table) {
    Json rows = Json::array();
    for (std::size_t row = 0; row < table.rows; ++row) {
        rows.push_back(rowJson(table, row));
    }
    return rows;
}

void writeTable(std::ostream& out, Format format, const Table& table) {
    switch (format) {
    case Format::Csv:
        return writeCsv(out, table);
    case Format::Json:
        return writeJson(out, table);
    case Format::Text:
        return writeText(out, table);
    }
}

Format OutputOptions::format() const {
    if (formatName.empty()) {
        return path.empty() && outputIsTerminal() ? Format::Text : Format::Csv;
    }
    return formatName == "json" ? Format::Json : formatName == "text" ? Format::Text : Format::Csv;
}

Result<void> checkOutput(const fs::path& path) {
    if (path.empty() || isSpecial(path)) {
        return {};
    }
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        return fileError(path, "it is a folder");
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored)) {
        return fileError(path, "the folder '" + folder.string() + "' does not exist: make it first");
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        return fileError(path, "the folder '" + folder.string() + "': " + std::generic_category().message(errno));
    }
    return {};
}

Result<void> checkDistinct(const std::vector<std::pair<std::string, fs::path>>& paths) {
    for (auto one = paths.begin(); one != paths.end(); ++one) {
        if (one->second.empty() || isSpecial(one->second)) {
            continue;
        }
        std::error_code ignored;
        const fs::path place = fs::weakly_canonical(fs::absolute(one->second), ignored);
        for (auto other = paths.begin(); other != one; ++other) {
            if (!other->second.empty() && fs::weakly_canonical(fs::absolute(other->second), ignored) == place) {
                return badArgument(other->first + " and " + one->first + ": both are '" + one->second.string() +
                                   "'; each needs a file of its own");
            }
        }
    }
    return {};
}

std::string csvField(const std::string& field) {
    return field.find_first_of(",\"\r\n") == std::string::npos ? field : inQuotes(field);
}

Result<void> deliver(const fs::path& path, const std::function<Result<void>(std::ostream&)>& write) {
    if (path.empty()) {
        std::ostringstream text;
        if (Result<void> written = write(text); !written.ok()) {
            return written;
        }
        return writeStandardOutput(text.str());
    }
    return io::writeFile(path, write);
}

Result<void> deliverAll(std::vector<Delivery> deliveries) {
    // The last is put in its place first. What is on standard output cannot be taken back, and may fail.
    std::stable_partition(deliveries.begin(), deliveries.end(),
                          [](const Delivery& delivery) { return !delivery.path.empty(); });
    return deliverFrom(deliveries, 0);
}

} // namespace voxtact::app

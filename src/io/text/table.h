// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Tables as text, CSV and JSON.
namespace voxtact::io {

enum class Format { Csv, Json, Text };

/// A number in CSV, a word in text and JSON.
struct NumberWord {
    std::uint64_t number = 0;
    const char* word = "";
};

/// A path in CSV and JSON that is a name in text.
struct PathName {
    std::string path;
    std::string name;
};

/// Number of fragments at a label.
struct NamedCount {
    std::int32_t label = 0;
    std::string name;
    std::uint64_t count = 0;
};

/// Infinity is a string in JSON, a word in CSV. Empty: an empty field in CSV, null in JSON, "-" in text. Named counts:
/// "name:count;name:count" in CSV and text, where names with one of , ; : or quotes are in quotes, quotes in them
/// doubled; an array of objects in JSON.
using Cell =
    std::variant<std::monostate, std::uint64_t, double, std::string, NumberWord, PathName, std::vector<NamedCount>>;
using NamedCells = std::vector<std::pair<std::string, Cell>>;

/// Footer after the rows: a line of CSV and text, "# name=value ..."; a member of JSON. Omitted if empty.
struct TableEnd {
    const char* name = ""; ///< of the member
    NamedCells cells{};
};

/// Rows for every format.
struct Table {
    std::vector<std::string> columns;
    std::size_t rows = 0;
    std::function<Cell(std::size_t row, std::size_t column)> cell;
    NamedCells facts;  ///< JSON only: members before "rows"
    NamedCells timing; ///< a TableEnd
};

/// JSON is one object: the facts, "rows" (an array of an object a row), "timing".
void writeTable(std::ostream& out, Format format, const Table& table);

/// An array of an object a row, as in "rows".
[[nodiscard]] nlohmann::ordered_json rowsJson(const Table& table);

/// A field of CSV: in quotes where it has to be (RFC 4180).
[[nodiscard]] std::string csvField(const std::string& field);

/// Writes a table as writeTable() does, some rows at a time, so that they need not all be there at once.
class TableWriter {
  public:
    /// The stream must outlive it.
    TableWriter(std::ostream& out, Format format);

    /// Writes the next rows, with the header before the first part, which may be empty. Columns of text are as wide as
    /// the widest field so far.
    void add(const Table& part);
    /// JSON only: the rows that follow are of another array, a member of this name behind the one before.
    void beginArray(const std::string& name);
    /// The caller writes the header.
    void omitHead() noexcept { begun_ = true; }
    /// After all parts, of which there must be one. `whole` false: JSON says "interrupted".
    void end(std::span<const TableEnd> ends = {}, bool whole = true);

  private:
    void addCsv(const Table& part);
    void addText(const Table& part);
    void addJson(const Table& part);

    std::ostream& out_;
    Format format_;
    bool begun_ = false;
    std::uint64_t rows_ = 0;
    std::vector<std::size_t> widths_;
};

} // namespace voxtact::io

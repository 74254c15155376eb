// SPDX-License-Identifier: MIT
#pragma once

#include "bench/measure/machine.h"
#include "bench/measure/numbers.h"
#include "io/text/table.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <concepts>
#include <initializer_list>
#include <iosfwd>
#include <optional>
#include <span>

/// Values and columns of text, CSV and JSON.
namespace voxtact::lab {

using Json = nlohmann::ordered_json;

/// A value of all formats. Real numbers are rounded(); an empty optional is empty.
template <class Value> [[nodiscard]] io::Cell cellOf(const Value& value) {
    if constexpr (std::floating_point<Value>) {
        return rounded(value);
    } else if constexpr (std::unsigned_integral<Value>) {
        return std::uint64_t{value};
    } else {
        return std::string(value);
    }
}
template <class Value> [[nodiscard]] io::Cell cellOf(const std::optional<Value>& value) {
    return value ? cellOf(*value) : io::Cell();
}
/// Returns the spread of samples; null without samples.
[[nodiscard]] Json spreadJson(const std::vector<double>& samples);

/// Name of a value in text and CSV, and in JSON; empty: omitted.
struct Names {
    std::string column;
    std::string member;

    Names(const char* both) : column(both), member(both) {}
    Names(const char* inColumns, const char* inJson) : column(inColumns), member(inJson) {}
};

/// A row: cells with the names of columns for text and CSV, an object for JSON.
class Row {
  public:
    template <class Value> Row& add(const Names& names, const Value& value) { return addCell(names, cellOf(value)); }
    /// Empty if the text is empty.
    Row& addSome(const Names& names, const std::string& text) {
        return add(names, text.empty() ? std::nullopt : std::optional(text));
    }
    /// Columns of a spread, by the suffix of their names: "_p10", "_p90", "_min", "_max"; for the median "_median" or
    /// none. One object in JSON. Empty without samples.
    Row& add(const Names& names, const std::vector<double>& samples, std::initializer_list<const char*> parts);
    /// In columns alone.
    template <class Value> Row& column(const char* name, const Value& value) { return add({name, ""}, value); }
    /// Adds the columns of another row, without JSON members.
    Row& columns(const Row& others);
    /// In JSON alone.
    Row& member(const char* name, Json value);

    [[nodiscard]] const io::NamedCells& cells() const noexcept { return cells_; }
    [[nodiscard]] const Json& json() const noexcept { return json_; }

  private:
    Row& addCell(const Names& names, io::Cell cell);

    io::NamedCells cells_;
    Json json_ = Json::object();
};

/// The cells of each thing; `rowOf` gives a Row.
template <class Things, class RowOf>
[[nodiscard]] std::vector<io::NamedCells> cellsOf(const Things& things, RowOf rowOf) {
    std::vector<io::NamedCells> rows;
    std::ranges::transform(things, std::back_inserter(rows), [&](const auto& thing) { return rowOf(thing).cells(); });
    return rows;
}
/// Rows that have the same columns. `none`: a row for the columns' names, where there may be no rows.
[[nodiscard]] io::Table tableOf(std::vector<io::NamedCells> rows, const io::NamedCells& none = {});
/// Like above without some columns, to fit on a wide terminal.
[[nodiscard]] io::Table tableWithout(std::span<const char* const> columns, std::vector<io::NamedCells> rows);
template <class Things, class JsonOf> [[nodiscard]] Json arrayOf(const Things& things, JsonOf jsonOf) {
    Json array = Json::array();
    for (const auto& thing : things) {
        array.push_back(jsonOf(thing));
    }
    return array;
}

[[nodiscard]] Json machineJson(const Machine& machine);

/// Results for all formats.
struct Output {
    const Machine& machine;
    /// Members of JSON, after the common ones and those of the machine, and before the notes.
    Json members;
    io::Table table{};                    ///< of CSV and text
    std::string about{};                  ///< a comment behind the table; may be empty
    std::vector<std::string> sentences{}; ///< results as sentences; comments of CSV and text
    std::vector<std::string> notes{};     ///< in addition to the machine's
};

[[nodiscard]] Json jsonOf(const Output& output);
/// The table, then the findings.
void writeOutput(std::ostream& out, io::Format format, const Output& output);
/// Comment lines: the sentences, the machine, and the notes.
void writeFindings(std::ostream& out, const Output& output);

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/result.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace voxtact::app {

enum class Format { Csv, Json, Text };

/// A number in CSV and JSON that has a word in text.
struct NumberWord {
    std::uint64_t number = 0;
    const char* word = "";
};

/// How many fragments are at a label.
struct NamedCount {
    std::int32_t label = 0;
    std::string name;
    std::uint64_t count = 0;
};

/// Nothing: an empty field in CSV, null in JSON, "-" in text. Named counts: "name:count;name:count" in CSV and text,
/// where names with one of , ; : or quotes are in quotes, quotes in them doubled; an array of objects in JSON.
using Cell = std::variant<std::monostate, std::uint64_t, double, std::string, NumberWord, std::vector<NamedCount>>;
using NamedCells = std::vector<std::pair<std::string, Cell>>;

/// The same rows for every format.
struct Table {
    std::vector<std::string> columns;
    std::size_t rows = 0;
    std::function<Cell(std::size_t row, std::size_t column)> cell;
    NamedCells facts;  ///< JSON only: members before "rows"
    NamedCells timing; ///< the last line of CSV and text, "# name=value ..."; a member of JSON. Left out when empty
};

/// JSON is one object: the facts, "rows" (an array of an object a row), "timing".
void writeTable(std::ostream& out, Format format, const Table& table);

/// An array of an object a row, as in "rows".
[[nodiscard]] nlohmann::ordered_json rowsJson(const Table& table);

/// Where a command's output goes.
struct OutputOptions {
    std::filesystem::path path; ///< empty: standard output
    std::string formatName;     ///< empty: text on a terminal, else CSV

    [[nodiscard]] Format format() const;
};

/// A field of CSV: in quotes where it has to be (RFC 4180).
[[nodiscard]] std::string csvField(const std::string& field);

/// Whether `path` can be written, found out without writing: no work is done for nothing. Fine when it is empty.
[[nodiscard]] Result<void> checkOutput(const std::filesystem::path& path);

/// Refuses two of the named paths ("--output", path) that are one file; empty ones, devices and pipes are not looked
/// at.
[[nodiscard]] Result<void> checkDistinct(const std::vector<std::pair<std::string, std::filesystem::path>>& paths);

/// Calls `write`, and puts what it wrote in `path` (a temporary file, renamed; devices and pipes are written as they
/// are) or, where that is empty, on standard output. Nothing is put there when `write` fails.
[[nodiscard]] Result<void> deliver(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);

/// Where something goes, and what writes it.
struct Delivery {
    std::filesystem::path path;
    std::function<Result<void>(std::ostream&)> write;
};

/// deliver() of several: nothing is put anywhere before all are written, and standard output comes first.
[[nodiscard]] Result<void> deliverAll(std::vector<Delivery> deliveries);

} // namespace voxtact::app

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

/// Nothing: an empty field in CSV, null in JSON, "-" in text.
using Cell = std::variant<std::monostate, std::uint64_t, double, std::string>;
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

/// Whether `path` can be written, found out without writing: no work is done for nothing. Fine when it is empty.
[[nodiscard]] Result<void> checkOutput(const std::filesystem::path& path);

/// Calls `write`, and puts what it wrote in `path` (a temporary file, renamed; devices and pipes are written as they
/// are) or, where that is empty, on standard output. Nothing is put there when `write` fails.
[[nodiscard]] Result<void> deliver(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);

} // namespace voxtact::app

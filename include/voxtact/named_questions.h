// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

/// Questions by name, with settings by name and answers as tables, for bindings and programs that treat all questions
/// alike. The structs of the questions describe the settings; vxt_fact_get() lists their kinds, ranges and defaults.
namespace voxtact {

/// Type of a column's elements.
enum class ColumnType : std::uint32_t {
    Uint32, ///< a number, or an index into Column::choices
    Int32,  ///< a label
    Uint64, ///< a count
    Double, ///< in Column::unit
};

/// How the program prints a column of a question that measures.
enum class Printed : std::uint32_t {
    No,    ///< not at all
    Plain, ///< as it is; an infinite number is left empty
    Down,  ///< a lower bound: rounded down
    Up,    ///< an upper bound: rounded up
};

/// A column of a table: where it is in a row. The texts have static lifetime.
struct Column {
    const char* name;       ///< "lower"
    const char* unit;       ///< "mm"; "" for none
    const char* text;       ///< one line: meaning
    const char* choices;    ///< names of 0, 1, 2 ...: "no,yes,undecided"; else ""
    ColumnType type;        ///< type of each element
    std::uint32_t elements; ///< per row: 1, 3 for a point, 16 for a pose
    std::size_t offset;     ///< bytes from the start of a row
    Printed printed;        ///< how programs print it
};

/// A table of an answer: rows of one struct, in memory that all copies share.
struct AnswerTable {
    const char* name = "";              ///< "pairs", "labels"
    std::span<const Column> columns;    ///< of each row
    std::shared_ptr<const void> memory; ///< keeps `data`
    const std::byte* data = nullptr;    ///< the first row
    std::size_t rows = 0;               ///< number of rows
    std::size_t stride = 0;             ///< bytes from row to row

    /// Returns a column by name; null if the table has none.
    [[nodiscard]] VOXTACT_API const Column* column(std::string_view wanted) const noexcept;
    /// Returns an element as a double. Expects a row and an element that exist.
    [[nodiscard]] VOXTACT_API double number(const Column& column, std::size_t row,
                                            std::size_t element = 0) const noexcept;
    /// Returns an element of the column of that name. Expects a column, a row and an element that exist.
    [[nodiscard]] VOXTACT_API double number(std::string_view column, std::size_t row,
                                            std::size_t element = 0) const noexcept;
};

/// An answer: a table with one row per pair in order ("pairs"; of motion "segments", of plan "paths"), further tables,
/// and "totals" with one row.
struct AnswerTables {
    std::vector<AnswerTable> tables;             ///< each with a name of its own
    std::optional<CertifiedCounters> counters{}; ///< of a device, if they were requested

    /// Returns a table by name; null if the answer has none.
    [[nodiscard]] VOXTACT_API const AnswerTable* find(std::string_view name) const noexcept;
};

/// A value for a setting: of a number or flag, the name of a choice, a list of numbers, a list of labels.
using SettingValue = std::variant<double, std::string_view, std::span<const double>, std::span<const std::int32_t>>;

/// A setting of a question. Names and lists need to live during the call only.
struct Setting {
    std::string_view name; ///< name of its fact
    SettingValue value{};  ///< of the kind of its fact
};

/// A table that the answer to a question has.
struct TableLayout {
    const char* name = "";           ///< "pairs"
    std::span<const Column> columns; ///< of each row
};

/// A question by its name. The texts have static lifetime.
struct NamedQuestion {
    std::string_view name;               ///< "distance"
    std::string_view text;               ///< one line: "how near is it?"
    std::string_view help{};             ///< columns and examples, printed at the end of --help
    std::span<const TableLayout> tables; ///< of its answers, without "totals"
    bool measures = false;               ///< its pairs have bounds, columns "lower" and "upper"
    bool isLeastWorst = false;           ///< the worst pair has the smallest bounds, not the largest
    bool needsSolid = false;             ///< it refuses meshes with holes

    /// Returns a table by name; null if there is none.
    [[nodiscard]] VOXTACT_API const TableLayout* table(std::string_view wanted) const noexcept;
};

/// Returns all questions about pairs, in the order of the program's help.
[[nodiscard]] VOXTACT_API std::span<const NamedQuestion> namedQuestions() noexcept;

/// Answers a question for every pair of the batch, like HostEngine::ask() of that question. Settings that are not given
/// have their defaults. Refuses an unknown question, an unknown setting, a setting that is given twice, and a value of
/// another kind or outside its range. Thread-safety: one call of an engine at a time.
[[nodiscard]] VOXTACT_API Result<AnswerTables> ask(cpu::HostEngine& engine, std::string_view question,
                                                   std::span<const Setting> settings, const cpu::Batch& batch);

} // namespace voxtact

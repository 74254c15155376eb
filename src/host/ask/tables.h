// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/named_questions.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>

/// Answers as tables. The columns of a question stand in the file of src/host/ask that is named after it.
namespace voxtact {

/// Type and length of a member: a number, an enumeration, or an array of numbers.
template <class Member> struct ColumnElement {
    using Element = Member;
    static constexpr std::uint32_t count = 1;
};
template <class Member, std::size_t size> struct ColumnElement<std::array<Member, size>> {
    using Element = Member;
    static constexpr std::uint32_t count = size;
};

template <class Element> constexpr ColumnType columnType() {
    if constexpr (std::is_same_v<Element, double>) {
        return ColumnType::Double;
    } else if constexpr (std::is_same_v<Element, std::uint64_t>) {
        return ColumnType::Uint64;
    } else if constexpr (std::is_same_v<Element, std::int32_t>) {
        return ColumnType::Int32;
    } else if constexpr (std::is_enum_v<Element>) {
        return columnType<std::underlying_type_t<Element>>();
    } else {
        static_assert(std::is_same_v<Element, std::uint32_t>);
        return ColumnType::Uint32;
    }
}

template <class Member>
constexpr Column columnOf(const char* name, std::size_t offset, const char* unit, const char* text,
                          Printed printed = Printed::No, const char* choices = "") {
    using Element = ColumnElement<std::remove_cvref_t<Member>>;
    return {name, unit, text, choices, columnType<typename Element::Element>(), Element::count, offset, printed};
}

// VOXTACT_COLUMN(Row, name, member, unit, text, [printed, [choices]]): a column of a struct.
#define VOXTACT_COLUMN(Row, name, member, ...)                                                                         \
    columnOf<decltype(std::declval<Row&>().member)>(name, offsetof(Row, member), __VA_ARGS__)

inline constexpr const char* kVerdictNames = "no,yes,undecided";
inline constexpr const char* kStopReasonNames = "closed,beyond,rounding,budget";

inline constexpr const char* kPairText = "number of the pair";
inline constexpr const char* kItemText = "number of the item";
inline constexpr const char* kPoseText = "number of the pose in the item";
inline constexpr const char* kEndText = "why the search ended";

/// Writes 0 to the bytes of rows that are in no column, so that equal rows are equal byte for byte.
void clearGaps(std::span<const Column> columns, std::span<std::byte> rows, std::size_t stride);

template <class Row> AnswerTable tableOf(const char* name, std::span<const Column> columns, std::vector<Row> rows) {
    static_assert(std::is_trivially_copyable_v<Row>);
    clearGaps(columns, std::as_writable_bytes(std::span(rows)), sizeof(Row));
    const auto kept = std::make_shared<const std::vector<Row>>(std::move(rows));
    return {name, columns, kept, reinterpret_cast<const std::byte*>(kept->data()), kept->size(), sizeof(Row)};
}

/// A table of the results of `toRow`.
template <class From, class ToRow>
AnswerTable tableOf(const char* name, std::span<const Column> columns, const std::vector<From>& from,
                    const ToRow& toRow) {
    std::vector<decltype(toRow(from.front()))> rows;
    rows.reserve(from.size());
    std::ranges::transform(from, std::back_inserter(rows), toRow);
    return tableOf(name, columns, std::move(rows));
}

/// The table "totals" of a question that only counts time.
[[nodiscard]] AnswerTable totalsOf(double wallMilliseconds);

[[nodiscard]] AnswerTables toTables(TouchAnswer answer);
[[nodiscard]] AnswerTables toTables(BatchAnswer answer);
[[nodiscard]] AnswerTables toTables(DistanceAnswer answer);
[[nodiscard]] AnswerTables toTables(AreaAnswer answer);
[[nodiscard]] AnswerTables toTables(OverlapAnswer answer);
[[nodiscard]] AnswerTables toTables(MotionAnswer answer);
[[nodiscard]] AnswerTables toTables(PlanAnswer answer);

} // namespace voxtact

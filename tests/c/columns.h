// SPDX-License-Identifier: MIT
#pragma once

#include "support/c_calls.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <type_traits>

namespace voxtact::test {

/// A member as its column holds it.
template <class Value> auto asElement(const Value& value) {
    if constexpr (std::is_enum_v<Value> || std::same_as<Value, bool>) {
        return static_cast<std::uint32_t>(value);
    } else {
        return value;
    }
}

/// Of a row: a member of an optional member, else 0.
template <class Row, class Part, class Value>
auto ofOptional(std::optional<Part> Row::*part, Value Part::*member, std::type_identity_t<Value> otherwise = {}) {
    return [=](const Row& row) { return row.*part ? (*(row.*part)).*member : otherwise; };
}

/// Compares the columns of an answer with the members of the C++ answer, bit by bit. At the end all of them must have
/// been compared.
class Columns {
  public:
    explicit Columns(const vxt_answer& answer) : answer_(answer) {}
    ~Columns() { EXPECT_EQ(compared_, vxt_answer_columns(&answer_)) << "columns that nobody compared"; }
    Columns(const Columns&) = delete;
    Columns& operator=(const Columns&) = delete;

    /// `get`: a member of a row, or a function of one.
    template <class Row, class Get>
    void expect(const char* table, const char* name, const std::vector<Row>& rows, const Get& get) {
        using Element = decltype(asElement(std::invoke(get, rows.front())));
        ++compared_;
        const std::vector<Element> found = readColumn<Element>(answer_, table, name);
        ASSERT_EQ(found.size(), rows.size()) << table << " " << name;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            const Element expected = asElement(std::invoke(get, rows[row]));
            ASSERT_EQ(std::memcmp(&found[row], &expected, sizeof expected), 0)
                << table << " " << name << " " << row << ": " << testing::PrintToString(found[row]) << ", "
                << testing::PrintToString(expected);
        }
    }
    template <class Row> void expectBounds(const char* table, const std::vector<Row>& rows) {
        expect(table, "lower", rows, [](const Row& row) { return row.bounds.lower; });
        expect(table, "upper", rows, [](const Row& row) { return row.bounds.upper; });
        expect(table, "item", rows, &Row::item);
        expect(table, "pose", rows, &Row::pose);
        expect(table, "end", rows, &Row::end);
    }
    template <class Answer, class Get> void expectTotal(const char* name, const Answer& answer, const Get& get) {
        expect("totals", name, std::vector<Answer>{answer}, get);
    }
    /// The one number that two calls do not have in common.
    void expectTime() {
        ++compared_;
        const auto times = readColumn<double>(answer_, "totals", "wall_milliseconds");
        ASSERT_EQ(times.size(), 1U);
        EXPECT_GE(times[0], 0);
    }

  private:
    const vxt_answer& answer_;
    std::size_t compared_ = 0;
};

} // namespace voxtact::test

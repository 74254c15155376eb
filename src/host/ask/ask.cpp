// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/facts/facts.h"
#include "host/ask/ask_row.h"

#include <cstring>

namespace voxtact {

// Each in the file of its name.
extern const AskRow kAskTouch;
extern const AskRow kAskCount;
extern const AskRow kAskDistance;
extern const AskRow kAskArea;
extern const AskRow kAskOverlap;
extern const AskRow kAskMotion;

namespace {

const std::array kRows{&kAskTouch, &kAskCount, &kAskDistance, &kAskArea, &kAskOverlap, &kAskMotion};

std::string joined(std::span<const std::string_view> names) {
    std::string out;
    for (const std::string_view name : names) {
        out += (out.empty() ? "" : ", ") + std::string(name);
    }
    return out;
}

template <class Number> double read(const std::byte* from) noexcept {
    Number number{};
    std::memcpy(&number, from, sizeof number);
    return static_cast<double>(number);
}

} // namespace

void clearGaps(std::span<const Column> columns, std::span<std::byte> rows, std::size_t stride) {
    std::vector<char> isUsed(stride);
    for (const Column& column : columns) {
        const bool isLong = column.type == ColumnType::Uint64 || column.type == ColumnType::Double;
        const std::size_t bytes = column.elements * (isLong ? sizeof(std::uint64_t) : sizeof(std::uint32_t));
        std::fill_n(isUsed.begin() + static_cast<std::ptrdiff_t>(column.offset), bytes, char{1});
    }
    for (std::size_t byte = 0; byte < stride; ++byte) {
        for (std::size_t row = byte; isUsed[byte] == 0 && row < rows.size(); row += stride) {
            rows[row] = std::byte{0};
        }
    }
}

const Column* AnswerTable::column(std::string_view wanted) const noexcept {
    const auto found = std::ranges::find_if(columns, [&](const Column& column) { return column.name == wanted; });
    return found == columns.end() ? nullptr : &*found;
}

double AnswerTable::number(const Column& column, std::size_t row, std::size_t element) const noexcept {
    const std::byte* const begin = data + row * stride + column.offset;
    switch (column.type) {
    case ColumnType::Uint32:
        return read<std::uint32_t>(begin + element * sizeof(std::uint32_t));
    case ColumnType::Int32:
        return read<std::int32_t>(begin + element * sizeof(std::int32_t));
    case ColumnType::Uint64:
        return read<std::uint64_t>(begin + element * sizeof(std::uint64_t));
    case ColumnType::Double:
        break;
    }
    return read<double>(begin + element * sizeof(double));
}

double AnswerTable::number(std::string_view wanted, std::size_t row, std::size_t element) const noexcept {
    return number(*column(wanted), row, element);
}

const AnswerTable* AnswerTables::find(std::string_view name) const noexcept {
    const auto found = std::ranges::find_if(tables, [&](const AnswerTable& table) { return table.name == name; });
    return found == tables.end() ? nullptr : &*found;
}

const TableLayout* NamedQuestion::table(std::string_view wanted) const noexcept {
    const auto found = std::ranges::find_if(tables, [&](const TableLayout& table) { return table.name == wanted; });
    return found == tables.end() ? nullptr : &*found;
}

SettingReader::SettingReader(std::string_view question, std::span<const Setting> settings)
    : question_(question), settings_(settings) {}

void SettingReader::refuseValue(std::string_view name, const std::string& why) {
    if (error_.empty()) {
        error_ = std::string(question_) + ": the setting '" + std::string(name) + "' " + why;
    }
}

template <class Value> const Value* SettingReader::find(std::string_view name) {
    names_.push_back(name);
    const Value* found = nullptr;
    for (const Setting& setting : settings_) {
        if (setting.name != name) {
            continue;
        }
        if (found != nullptr) {
            refuseValue(name, "is given twice");
        }
        found = std::get_if<Value>(&setting.value);
        if (found == nullptr) {
            const Fact* const fact = findFact(question_, name);
            refuseValue(name, "has a value of another kind; it takes " +
                                  (fact == nullptr ? std::string("another") : rangeText(*fact)));
        }
    }
    return found;
}

const double* SettingReader::number(std::string_view name) {
    const double* const given = find<double>(name);
    const Fact* const fact = findFact(question_, name);
    if (given != nullptr && fact != nullptr) {
        const Result<void> checked = checkFact(*fact, *given);
        error_ = error_.empty() && !checked.ok() ? checked.error().text : error_;
    }
    return given;
}

SettingReader& SettingReader::operator()(std::string_view name, double& member) {
    const double* const given = number(name);
    member = given == nullptr ? member : *given;
    return *this;
}

SettingReader& SettingReader::operator()(std::string_view name, std::optional<double>& member) {
    if (const double* const given = number(name)) {
        member = *given;
    }
    return *this;
}

SettingReader& SettingReader::operator()(std::string_view name, bool& member) {
    const double* const given = number(name);
    member = given == nullptr ? member : *given == 1;
    return *this;
}

std::optional<std::uint64_t> SettingReader::whole(std::string_view name) {
    const double* const given = number(name);
    return given != nullptr && error_.empty() ? std::optional(static_cast<std::uint64_t>(*given)) : std::nullopt;
}

SettingReader& SettingReader::operator()(std::string_view name, std::uint32_t& member) {
    member = static_cast<std::uint32_t>(whole(name).value_or(member));
    return *this;
}

SettingReader& SettingReader::operator()(std::string_view name, std::uint64_t& member) {
    member = whole(name).value_or(member);
    return *this;
}

SettingReader& SettingReader::operator()(std::string_view name, std::vector<double>& member) {
    if (const auto* const given = find<std::span<const double>>(name)) {
        member.assign(given->begin(), given->end());
    }
    return *this;
}

SettingReader& SettingReader::operator()(std::string_view name, std::vector<std::int32_t>& member) {
    if (const auto* const given = find<std::span<const std::int32_t>>(name)) {
        member.assign(given->begin(), given->end());
    }
    return *this;
}

SettingReader& SettingReader::operator()(std::string_view name, std::optional<std::vector<std::int32_t>>& member) {
    if (const auto* const given = find<std::span<const std::int32_t>>(name)) {
        member.emplace(given->begin(), given->end());
    }
    return *this;
}

std::uint32_t SettingReader::choice(std::string_view name, std::uint32_t standard) {
    const auto* const given = find<std::string_view>(name);
    const Fact* const fact = findFact(question_, name);
    if (given == nullptr || fact == nullptr) {
        return standard;
    }
    std::uint32_t number = 0;
    for (std::string_view left = fact->choices; !left.empty(); ++number) {
        const std::string_view one = left.substr(0, left.find(','));
        if (one == *given) {
            return number;
        }
        left.remove_prefix(std::min(one.size() + 1, left.size()));
    }
    refuseValue(name, "is '" + std::string(*given) + "'; it is one of " + std::string(fact->choices));
    return standard;
}

Result<void> SettingReader::done() const {
    if (!error_.empty()) {
        return refuse(error_);
    }
    for (const Setting& setting : settings_) {
        if (std::ranges::find(names_, setting.name) == names_.end()) {
            return refuse(std::string(question_) + " has no setting '" + std::string(setting.name) + "'; it has " +
                          joined(names_));
        }
    }
    return {};
}

std::span<const NamedQuestion> namedQuestions() noexcept {
    static const std::array<NamedQuestion, kRows.size()> all = [] {
        std::array<NamedQuestion, kRows.size()> out;
        std::ranges::transform(kRows, out.begin(), [](const AskRow* row) { return row->facts; });
        return out;
    }();
    return all;
}

Result<AnswerTables> ask(cpu::HostEngine& engine, std::string_view question, std::span<const Setting> settings,
                         const cpu::Batch& batch) {
    return guard([&]() -> Result<AnswerTables> {
        for (const AskRow* const row : kRows) {
            if (row->facts.name == question) {
                SettingReader read(row->facts.name, settings);
                return row->ask(engine, read, batch);
            }
        }
        std::vector<std::string_view> names;
        std::ranges::transform(kRows, std::back_inserter(names), [](const AskRow* row) { return row->facts.name; });
        return refuse("there is no question '" + std::string(question) + "'; there are " + joined(names));
    });
}

namespace {

struct Totals {
    double wall_milliseconds;
};
constexpr std::array kTotals{
    VOXTACT_COLUMN(Totals, "wall_milliseconds", wall_milliseconds, "ms", "duration of the call")};

} // namespace

AnswerTable totalsOf(double wallMilliseconds) {
    return tableOf("totals", kTotals, std::vector<Totals>{{wallMilliseconds}});
}

} // namespace voxtact

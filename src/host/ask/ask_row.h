// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/try.h"
#include "host/ask/tables.h"

#include <string>

/// A question's row in the table of questions, and how it reads its settings.
namespace voxtact {

/// Copies the settings of a question to its members; finds those that no member takes. Each member's fact says which
/// kind of value it takes, and its range.
class SettingReader {
  public:
    /// Both must outlive it.
    SettingReader(std::string_view question, std::span<const Setting> settings);

    SettingReader& operator()(std::string_view name, double& member);
    SettingReader& operator()(std::string_view name, std::optional<double>& member);
    SettingReader& operator()(std::string_view name, bool& member);
    SettingReader& operator()(std::string_view name, std::uint32_t& member);
    SettingReader& operator()(std::string_view name, std::uint64_t& member);
    SettingReader& operator()(std::string_view name, std::vector<double>& member);
    SettingReader& operator()(std::string_view name, std::vector<std::int32_t>& member);
    SettingReader& operator()(std::string_view name, std::optional<std::vector<std::int32_t>>& member);
    /// A choice: its number among Fact::choices is that of the enumerator.
    template <class Choice>
    requires std::is_enum_v<Choice> SettingReader& operator()(std::string_view name, Choice& member) {
        member = static_cast<Choice>(choice(name, static_cast<std::uint32_t>(member)));
        return *this;
    }

    /// After the last member: the first error.
    [[nodiscard]] Result<void> done() const;

  private:
    template <class Value> const Value* find(std::string_view name);
    /// Return a value in the range of its fact; nothing if it is not given.
    [[nodiscard]] const double* number(std::string_view name);
    [[nodiscard]] std::optional<std::uint64_t> whole(std::string_view name);
    [[nodiscard]] std::uint32_t choice(std::string_view name, std::uint32_t standard);
    void refuseValue(std::string_view name, const std::string& why);

    std::string_view question_;
    std::span<const Setting> settings_;
    std::vector<std::string_view> names_; ///< of all members
    std::string error_;
};

/// A row of the table of questions.
struct AskRow {
    NamedQuestion facts;
    Result<AnswerTables> (*ask)(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch);
};

/// Asks a question whose members have been read.
template <class Question>
Result<AnswerTables> askRead(cpu::HostEngine& engine, const Question& question, const SettingReader& read,
                             const cpu::Batch& batch) {
    VOXTACT_TRY(read.done());
    auto answer = engine.ask(question, batch);
    VOXTACT_TRY(answer);
    return toTables(std::move(*answer));
}

} // namespace voxtact

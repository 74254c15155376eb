// SPDX-License-Identifier: MIT
#pragma once

#include "support/c_calls.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace voxtact::test {

/// A setting by its name and a value of any kind. Texts and lists must outlive it.
struct NamedValue {
    vxt_setting setting{};

    template <class Number>
    requires std::is_arithmetic_v<Number> NamedValue(const char* name, Number number) {
        setting.name = name;
        setting.number = static_cast<double>(number);
    }
    NamedValue(const char* name, const char* text) {
        setting.name = name;
        setting.text = text;
    }
    NamedValue(const char* name, std::span<const double> numbers) {
        setting.name = name;
        setting.numbers = numbers.data();
        setting.count = numbers.size();
    }
    NamedValue(const char* name, std::span<const std::int32_t> labels) {
        setting.name = name;
        setting.labels = labels.data();
        setting.count = labels.size();
    }
};

/// Settings of a question: `{{"max", 20}, {"projection", "certified"}}`.
class Settings {
  public:
    Settings(std::initializer_list<NamedValue> given) : Settings(std::span<const NamedValue>(), given) {}
    explicit Settings(std::span<const NamedValue> common, std::initializer_list<NamedValue> more = {}) {
        const auto toSetting = [](const NamedValue& one) { return one.setting; };
        std::ranges::transform(common, std::back_inserter(all_), toSetting);
        std::ranges::transform(more, std::back_inserter(all_), toSetting);
    }
    [[nodiscard]] const vxt_setting* data() const noexcept { return all_.data(); }
    [[nodiscard]] std::size_t size() const noexcept { return all_.size(); }

  private:
    std::vector<vxt_setting> all_;
};

/// Returns the names of all questions about pairs.
[[nodiscard]] inline std::vector<const char*> questionNames() {
    std::vector<const char*> names;
    vxt_question question = sized<vxt_question>();
    for (std::size_t i = 0; i < vxt_question_count(); ++i) {
        need(vxt_question_get(i, &question));
        names.push_back(question.name);
    }
    return names;
}

/// Returns the facts of a question.
[[nodiscard]] inline std::vector<vxt_fact> factsOf(std::string_view question) {
    std::vector<vxt_fact> facts;
    vxt_fact fact = sized<vxt_fact>();
    for (std::size_t i = 0; i < vxt_fact_count(); ++i) {
        need(vxt_fact_get(i, &fact));
        if (fact.question == question) {
            facts.push_back(fact);
        }
    }
    return facts;
}

/// Returns the first name of a choice: the default.
[[nodiscard]] inline std::string firstChoice(const vxt_fact& fact) {
    const std::string_view choices = fact.choices;
    return std::string(choices.substr(0, choices.find(',')));
}

} // namespace voxtact::test

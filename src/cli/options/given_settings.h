// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/label_words.h"
#include "core/facts/facts.h"
#include "voxtact/named_questions.h"

#include <map>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

/// The settings of a question as options.
namespace voxtact::app {

/// The settings of a question that the command line gives.
struct GivenSettings {
    std::string_view question;                    ///< its name, with static lifetime
    std::map<std::string_view, double> numbers{}; ///< of numbers and flags
    std::map<std::string_view, std::vector<double>> lists{};
    std::vector<LabelWord> labels{}; ///< of the fact "labels"

    /// Returns a number, its default, or infinity for an optional one; 0 if the question has no such setting.
    [[nodiscard]] double number(std::string_view name) const;
    /// Returns the table with the rows: of a list that is given, else "pairs".
    [[nodiscard]] std::string_view table() const;
    /// Returns all settings, with the numbers of the labels. Refers to both.
    [[nodiscard]] std::vector<Setting> all(std::span<const std::int32_t> labelNumbers) const;
};

/// Returns the option of a fact: "--any-opacity".
[[nodiscard]] std::string optionOf(const Fact& fact);
/// Returns the fact of the labels of a question; null if it has none.
[[nodiscard]] const Fact* labelFact(std::string_view question);
/// Adds the options of the facts of a question that have one. `settings` must outlive the parser.
void addSettings(CLI::App& parser, GivenSettings& settings);
/// Refuses settings that exclude each other; labels need a label map.
[[nodiscard]] Result<void> checkSettings(const GivenSettings& settings, bool hasLabelMap);

} // namespace voxtact::app

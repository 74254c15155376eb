// SPDX-License-Identifier: MIT
#include "cli/options/given_settings.h"

#include "cli/options/shared_options.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

static_assert(std::ranges::none_of(kFacts, [](const Fact& fact) { // addSettings() has no option for it
    return fact.kind == FactKind::Choice && !fact.option.empty();
}));

std::optional<std::string> parseLimits(const std::string& text, std::vector<double>& limits) {
    limits.clear();
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const std::optional<double> limit = parseFinite(std::string_view(text).substr(begin, comma - begin));
        if (!limit || (!limits.empty() && *limit <= limits.back())) {
            return "is not a list of ascending numbers, as 130,250,600";
        }
        limits.push_back(*limit);
        begin = comma + 1;
    }
    return limits.size() <= kMaxBandLimits
               ? std::optional<std::string>()
               : "has " + std::to_string(limits.size()) + " limits; the maximum is " + std::to_string(kMaxBandLimits);
}

bool isGiven(const GivenSettings& settings, const Fact& fact) {
    return settings.numbers.contains(fact.name) || settings.lists.contains(fact.name) ||
           (fact.kind == FactKind::Labels && !settings.labels.empty());
}

} // namespace

double GivenSettings::number(std::string_view name) const {
    if (const auto given = numbers.find(name); given != numbers.end()) {
        return given->second;
    }
    const Fact* const fact = findFact(question, name);
    return fact == nullptr ? 0 : fact->standard.value_or(kInfinity);
}

std::string_view GivenSettings::table() const {
    for (const Fact& fact : kFacts) {
        if (fact.question == question && !fact.table.empty() && isGiven(*this, fact)) {
            return fact.table;
        }
    }
    return "pairs";
}

std::vector<Setting> GivenSettings::all(std::span<const std::int32_t> labelNumbers) const {
    std::vector<Setting> out;
    for (const auto& [name, value] : numbers) {
        out.push_back({name, value});
    }
    for (const auto& [name, values] : lists) {
        out.push_back({name, std::span(values)});
    }
    if (!labels.empty()) {
        out.push_back({"labels", labelNumbers});
    }
    return out;
}

std::string optionOf(const Fact& fact) {
    return "--" + std::string(fact.option);
}

const Fact* labelFact(std::string_view question) {
    const Fact* const fact = findFact(question, "labels");
    return fact != nullptr && fact->kind == FactKind::Labels ? fact : nullptr;
}

void addSettings(CLI::App& parser, GivenSettings& settings) {
    for (const Fact& fact : kFacts) {
        if (fact.question != settings.question || fact.option.empty()) {
            continue;
        }
        const std::string option = optionOf(fact);
        const std::string help(fact.text);
        switch (fact.kind) {
        case FactKind::Number:
        case FactKind::Whole:
            addFact(parser, fact, [&settings, &fact](double value) { settings.numbers[fact.name] = value; });
            break;
        case FactKind::Flag:
            parser.add_flag_callback(
                option, [&settings, &fact] { settings.numbers[fact.name] = 1; }, help);
            break;
        case FactKind::Numbers:
            addText(
                parser, option.c_str(),
                [&settings, &fact](const std::string& text) { return parseLimits(text, settings.lists[fact.name]); },
                help, "V,V,...");
            break;
        case FactKind::Labels:
            parser.add_option(option, settings.labels, help)->delimiter(',')->type_name("LABEL,...");
            break;
        case FactKind::Choice:
            break;
        }
    }
}

Result<void> checkSettings(const GivenSettings& settings, bool hasLabelMap) {
    const Fact* const labels = labelFact(settings.question);
    if (labels == nullptr) {
        return {};
    }
    const bool byLabel = !settings.labels.empty();
    if (byLabel && !hasLabelMap) {
        return badArgument(optionOf(*labels) + ": it needs a label map; add --labels");
    }
    for (const Fact& fact : kFacts) {
        if (fact.question != settings.question || !isGiven(settings, fact)) {
            continue;
        }
        if (fact.withLabels == WithLabels::Only && !byLabel) {
            return badArgument(optionOf(fact) + ": it needs labels; add " + optionOf(*labels));
        }
        if (fact.withLabels == WithLabels::Never && byLabel) {
            return badArgument(optionOf(fact) + ": not with " + optionOf(*labels) + "; leave out one of the two");
        }
    }
    return {};
}

} // namespace voxtact::app

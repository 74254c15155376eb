// SPDX-License-Identifier: MIT
#include "core/facts/facts.h"

#include "core/base/refuse.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

std::string withUnit(const std::string& text, const Fact& fact) {
    return fact.unit.empty() ? text : text + " " + std::string(fact.unit);
}

} // namespace

const Fact* findFact(std::string_view question, std::string_view name) noexcept {
    const auto* const found =
        std::ranges::find_if(kFacts, [&](const Fact& fact) { return fact.question == question && fact.name == name; });
    return found == kFacts.end() ? nullptr : found;
}

std::string rangeText(const Fact& fact) {
    if (fact.kind == FactKind::Flag || fact.kind == FactKind::Choice) {
        return std::string(fact.kind == FactKind::Flag ? "0 or 1" : fact.choices);
    }
    if (fact.kind == FactKind::Numbers || fact.kind == FactKind::Labels) {
        return "a list";
    }
    const std::string least = number(fact.min);
    if (fact.max < kMaxWhole) {
        return "from " + least + " to " + withUnit(number(fact.max), fact);
    }
    return fact.isMinAllowed ? "from " + withUnit(least, fact) + " on" : "above " + withUnit(least, fact);
}

bool isInRange(const Fact& fact, double value) noexcept {
    const bool isWhole = fact.kind == FactKind::Whole || fact.kind == FactKind::Flag;
    if (isWhole && value != std::floor(value)) {
        return false;
    }
    const bool isLow = fact.isMinAllowed ? !(value >= fact.min) : !(value > fact.min);
    return !isLow && value <= fact.max && (value < kInfinity || fact.isInfinityAllowed);
}

Result<void> checkFact(const Fact& fact, double value) {
    if (isInRange(fact, value)) {
        return {};
    }
    std::string name(fact.name);
    std::ranges::replace(name, '_', ' ');
    const bool isFlag = fact.kind == FactKind::Flag;
    return refuse("the " + name + " " + withUnit(number(value), fact) +
                  (isFlag                         ? " is not "
                   : fact.kind == FactKind::Whole ? " is not a whole number "
                                                  : " is not a number ") +
                  rangeText(fact));
}

} // namespace voxtact

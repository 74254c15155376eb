// SPDX-License-Identifier: MIT
#include "core/facts/facts.h"

#include "core/base/refuse.h"
#include "core/base/text.h"

#include <algorithm>

namespace voxtact {

namespace {

std::string withUnit(const std::string& text, const Fact& fact) {
    return fact.unit.empty() ? text : text + " " + std::string(fact.unit);
}

} // namespace

std::string rangeText(const Fact& fact) {
    const std::string least = number(fact.min);
    if (fact.max < kInfinity) {
        return "from " + least + " to " + withUnit(number(fact.max), fact);
    }
    return fact.isMinAllowed ? "from " + withUnit(least, fact) + " on" : "above " + withUnit(least, fact);
}

bool isInRange(const Fact& fact, double value) noexcept {
    const bool isLow = fact.isMinAllowed ? !(value >= fact.min) : !(value > fact.min);
    return !isLow && value <= fact.max && (value < kInfinity || fact.isInfinityAllowed);
}

Result<void> checkFact(const Fact& fact, double value) {
    if (isInRange(fact, value)) {
        return {};
    }
    std::string name(fact.name);
    std::ranges::replace(name, '_', ' ');
    return refuse("the " + name + " " + withUnit(number(value), fact) + " is not a number " + rangeText(fact));
}

} // namespace voxtact

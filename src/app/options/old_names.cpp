// SPDX-License-Identifier: MIT
#include "app/options/old_names.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace voxtact::app {

namespace {

struct OldName {
    std::array<std::string_view, 2> command; ///< its words; the second may be empty
    std::string_view old;
    std::string_view now;
};

constexpr std::array kOldNames{
    OldName{{"make", "poses"}, "--count", "--number"},
    OldName{{"compare", ""}, "--count", "--number"},
    OldName{{"compare", ""}, "--repeats", "--repetitions"},
    OldName{{"bench", ""}, "--poses", "--number"},
};

bool isOf(std::span<const std::string> arguments, const std::array<std::string_view, 2>& command) {
    const std::size_t words = command[1].empty() ? 1 : 2;
    return arguments.size() >= words && std::ranges::equal(arguments.first(words), std::span(command).first(words));
}

/// All of the old names were of numbers; with another value it is not they that are meant.
bool isNumber(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

} // namespace

std::vector<std::string> withNewNames(std::vector<std::string> arguments) {
    for (const OldName& name : kOldNames) {
        if (!isOf(arguments, name.command)) {
            continue;
        }
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            const std::string_view argument = arguments[i];
            const std::string_view option = argument.substr(0, argument.find('='));
            const std::string_view value = option.size() < argument.size() ? argument.substr(option.size() + 1)
                                           : i + 1 < arguments.size()      ? std::string_view(arguments[i + 1])
                                                                           : std::string_view();
            if (option == name.old && isNumber(value)) {
                arguments[i].replace(0, option.size(), name.now);
            }
        }
    }
    return arguments;
}

} // namespace voxtact::app

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

} // namespace

std::vector<std::string> withNewNames(std::vector<std::string> arguments) {
    for (const OldName& name : kOldNames) {
        if (!isOf(arguments, name.command)) {
            continue;
        }
        for (std::string& argument : arguments) {
            const std::string_view option = std::string_view(argument).substr(0, argument.find('='));
            if (option == name.old) {
                argument.replace(0, option.size(), name.now);
            }
        }
    }
    return arguments;
}

} // namespace voxtact::app

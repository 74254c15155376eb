// SPDX-License-Identifier: MIT
#include "cli/options/help_format.h"

#include "cli/options/shared_options.h"

#include <sstream>

namespace voxtact::app {

namespace {

constexpr std::size_t kLineColumns = 80;
/// Column where the texts of options begin.
constexpr std::size_t kTextColumn = 27;

} // namespace

std::string HelpFormat::make_footer(const CLI::App* app) const {
    return app->get_footer().empty() ? "" : app->get_footer() + '\n';
}

std::string HelpFormat::make_option(const CLI::Option* option, bool isPositional) const {
    std::string line = "  " + make_option_name(option, isPositional);
    if (option->get_type_size() != 0) {
        line += " " + option->get_type_name();
    }
    std::string text = make_option_desc(option);
    if (!option->get_default_str().empty()) {
        text += "; default: " + option->get_default_str();
    }
    if (option->get_required()) {
        text += "; required";
    }
    if (line.size() + 1 > kTextColumn) {
        line += '\n' + std::string(kTextColumn - 1, ' ');
    } else {
        line.resize(kTextColumn - 1, ' ');
    }
    std::string out;
    std::size_t column = kTextColumn - 1;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (column + 1 + word.size() > kLineColumns) {
            out += line + '\n';
            line.assign(kTextColumn - 1, ' ');
            column = kTextColumn - 1;
        }
        line += ' ' + word;
        column += 1 + word.size();
    }
    return out + line + '\n';
}

std::string HelpFormat::make_group(std::string group, bool isPositional,
                                   std::vector<const CLI::Option*> options) const {
    const bool isHidden = group == kRareOptions && !all_;
    return isHidden ? "" : CLI::Formatter::make_group(std::move(group), isPositional, std::move(options));
}

} // namespace voxtact::app

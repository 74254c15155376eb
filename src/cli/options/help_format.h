// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace voxtact::app {

/// Formats `--help`: lines of at most 80 columns, the default after the text of an option.
class HelpFormat : public CLI::Formatter {
  public:
    /// `all`: include rare options, as for --help-all.
    explicit HelpFormat(bool all) : all_(all) {}

    [[nodiscard]] std::string make_group(std::string group, bool isPositional,
                                         std::vector<const CLI::Option*> options) const override;
    [[nodiscard]] std::string make_option(const CLI::Option* option, bool isPositional) const override;
    [[nodiscard]] std::string make_footer(const CLI::App* app) const override;

  private:
    bool all_;
};

} // namespace voxtact::app

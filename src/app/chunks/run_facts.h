// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/output_paths.h"

#include <string>
#include <utility>
#include <vector>

/// What makes a run the one that it is: two processes may do parts of one run only where all of this is the same.
namespace voxtact::app {

/// A name and what it is: "--threshold" and "0.2".
using RunFacts = std::vector<std::pair<std::string, std::string>>;

/// Adds the options that were given, in the order of --help, but those of `without`: all of them, so that one which is
/// new need not be thought of.
void addOptionFacts(RunFacts& facts, const CLI::App& parser, const std::vector<std::string>& without);

/// Adds the length and hash of all that is read: of a folder all its files, of a header also the files that it names.
[[nodiscard]] Result<void> addInputFacts(RunFacts& facts, const std::vector<NamedPath>& inputs);

/// The files that addInputFacts() has added, by the paths that the run was given; they need not be there any more.
[[nodiscard]] std::vector<NamedPath> inputsOf(const RunFacts& facts);

/// What differs, as a message says it: "its --threshold is '0.2', here it is not given"; empty: nothing does.
[[nodiscard]] std::string differenceOf(const RunFacts& its, const RunFacts& here);

} // namespace voxtact::app

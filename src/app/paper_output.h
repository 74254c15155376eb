// SPDX-License-Identifier: MIT
#pragma once

#include "app/bench.h"
#include "app/paper_result.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace voxtact::app {

/// Of the intervals for medians, at least.
inline constexpr double kConfidence = 0.95;

/// Three significant digits, without an exponent.
[[nodiscard]] std::string shortNumber(double value);

/// What was found, in plain English, a sentence each: the agreement, then what detection adds, then the rest.
[[nodiscard]] std::vector<std::string> paperSummary(const PaperResult& result);

/// The whole result as one object.
[[nodiscard]] nlohmann::ordered_json paperJson(const BenchOptions& options, const PaperResult& result);

/// CSV: a row for each scene, method and clock, and everything else in comments. Text: tables like the paper's.
void writePaper(std::ostream& out, const BenchOptions& options, const PaperResult& result);

} // namespace voxtact::app

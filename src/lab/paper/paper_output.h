// SPDX-License-Identifier: MIT
#pragma once

#include "io/text/table.h"
#include "lab/paper/paper_result.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace voxtact::lab {

/// Of the intervals for medians, at least.
inline constexpr double kConfidence = 0.95;

/// Three significant digits, without an exponent.
[[nodiscard]] std::string shortNumber(double value);

/// The median of what detection adds to a frame, percent: "2.6", or "noise" where it is below 0, since detection adds
/// no less than nothing. Then the interval that holds it, or that there are too few samples for one. At least one
/// sample.
[[nodiscard]] std::string overheadText(const std::vector<double>& percents);

/// What was found, in plain English, a sentence each: the agreement, then what detection adds, then the rest.
[[nodiscard]] std::vector<std::string> paperSummary(const PaperResult& result);

/// The whole result as one object.
[[nodiscard]] nlohmann::ordered_json paperJson(const PaperResult& result);

/// CSV: a row for each scene, method and clock, and everything else in comments. Text: tables like the paper's.
void writePaper(std::ostream& out, io::Format format, const PaperResult& result);

} // namespace voxtact::lab

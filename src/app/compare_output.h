// SPDX-License-Identifier: MIT
#pragma once

#include "app/compare_result.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace voxtact::app {

/// What was found, in plain English, a sentence each: the agreement, then the speed.
[[nodiscard]] std::vector<std::string> summarize(const CompareResult& result);

/// The whole result as one object.
[[nodiscard]] nlohmann::ordered_json compareJson(const CompareOptions& options, const CompareData& data,
                                                 const CompareResult& result);

/// One row a series for CSV and text.
void writeCompare(std::ostream& out, const CompareOptions& options, const CompareData& data,
                  const CompareResult& result);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <string>

namespace voxtact::lab {

/// Writes a measurement's JSON as one static HTML page: its summary, a table for each list of rows with the medians of
/// their times, and a diagram of the batches' rates.
void writeReport(std::ostream& out, const std::string& title, const nlohmann::ordered_json& data);

} // namespace voxtact::lab

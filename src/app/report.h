// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/result.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <string>
#include <vector>

namespace voxtact::app {

/// Unsupported where the program was built without the library that draws the charts.
[[nodiscard]] Result<void> reportPossible();

/// An HTML page in one file: the summary as text, and charts and tables made of `data` (compareJson()).
[[nodiscard]] Result<void> writeReport(std::ostream& out, const std::vector<std::string>& summary,
                                       const nlohmann::ordered_json& data);

} // namespace voxtact::app

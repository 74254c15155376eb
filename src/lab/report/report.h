// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <string>
#include <vector>

namespace voxtact::lab {

/// Unsupported where the program was built without the library that draws the charts.
[[nodiscard]] Result<void> reportPossible();

enum class ReportKind {
    Compare, ///< of compareJson()
    Paper,   ///< of paperJson()
};

/// An HTML page in one file: the summary as text, and charts and tables made of `data`.
[[nodiscard]] Result<void> writeReport(std::ostream& out, ReportKind kind, const std::vector<std::string>& summary,
                                       const nlohmann::ordered_json& data);

} // namespace voxtact::lab

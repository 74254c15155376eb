// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace voxtact::lab {

/// Unsupported where the program was built without the library that draws the charts.
[[nodiscard]] Result<void> reportPossible();

enum class ReportKind {
    Compare, ///< of compareOutput()
    Paper,   ///< of paperJson()
};

/// An HTML page in one file, made of the measurement's JSON: its summary as text, and charts and tables.
[[nodiscard]] Result<void> writeReport(std::ostream& out, ReportKind kind, const nlohmann::ordered_json& data);

} // namespace voxtact::lab

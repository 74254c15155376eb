// SPDX-License-Identifier: MIT
#pragma once

#include "app/output_paths.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace voxtact::app {

/// checkOutputs() of both, each of them may be empty. Unsupported where there is to be a report, and the program was
/// built without the library that draws the charts.
[[nodiscard]] Result<void> checkReportPaths(const std::filesystem::path& output, const std::filesystem::path& report,
                                            const std::vector<NamedPath>& inputs);

enum class ReportKind {
    Compare, ///< of compareJson()
    Paper,   ///< of paperJson()
};

/// An HTML page in one file: the summary as text, and charts and tables made of `data`.
[[nodiscard]] Result<void> writeReport(std::ostream& out, ReportKind kind, const std::vector<std::string>& summary,
                                       const nlohmann::ordered_json& data);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

/// Files that are part of the program (embed_text.cmake). The chart library is the installed package's, and both its
/// texts are empty where that was not there at configuration.
namespace voxtact::lab {

extern const std::string_view kReportFrame;
extern const std::string_view kReportStyle;
extern const std::string_view kReportCommon;
extern const std::string_view kCompareBody;
extern const std::string_view kCompareScript;
extern const std::string_view kPaperBody;
extern const std::string_view kPaperScript;
extern const std::string_view kChartLibrary;
extern const std::string_view kChartLicence;

} // namespace voxtact::lab

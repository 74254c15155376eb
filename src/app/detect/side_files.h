// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect/detect_run.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <iosfwd>

/// The files of rows that `voxtact detect` writes in addition to its table, and that a run in chunks has, too: all that
/// is known of each, but how a row is written (detect_files.h).
namespace voxtact::app {

enum class SideFile : std::size_t { Triangles, Closest, LabelClearance, LabelArea, TriangleArea };
inline constexpr std::size_t kSideFiles = 5;

struct SideFileFacts {
    SideFile file;
    const char* option; ///< that asks for it
    /// Empty: it is not asked for.
    const std::filesystem::path& (*path)(const DetectOptions& options);
    /// Writes the line above the rows.
    void (*header)(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs);
    const char* ending; ///< that it must have in a run in chunks; empty: any
    bool comesLast;     ///< it is written when all rows are known: what is above them depends on them
};

/// By the number of a SideFile.
[[nodiscard]] const std::array<SideFileFacts, kSideFiles>& sideFileTable() noexcept;

/// Their options and paths.
[[nodiscard]] MergePaths sideFiles(const DetectOptions& options);

} // namespace voxtact::app

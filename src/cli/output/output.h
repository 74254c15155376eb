// SPDX-License-Identifier: MIT
#pragma once

#include "io/text/table.h"
#include "voxtact/error.h"

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::app {

/// Destination of a command's output.
struct OutputOptions {
    std::filesystem::path path; ///< empty: standard output
    std::string formatName;     ///< empty: text on a terminal, else CSV

    [[nodiscard]] io::Format format() const;
};

/// Column of commands with --resample: whether the volume was resampled.
inline constexpr const char* kResampledColumn = "resampled";
[[nodiscard]] inline io::Cell resampledCell(bool isResampled) {
    return isResampled ? io::NumberWord{1, "yes"} : io::NumberWord{0, "no"};
}

/// Checks that `path` can be written, without writing, before any work. An empty path is valid.
[[nodiscard]] Result<void> checkOutput(const std::filesystem::path& path);

/// Refuses two of the named paths ("--output", path) that are one file; empty ones, devices and pipes are not
/// examined.
[[nodiscard]] Result<void> checkDistinct(const std::vector<std::pair<std::string, std::filesystem::path>>& paths);

/// Calls `write`, and puts what it wrote in `path` (a temporary file, renamed; devices and pipes are written as they
/// are) or, where that is empty, on standard output. Nothing is put there when `write` fails.
[[nodiscard]] Result<void> deliver(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);

/// An output path and its writer.
struct Delivery {
    std::filesystem::path path;
    std::function<Result<void>(std::ostream&)> write;
};

/// deliver() of several: nothing is put anywhere before all are written, and standard output comes first.
[[nodiscard]] Result<void> deliverAll(std::vector<Delivery> deliveries);

} // namespace voxtact::app

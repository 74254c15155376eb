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

/// Column of commands with --resample: 1 if the volume was resampled.
inline constexpr const char* kResampledColumn = "resampled";
[[nodiscard]] inline io::Cell resampledCell(bool isResampled) {
    return isResampled ? io::NumberWord{1, "yes"} : io::NumberWord{0, "no"};
}

/// Checks that `path` can be written, without writing, before any work. An empty path is valid.
[[nodiscard]] Result<void> checkOutput(const std::filesystem::path& path);

/// Refuses two named paths ("--output", path) of one file; ignores empty paths, devices and pipes.
[[nodiscard]] Result<void> checkDistinct(const std::vector<std::pair<std::string, std::filesystem::path>>& paths);

/// Calls `write` and delivers its output to `path` (via a temporary file; devices and pipes directly), or to standard
/// output if `path` is empty. Delivers nothing if `write` fails.
[[nodiscard]] Result<void> deliver(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);

/// An output path and its writer.
struct Delivery {
    std::filesystem::path path;
    std::function<Result<void>(std::ostream&)> write;
};

/// Delivers several outputs: none before all are written, standard output first.
[[nodiscard]] Result<void> deliverAll(std::vector<Delivery> deliveries);

} // namespace voxtact::app

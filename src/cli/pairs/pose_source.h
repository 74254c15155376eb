// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "voxtact/io.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// Reads the poses of a file or of standard input in parts, as often as needed. Memory does not grow with their number.
class PoseSource {
  public:
    /// Opens poses. Without a path: the identity. "-": standard input, read on demand, or completely if `again`. Checks
    /// a file completely first, so that its errors precede all answers. Returns poses in LPS.
    [[nodiscard]] static Result<PoseSource> open(const ViewOptions& how, bool again);

    /// Returns the number of poses, if known.
    [[nodiscard]] std::optional<std::uint64_t> count() const noexcept { return count_; }

    /// Starts at pose `from`, which must be below count(), or 0. Moving forward reads nothing twice.
    [[nodiscard]] Result<void> begin(std::uint64_t from = 0);
    /// Replaces `poses` by the next poses, at most `max`; empty at the end.
    [[nodiscard]] Result<void> next(std::size_t max, std::vector<Mat4>& poses);

  private:
    PoseSource() = default;
    [[nodiscard]] Result<void> takeStock();
    [[nodiscard]] Result<io::PoseReader> reader() const;

    std::filesystem::path path_;
    std::string space_;
    io::PoseFormat format_ = io::PoseFormat::Matrix;
    std::optional<std::uint64_t> count_;
    std::vector<Mat4> kept_; ///< all poses, if few
    bool isKept_ = false;
    std::optional<io::PoseReader> reader_;
    std::uint64_t given_ = 0; ///< since begin()
};

} // namespace voxtact::app

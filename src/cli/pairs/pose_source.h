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

/// The poses of a file or of standard input, some at a time and as often as they are needed: memory does not grow with
/// their number.
class PoseSource {
  public:
    /// Opens poses. Without a path: the identity. "-": standard input, read on demand, or at once if it is needed
    /// `again`. A file is read completely first, so that its errors precede all answers. Poses are returned in LPS.
    [[nodiscard]] static Result<PoseSource> open(const ViewOptions& how, bool again);

    /// Returns the number of poses, if known.
    [[nodiscard]] std::optional<std::uint64_t> count() const noexcept { return count_; }

    /// Starts at pose `from`, which must be below count(), or 0. Moving forward reads nothing twice.
    [[nodiscard]] Result<void> begin(std::uint64_t from = 0);
    /// Replaces `poses` by the next ones, at most `most`; empty at the end.
    [[nodiscard]] Result<void> next(std::size_t most, std::vector<Mat4>& poses);

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

// SPDX-License-Identifier: MIT
#pragma once

#include "cli/motion/motion_run.h"
#include "core/base/text_stream.h"
#include "io/text/table.h"
#include "voxtact/io.h"

#include <memory>
#include <optional>
#include <span>

namespace voxtact::app {

/// Output of `voxtact motion`: rows on standard output immediately, a file after success. Thread-safety: none; one
/// thread at a time.
class MotionOutput {
  public:
    /// Opens the file. Both arguments must outlive the output.
    [[nodiscard]] static Result<std::unique_ptr<MotionOutput>> create(const MotionOptions& options,
                                                                      const MotionInputs& inputs);

    /// Appends rows.
    [[nodiscard]] Result<void> add(std::span<const MotionRow> rows);
    [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
    [[nodiscard]] const MotionEnds& ends() const noexcept { return ends_; }

    /// Completes the output and renames the file into place. `wallMilliseconds`: for --timing.
    [[nodiscard]] Result<void> finish(double wallMilliseconds);
    /// Completes standard output after an interrupt; writes no file.
    [[nodiscard]] Result<void> breakOff();
    /// After an error: closes a JSON document on standard output, so that it stays readable.
    [[nodiscard]] Result<void> fail();

  private:
    MotionOutput(const MotionOptions& options, const MotionInputs& inputs, std::optional<io::OutputFile> file);
    [[nodiscard]] Result<void> pass();

    const MotionOptions& options_;
    const MotionInputs& inputs_;
    std::optional<io::OutputFile> file_;
    TextStream text_; ///< pending for standard output
    io::TableWriter writer_;
    io::NamedCells facts_; ///< JSON members before the rows
    std::uint64_t rows_ = 0;
    MotionEnds ends_;
};

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_output.h"
#include "cli/pairs/pair_window.h"

#include <span>

namespace voxtact::app {

/// Rows of all pairs of a window; unselected pairs get the answer "no". Writes rows in order, as soon as they are
/// known.
class WindowRows {
  public:
    /// `untouched`: the answer of unselected pairs. All arguments must outlive the object.
    WindowRows(const PairOptions& options, const Window& window, const PairAnswer& untouched, PairOutput& output);

    /// Adds the answer for a selected pose of an item, in order.
    void add(const device::TimedAnswer& timed);
    /// Sets the time per pair, milliseconds, of the pairs added since the last endBatch().
    void setTime(double milliseconds);
    /// Sets the witness point of a pair, by its index in the batch.
    void addWitness(std::uint32_t pair, const WitnessPoint& witness);
    /// Adds the tables of a measuring question for `pairs`.
    void addMeasured(const AnswerTables& answer);
    /// Adds the additional answers of the pairs added since the last call. Writes the rows up to the last of these
    /// pairs; with --timing only at the end of the window, so that times exclude writing.
    void endBatch(const BatchAnswer& answer);
    /// Completes the window: all selected pairs are answered.
    void endWindow();

    [[nodiscard]] std::span<const Row> rows() const noexcept { return rows_; }
    /// Returns the result of writing the rows.
    [[nodiscard]] const Result<void>& written() const noexcept { return written_; }

  private:
    void deliver(std::size_t end);

    const PairOptions& options_;
    const Window& window_;
    PairOutput& output_;
    std::vector<Row> rows_;
    std::vector<std::size_t> firstRows_; ///< of each item
    std::vector<std::uint32_t> batch_;   ///< rows of the pairs of the current batch
    std::size_t delivered_ = 0;
    Result<void> written_;
};

} // namespace voxtact::app

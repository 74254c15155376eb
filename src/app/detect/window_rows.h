// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect/detect_output.h"
#include "app/detect/pair_window.h"

#include <span>

namespace voxtact::app {

/// The rows of a window: every pair, those that are not selected with the answer that nothing touches. They go to the
/// output in order, as soon as they are known.
class WindowRows {
  public:
    /// `untouched` says by which method and in which projection. All arguments must outlive it.
    WindowRows(const DetectOptions& options, const Window& window, const PairAnswer& untouched, DetectOutput& output);

    /// The answer for a selected pose of an item; in order.
    void add(const device::TimedAnswer& timed);
    /// The clearance of the pair that was added as this number of its batch.
    void addClearance(const PairClearance& clearance);
    /// The same of one of its labels; in order.
    void addClearance(const LabelClearance& clearance);
    /// The contact area of such a pair.
    void addArea(const PairArea& area);
    /// The same of one of its labels; in order.
    void addArea(const LabelArea& area);
    /// The same of one of its triangles; in order.
    void addArea(const TriangleArea& area);
    /// The answers in addition to the counts of the pairs that were added since the last time. The rows up to the last
    /// of these are known now; with --timing they wait for the end of the window, so that no time is of writing them.
    void endBatch(const BatchAnswer& answer);
    /// All that was selected has been answered.
    void endWindow();

    [[nodiscard]] std::span<const Row> rows() const noexcept { return rows_; }
    /// Whether the output took all rows.
    [[nodiscard]] const Result<void>& written() const noexcept { return written_; }

  private:
    void deliver(std::size_t end);

    const DetectOptions& options_;
    const Window& window_;
    DetectOutput& output_;
    std::vector<Row> rows_;
    std::vector<std::size_t> firstRows_; ///< of each item
    std::vector<std::uint32_t> batch_;   ///< rows of the pairs of the current batch
    std::size_t delivered_ = 0;
    Result<void> written_;
};

} // namespace voxtact::app

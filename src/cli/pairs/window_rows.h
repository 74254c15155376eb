// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_output.h"
#include "cli/pairs/pair_window.h"

#include <span>

namespace voxtact::app {

/// The rows of a window: every pair, those that are not selected with the answer that nothing touches. They go to the
/// output in order, as soon as they are known.
class WindowRows {
  public:
    /// `untouched` says by which method and in which projection. All arguments must outlive it.
    WindowRows(const PairOptions& options, const Window& window, const PairAnswer& untouched, PairOutput& output);

    /// The answer for a selected pose of an item; in order.
    void add(const device::TimedAnswer& timed);
    /// Sets the time per pair, milliseconds, of the pairs added since the last endBatch().
    void setTime(double milliseconds);
    /// The witness point of the pair that was added as this number of its batch.
    void addWitness(std::uint32_t pair, const WitnessPoint& witness);
    /// The distance of such a pair.
    void addDistance(const PairDistance& distance);
    /// Like addDistance(), to one label; in order.
    void addDistance(const LabelDistance& distance);
    /// The contact area of such a pair.
    void addArea(const PairArea& area);
    /// Like addArea(), in one label; in order.
    void addArea(const LabelArea& area);
    /// Like addArea(), of one triangle; in order.
    void addArea(const TriangleArea& area);
    /// Adds the overlap of a pair, or of one of its labels or bands; in order.
    void addOverlap(const PairOverlap& overlap);
    void addOverlap(const LabelOverlap& overlap);
    void addOverlap(const BandOverlap& overlap);
    /// The answers in addition to the counts of the pairs that were added since the last time. The rows up to the last
    /// of these are known now; with --timing they wait for the end of the window, so that no time is of writing them.
    void endBatch(const BatchAnswer& answer);
    /// All that was selected has been answered.
    void endWindow();

    [[nodiscard]] std::span<const Row> rows() const noexcept { return rows_; }
    /// Result of the output of all rows.
    [[nodiscard]] const Result<void>& written() const noexcept { return written_; }

  private:
    template <class Distance> void keepDistance(const Distance& distance, std::int32_t label);
    template <class Area> void keepArea(const Area& area, std::int32_t label);
    template <class Overlap> Measured& keepOverlap(const Overlap& overlap);
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

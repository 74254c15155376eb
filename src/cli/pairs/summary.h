// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <span>
#include <string>

namespace voxtact::app {

/// The line of --summary: totals, and the worst pair.
class Summary {
  public:
    void add(const PairOptions& options, std::span<const Row> rows);
    /// One line.
    [[nodiscard]] std::string text(const PairOptions& options) const;

  private:
    void addMeasured(const PairOptions& options, const Row& row, const Measured& measured);

    std::uint64_t pairs_ = 0;
    std::uint64_t yes_ = 0;
    std::uint64_t undecided_ = 0;
    /// The first pair with the largest count, the smallest upper bound of the distance, or the largest of the area.
    std::optional<Row> worst_;
    Measured extreme_; ///< of that pair
};

} // namespace voxtact::app

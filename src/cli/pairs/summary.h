// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <span>
#include <string>

namespace voxtact::app {

/// Totals and the worst pair, for --summary.
class Summary {
  public:
    void add(const PairOptions& options, std::span<const Row> rows);
    /// Returns the line of --summary.
    [[nodiscard]] std::string text(const PairOptions& options) const;

  private:
    void addMeasured(const PairOptions& options, const Row& row, const Measured& measured);

    std::uint64_t pairs_ = 0;
    std::uint64_t yes_ = 0;
    std::uint64_t undecided_ = 0;
    /// The first pair with the largest count, or the worst bounds.
    std::optional<Row> worst_;
    Bounds extreme_; ///< of that pair
};

} // namespace voxtact::app

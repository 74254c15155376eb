// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <functional>
#include <span>

namespace voxtact::app {

/// Columns of the pair subcommands.
class PairColumns {
  public:
    /// Both arguments must outlive the table.
    PairColumns(const PairOptions& options, const PairInputs& inputs);

    /// Returns a table of `rows`, which references them and this object.
    [[nodiscard]] io::Table table(std::span<const Row> rows) const;

  private:
    /// A row of the table: a pair, or one of its labels or bands.
    struct Line {
        const Row* row;
        const Measured* measured; ///< null: none
    };
    struct PrintedColumn {
        std::string name;
        std::function<io::Cell(const Line&)> cell;
    };
    void addTouch(const PairInputs& inputs);
    void addCount(const PairOptions& options, const PairInputs& inputs);
    void addMeasured(const PairOptions& options, const PairInputs& inputs);

    std::vector<PrintedColumn> columns_;
    std::vector<std::string> names_;
};

/// Returns the cells of --stats.
[[nodiscard]] io::NamedCells statsCells(const CertifiedCounters& counters);
/// Returns the JSON members before the rows: program, engine, and the question with its settings.
[[nodiscard]] io::NamedCells pairFacts(const PairOptions& options, const std::string& device,
                                       const std::string& driver);

} // namespace voxtact::app

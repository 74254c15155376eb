// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <functional>
#include <span>

namespace voxtact::app {

/// The columns of the output of a subcommand about pairs.
class PairColumns {
  public:
    /// Both must outlive it.
    PairColumns(const PairOptions& options, const PairInputs& inputs);

    /// Returns a table of these rows, which refers to them and to this object.
    [[nodiscard]] io::Table table(std::span<const Row> rows) const;

  private:
    /// A row of the table: a pair, or one of its labels.
    struct Line {
        const Row* row;
        const Measured* measured; ///< null: none
    };
    struct Column {
        std::string name;
        std::function<io::Cell(const Line&)> cell;
    };
    void addTouch(const PairInputs& inputs);
    void addCount(const PairOptions& options, const PairInputs& inputs);
    void addMeasured(const PairOptions& options, const PairInputs& inputs);

    std::vector<Column> columns_;
    std::vector<std::string> names_;
};

/// The cells of --stats.
[[nodiscard]] io::NamedCells statsCells(const CertifiedCounters& counters);
/// The JSON members before the rows: program, engine, and the question with its values.
[[nodiscard]] io::NamedCells pairFacts(const PairOptions& options, const std::string& device,
                                       const std::string& driver);

} // namespace voxtact::app

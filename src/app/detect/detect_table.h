// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect/detect_run.h"

#include <functional>
#include <span>

namespace voxtact::app {

/// The columns of the rows of `voxtact detect`.
class DetectColumns {
  public:
    /// Both must outlive it.
    DetectColumns(const DetectOptions& options, const DetectInputs& inputs);

    /// A table of these rows. It refers to them and to this object.
    [[nodiscard]] io::Table table(std::span<const Row> rows) const;

  private:
    struct Column {
        std::string name;
        std::function<io::Cell(const Row&)> cell;
    };
    void addClearance();
    void addArea(double tolerance);

    std::vector<Column> columns_;
    std::vector<std::string> names_;
};

/// What --stats tells.
[[nodiscard]] io::NamedCells statsCells(const CertifiedCounters& counters);
/// What JSON says before the rows.
[[nodiscard]] io::NamedCells detectFacts(const std::string& device, const std::string& driver);

} // namespace voxtact::app

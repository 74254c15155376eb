// SPDX-License-Identifier: MIT
#pragma once

#include "app/output.h"

namespace voxtact::app {

/// Writes a table as writeTable() does, some rows at a time, so that they need not all be there at once.
class TableWriter {
  public:
    /// The stream must outlive it.
    TableWriter(std::ostream& out, Format format);

    /// The next rows. What comes before them is written with the first part, which may have none; columns of text are
    /// as wide as the widest field so far.
    void add(const Table& part);
    /// After all parts, of which there must be one. `whole` false: JSON says "interrupted".
    void end(const NamedCells& timing, bool whole = true);

  private:
    void addCsv(const Table& part);
    void addText(const Table& part);
    void addJson(const Table& part);

    std::ostream& out_;
    Format format_;
    bool begun_ = false;
    std::uint64_t rows_ = 0;
    std::vector<std::size_t> widths_;
};

} // namespace voxtact::app

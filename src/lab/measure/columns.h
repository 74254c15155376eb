// SPDX-License-Identifier: MIT
#pragma once

#include "io/text/table.h"
#include "lab/compare/compare_result.h"

#include <algorithm>
#include <iterator>

/// Rows of cells with names: what text, CSV and JSON are made of.
namespace voxtact::lab {

/// Six significant digits: more would be noise.
[[nodiscard]] double rounded(double value);

/// Nothing where there is nothing.
[[nodiscard]] io::Cell cellOf(const std::optional<double>& value);
[[nodiscard]] io::Cell cellOf(const std::optional<std::uint64_t>& value);
/// Of samples; nothing where there are none.
[[nodiscard]] io::Cell cellOf(const std::vector<double>& samples, double Spread::*what);

/// Of rows that have the same columns. `none`: a row for the columns' names, where there may be no rows.
[[nodiscard]] io::Table tableOf(std::vector<io::NamedCells> rows, const io::NamedCells& none = {});

template <class Things, class CellsOf> std::vector<io::NamedCells> rowsOf(const Things& things, CellsOf cellsOf) {
    std::vector<io::NamedCells> rows;
    std::ranges::transform(things, std::back_inserter(rows), cellsOf);
    return rows;
}

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "lab/measure/columns.h"

#include <cmath>

namespace voxtact::lab {

double rounded(double value) {
    if (value == 0 || !std::isfinite(value)) {
        return 0;
    }
    const double parts = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
    return std::round(value * parts) / parts;
}

io::Cell cellOf(const std::optional<double>& value) {
    return value ? io::Cell(rounded(*value)) : io::Cell();
}

io::Cell cellOf(const std::optional<std::uint64_t>& value) {
    return value ? io::Cell(*value) : io::Cell();
}

io::Cell cellOf(const std::vector<double>& samples, double Spread::*what) {
    return samples.empty() ? io::Cell() : io::Cell(rounded(spreadOf(samples).*what));
}

io::Table tableOf(std::vector<io::NamedCells> rows, const io::NamedCells& none) {
    io::Table table;
    for (const auto& [name, cell] : rows.empty() ? none : rows.front()) {
        table.columns.push_back(name);
    }
    table.rows = rows.size();
    table.cell = [rows = std::move(rows)](std::size_t row, std::size_t column) { return rows[row][column].second; };
    return table;
}

} // namespace voxtact::lab

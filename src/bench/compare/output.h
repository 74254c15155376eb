// SPDX-License-Identifier: MIT
#pragma once

#include "bench/compare/compare.h"
#include "bench/measure/columns.h"

namespace voxtact::lab {

[[nodiscard]] Json sceneJson(const Scene& scene);
[[nodiscard]] Json methodJson(const MethodEntry& method);
[[nodiscard]] Row rowOf(const Series& series);
/// One row per series.
[[nodiscard]] io::Table seriesTable(const std::vector<Series>& series);
[[nodiscard]] Json seriesJson(const std::vector<Series>& series, const Machine& machine);

/// One row per series for CSV and text. Refers to the result.
[[nodiscard]] Output compareOutput(const Scene& scene, const CompareResult& result);

} // namespace voxtact::lab

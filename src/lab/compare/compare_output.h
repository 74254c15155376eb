// SPDX-License-Identifier: MIT
#pragma once

#include "lab/measure/columns.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace voxtact::lab {

[[nodiscard]] nlohmann::ordered_json machineJson(const Machine& machine);
/// The members that every output begins with.
[[nodiscard]] nlohmann::ordered_json provenanceJson(const Machine& machine);
[[nodiscard]] nlohmann::ordered_json sceneJson(const Scene& scene);
/// Of one thing in ms; null where there are no samples.
[[nodiscard]] nlohmann::ordered_json spreadJson(const std::vector<double>& samples);
[[nodiscard]] nlohmann::ordered_json seriesJson(const Series& series, const Machine& machine);
/// One row a series.
[[nodiscard]] io::Table seriesTable(const std::vector<Series>& series);
/// Those of the machine, then these.
[[nodiscard]] std::vector<std::string> allNotes(const Machine& machine, const std::vector<std::string>& more);
/// Comment lines: what it was measured on, and the notes.
void writeMachine(std::ostream& out, const Machine& machine, const std::vector<std::string>& notes);

/// What was found, in plain English, a sentence each: the agreement, then the speed.
[[nodiscard]] std::vector<std::string> summarize(const CompareResult& result);

/// The whole result as one object.
[[nodiscard]] nlohmann::ordered_json compareJson(const Scene& scene, const CompareResult& result);

/// One row a series for CSV and text.
void writeCompare(std::ostream& out, io::Format format, const Scene& scene, const CompareResult& result);

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#pragma once

#include "app/bench.h"
#include "app/bench_engines.h"

#include <iosfwd>

namespace voxtact::app {

/// One engine on one set of poses of one mesh.
struct BenchRow {
    std::string mesh{};
    std::uint32_t triangles = 0;
    std::string poses{}; ///< "large", "onset"
    EngineFacts engine{};
    std::uint64_t pairs = 0;
    std::uint64_t contacts = 0;      ///< certified
    std::uint64_t untouched = 0;     ///< certified too; the rest is possible
    std::uint64_t missed = 0;        ///< of the contacts
    std::uint64_t wrong = 0;         ///< hits where certainly nothing touches
    std::vector<double> wallRate{};  ///< pairs a second, a sample each
    std::vector<double> cpuRate{};   ///< pairs a second of CPU time of the whole process
    std::vector<double> wallRatio{}; ///< to the first engine's sample of the same round
    std::vector<double> cpuRatio{};
};

struct BenchResult {
    Machine machine;
    std::string volume;
    std::array<std::uint32_t, 3> voxels{};
    std::vector<BenchRow> rows;
    std::vector<std::string> notes;
    std::string disagreement; ///< of engines that must agree; empty: there is none
};

/// Counts in `row` what its engine misses and has too much. Returns where it differs though it must agree, or nothing.
[[nodiscard]] std::string judgeEngine(std::span<const EngineAnswer> certified, std::span<const EngineAnswer> answers,
                                      BenchRow& row);

void writeBench(std::ostream& out, const BenchOptions& options, const BenchResult& result);

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/certified_scenes.h"

#include "oracle/certified_oracle.h"
#include "support/host_meters.h"
#include "voxtact/cpu.h"

#include <string>
#include <vector>

namespace voxtact::test {

/// Bounds of the survivors of a triangle: its certain cells, and those that may be.
struct CellCount {
    std::uint64_t certain = 0;
    std::uint64_t possible = 0; ///< certain or undecided
};
/// Of each triangle.
[[nodiscard]] std::vector<CellCount> countCells(const CertifiedCase& c);

/// What an engine says of one pair in the projection `certified`.
struct EngineSays {
    PairAnswer pair;
    std::vector<TouchedTriangle> triangles;
};
/// The host engine's. Detector: of that projection, with the output `triangles`.
[[nodiscard]] Result<EngineSays> askEngine(cpu::Detector& detector, const CertifiedCase& c);

/// Everything that is wrong with it, a line each; empty when nothing is. `cells`: none, or of each triangle.
[[nodiscard]] std::string complaints(const EngineSays& engine, const oracle::CertifiedOracle& oracle,
                                     const std::vector<CellCount>& cells);

} // namespace voxtact::test

// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"

#include <random>
#include <vector>

namespace voxtact::test {

/// Another honest rasteriser, written apart from the oracle: single precision, no clipping at the sides of the view
/// volume, and as wrong as the tolerance allows: corners, weights and values are off at random. Returns the survivors,
/// sorted.
std::vector<oracle::OracleFragment> otherSurvivors(const oracle::OraclePair& pair, const oracle::Tolerance& tolerance,
                                                   std::mt19937& random);

} // namespace voxtact::test

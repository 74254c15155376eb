// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace voxtact {

/// voxtact::shapeBetween() of two shapes of one size and a parameter from 0 to 1.
void fillShapeBetween(std::span<const double> from, std::span<const double> to, double parameter,
                      std::vector<double>& out);

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace voxtact {

/// voxtact::shapeBetween() of two shapes of one size and a parameter from 0 to 1.
void fillShapeBetween(std::span<const float> from, std::span<const float> to, double parameter,
                      std::vector<float>& out);

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "samples/loft.h"

#include <cstdint>
#include <functional>

namespace voxtact {

/// Returns the position of the new vertex, given the middle of the edge.
using PlaceMiddle = std::function<Vec3(const Vec3& middle)>;

/// Splits the longest edge of a closed surface, again and again, until it has `triangles` triangles. Each split adds
/// two, so the difference must be even. O(N log N); equally long edges are taken in the order of their vertices.
void splitLongestEdges(Surface& surface, std::uint32_t triangles, const PlaceMiddle& place);

} // namespace voxtact

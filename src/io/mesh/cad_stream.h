// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace voxtact::io {

/// voxtact-step writes this to its standard output. Then come the text; three doubles a vertex, mm; and three 32-bit
/// numbers of vertices a triangle.
struct CadHeader {
    std::array<char, 8> magic{'v', 'x', 't', 's', 't', 'e', 'p', '1'};
    std::uint64_t textBytes = 0; ///< notes, one a line; without triangles why there are none
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t looseEdges = 0; ///< edges without a face, which are left out
    double deflection = 0;        ///< mm, as step::Deflection::bound
};

} // namespace voxtact::io

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// How far vertices of a mesh may be from where they are, each for itself: object units.
struct VertexReach {
    std::vector<std::vector<double>> boxes; ///< by level and node of the mesh's tree: the most of what is in each
    std::vector<double> vertices;           ///< as MeshImpl::x
    double most = 0;                        ///< of all
};

} // namespace voxtact::cpu

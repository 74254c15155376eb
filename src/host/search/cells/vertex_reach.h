// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// Maximum displacement of each vertex of a mesh: object units.
struct VertexReach {
    std::vector<std::vector<double>> boxes; ///< maximum in each node, by level and node of the mesh's tree
    std::vector<double> vertices;           ///< as MeshImpl::x
    double most = 0;                        ///< of all
};

} // namespace voxtact::cpu

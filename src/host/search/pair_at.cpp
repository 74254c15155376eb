// SPDX-License-Identifier: MIT
#include "host/search/pair_at.h"
#include "core/geometry/glm_bridge.h"
#include "core/method/certified_constants.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

double PairAt::deflection() const {
    // The pose stretches by no more than the root of the largest eigenvalue of its product with its transpose, which
    // is in a disc around a diagonal element (Gershgorin). A rigid pose has a product that is the identity.
    const glm::dmat3 linear(toGlm(world_from_object));
    const glm::dmat3 product = glm::transpose(linear) * linear;
    double largest = 0;
    for (int column = 0; column < 3; ++column) {
        const glm::dvec3 sizes = glm::abs(product[column]);
        largest = std::max(largest, sizes.x + sizes.y + sizes.z);
    }
    return mesh().facts.deflection * std::sqrt(largest) * (1 + 0x1p-40);
}

CertifiedTally PairAt::touch(std::optional<TouchPoint>& point) const {
    const VolumeImpl& in = volume();
    const CertifiedJob job{mesh(),
                           in,
                           part.occupancy,
                           certifiedPair(in.pairGrid, world_from_object, mesh().origin),
                           0,
                           static_cast<std::uint32_t>(mesh().clusters.size()),
                           true,
                           cancel};
    return decide(job, [&](std::uint32_t triangle, const shader::CertifiedProof& proof) {
        const Vec3 texture{static_cast<double>(proof.texture.x), static_cast<double>(proof.texture.y),
                           static_cast<double>(proof.texture.z)};
        point = TouchPoint{transformPoint(worldFromTexture(in.grid), texture), triangle};
    });
}

Found PairAt::search(ThreadMemory& memory, const SearchGoal& goal, const std::optional<Sweep>& sweep,
                     const OpenPairs* from) const {
    return search(memory, SearchedPart(part), goal, sweep, from);
}

Found PairAt::search(ThreadMemory& memory, const SearchedPart& searched, const SearchGoal& goal,
                     const std::optional<Sweep>& sweep, const OpenPairs* from) const {
    memory.mesh.begin(mesh(), part.space, world_from_object, sweep);
    return memory.search.run(memory.mesh, volume(), part, searched, goal, from, cancel);
}

} // namespace voxtact::cpu

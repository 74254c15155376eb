// SPDX-License-Identifier: MIT
#include "host/search/pair_at.h"
#include "core/method/certified_constants.h"

namespace voxtact::cpu {

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

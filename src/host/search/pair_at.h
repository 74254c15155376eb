// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/search.h"
#include "host/touch/certified_pair.h"
#include "voxtact/distance.h"

#include <cstdint>
#include <optional>

namespace voxtact::cpu {

/// State that a thread keeps between pairs.
struct ThreadMemory {
    MeshPlace mesh;
    ClosestSearch search;
};

/// A point where a pair certainly touches.
struct TouchPoint {
    Vec3 position{}; ///< world
    std::uint32_t triangle = 0;
};

/// One mesh at one pose, on one thread.
struct PairAt {
    const BatchItem& item;
    const OpaquePart& part;
    Mat4 world_from_object;
    CancelFlag cancel = nullptr;     ///< the result of a cancelled search or touch is undefined
    const MeshImpl* shape = nullptr; ///< the mesh of the item after a bend; null: as it is

    [[nodiscard]] const VolumeImpl& volume() const { return item.volume->impl(); }
    [[nodiscard]] const MeshImpl& mesh() const { return shape != nullptr ? *shape : item.mesh->impl(); }

    /// Maximum distance of the represented surface from the triangles, mm.
    [[nodiscard]] double deflection() const;
    /// Decides the touch, like the projection `certified`. Sets `point` if it certainly touches.
    [[nodiscard]] CertifiedTally touch(std::optional<TouchPoint>& point) const;
    /// The closest points. `sweep`: where else the mesh may be; in the world's coordinates. `from`: as for
    /// ClosestSearch.
    [[nodiscard]] Found search(ThreadMemory& memory, const SearchGoal& goal, const std::optional<Sweep>& sweep = {},
                               const OpenPairs* from = nullptr) const;
    [[nodiscard]] Found search(ThreadMemory& memory, const SearchedPart& searched, const SearchGoal& goal,
                               const std::optional<Sweep>& sweep = {}, const OpenPairs* from = nullptr) const;
};

} // namespace voxtact::cpu

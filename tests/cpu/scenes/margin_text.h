// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

#include <cstddef>

/// The text that the device's passes have for a margin (shaders/certified_margin*.h), done on the host: all triangles,
/// and all bricks and cells that the device looks at, one after the other.
namespace voxtact::test {

struct MarginVerdict {
    int verdict = 0;         ///< CERTIFIED_CERTAIN, _NONE or _UNDECIDED
    std::size_t cells = 0;   ///< that were looked at
    std::size_t decided = 0; ///< and needed a decision
};

/// What the device says of a mesh without clusters, to whose vertices no probe is made. `whole`: nothing is skipped,
/// neither bricks nor cells: all cells of the volume are decided.
[[nodiscard]] MarginVerdict marginVerdict(const MeshView& mesh, const cpu::Volume& volume,
                                          const cpu::TransferFunction& function, const Mat4& world_from_object,
                                          double threshold, double margin, bool whole = false);

} // namespace voxtact::test

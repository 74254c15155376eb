// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <vector>

namespace voxtact {

/// A tube between two points of world space, mm.
struct Vessel {
    Vec3 from{};
    Vec3 to{};
    double fromRadius = 0;
    double toRadius = 0;
};

/// A tree that enters at the middle of the box's lowest face and branches in two again and again, each branch shorter
/// and thinner than the one before.
[[nodiscard]] std::vector<Vessel> vesselTree();

/// 255 on a vessel's axis, falling to 0 at twice its radius; of several vessels the largest. `volume` is of uint8, 0
/// everywhere, along the world's axes.
void drawVessels(const std::vector<Vessel>& vessels, VolumeData& volume);

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "samples/value_noise.h"
#include "voxtact/data.h"

namespace voxtact {

/// The scalar of each tissue, in the image's own units.
struct HeadTissues {
    double air = 0;
    double skin = 0;
    double bone = 0;
    double fluid = 0;
    double grey = 0;
    double white = 0;
    double densest = 0;
};

/// A head in world space (LPS: the nose towards -y, the crown towards +z) within 97 mm of the origin along each axis.
class BuiltinHead {
  public:
    /// `blur`: the width in mm over which one tissue turns into the next; a voxel, as in a real image.
    BuiltinHead(const HeadTissues& tissues, double blur) noexcept : tissues_(tissues), blur_(blur) {}

    [[nodiscard]] double at(const Vec3& world) const noexcept;

  private:
    [[nodiscard]] double mix(double outside, double inside, double signedDistance) const noexcept;
    [[nodiscard]] double brainAt(const Vec3& world, double depth) const noexcept;

    HeadTissues tissues_;
    double blur_;
    ValueNoise folds_{0x5eedU};
};

} // namespace voxtact

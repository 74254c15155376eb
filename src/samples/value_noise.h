// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>

namespace voxtact {

/// Random values in [0,1) at the whole points of space, blended so that the second derivative is continuous.
/// Whole-number hashing and IEEE arithmetic only: the same on every machine.
class ValueNoise {
  public:
    explicit ValueNoise(std::uint32_t seed) noexcept : seed_(seed) {}

    [[nodiscard]] double at(const Vec3& point) const noexcept;

    /// Three octaves, each of twice the frequency and half the weight of the one before; in [0,1).
    [[nodiscard]] double octavesAt(const Vec3& point) const noexcept;

  private:
    std::uint32_t seed_;
};

} // namespace voxtact

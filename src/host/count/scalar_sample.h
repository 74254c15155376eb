// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/occupancy.h"
#include "host/scene/stored_image.h"

namespace voxtact::cpu {

/// Returns true if 32-bit offsets reach all bytes of an image.
[[nodiscard]] bool fitsOffsets(const StoredImage& image) noexcept;

/// The stored value at a coordinate within [0,1]^3, for images of any size.
[[nodiscard]] float storedAt(const StoredImage& image, float x, float y, float z) noexcept;
/// The verdict on one coordinate within [0,1]^3, for images of any size.
[[nodiscard]] bool sampleIsOpaque(const StoredImage& image, const Occupancy& occupancy, float x, float y,
                                  float z) noexcept;

} // namespace voxtact::cpu

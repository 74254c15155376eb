// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace voxtact::cpu {

/// The integers (or floats) that the exact arithmetic interpolates: int16 is kept with its sign bit flipped, as uint16,
/// as on the device.
inline float storedValue(std::uint8_t voxel) noexcept {
    return static_cast<float>(voxel);
}
inline float storedValue(std::uint16_t voxel) noexcept {
    return static_cast<float>(voxel);
}
inline float storedValue(std::int16_t voxel) noexcept {
    return static_cast<float>(static_cast<int>(voxel) + 32768);
}
inline float storedValue(float voxel) noexcept {
    return voxel;
}

/// value = stored + storedIntercept(type)
inline double storedIntercept(ScalarType type) noexcept {
    return type == ScalarType::Int16 ? -32768.0 : 0.0;
}

} // namespace voxtact::cpu

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <cstring>

namespace voxtact {

/// int16 is kept with its sign bit flipped, as uint16: SNORM would make -32768 and -32767 the same.
inline constexpr std::uint16_t kInt16SignBit = 0x8000;

/// Voxels of a type as the image keeps them; the same number of bytes.
inline void fillTexels(ScalarType type, std::span<const std::byte> voxels, std::byte* texels) {
    if (type != ScalarType::Int16) {
        std::memcpy(texels, voxels.data(), voxels.size());
        return;
    }
    for (std::size_t at = 0; at < voxels.size(); at += sizeof(std::uint16_t)) {
        std::uint16_t voxel = 0;
        std::memcpy(&voxel, voxels.data() + at, sizeof voxel);
        voxel ^= kInt16SignBit;
        std::memcpy(texels + at, &voxel, sizeof voxel);
    }
}

} // namespace voxtact

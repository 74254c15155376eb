// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

namespace voxtact {

/// Calls `visitor` with a typed pointer to the first voxel.
template <class Visitor> auto visitVoxels(const VolumeView& volume, Visitor&& visitor) {
    const void* first = volume.voxels.data();
    switch (volume.type) {
    case ScalarType::UInt8:
        return visitor(static_cast<const std::uint8_t*>(first));
    case ScalarType::Int16:
        return visitor(static_cast<const std::int16_t*>(first));
    case ScalarType::UInt16:
        return visitor(static_cast<const std::uint16_t*>(first));
    case ScalarType::Float32:
        break;
    }
    return visitor(static_cast<const float*>(first));
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/volume/voxel_visit.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

std::size_t bytesPerVoxel(ScalarType type) noexcept {
    switch (type) {
    case ScalarType::UInt8:
        return 1;
    case ScalarType::Int16:
    case ScalarType::UInt16:
        return 2;
    case ScalarType::Float32:
        break;
    }
    return 4;
}

const char* toString(ScalarType type) noexcept {
    switch (type) {
    case ScalarType::UInt8:
        return "uint8";
    case ScalarType::Int16:
        return "int16";
    case ScalarType::UInt16:
        return "uint16";
    case ScalarType::Float32:
        return "float";
    }
    return "unknown";
}

namespace {

Error notFinite(const Grid& grid, std::uint64_t voxel, double value) {
    const std::uint64_t x = voxel % grid.size[0];
    const std::uint64_t y = voxel / grid.size[0] % grid.size[1];
    const std::uint64_t z = voxel / grid.size[0] / grid.size[1];
    return refuse("voxel (" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) + ") is " +
                  (std::isnan(value) ? "NaN" : "infinite"));
}

template <class Scalar> Result<ValueRange> rangeOf(const Grid& grid, const Scalar* voxels) {
    const std::uint64_t count = voxelCount(grid);
    Scalar lo = voxels[0];
    Scalar hi = voxels[0];
    for (std::uint64_t i = 0; i < count; ++i) {
        if constexpr (std::is_floating_point_v<Scalar>) {
            if (!std::isfinite(voxels[i])) {
                return notFinite(grid, i, static_cast<double>(voxels[i]));
            }
        }
        lo = std::min(lo, voxels[i]);
        hi = std::max(hi, voxels[i]);
    }
    return ValueRange{static_cast<double>(lo), static_cast<double>(hi)};
}

} // namespace

Result<ValueRange> checkVolume(const VolumeView& volume) {
    return guard([&]() -> Result<ValueRange> {
        VOXTACT_TRY(checkGrid(volume.grid));
        VOXTACT_TRY(checkScalarType(volume.type));
        const std::uint64_t expected = voxelCount(volume.grid) * bytesPerVoxel(volume.type);
        if (volume.voxels.size() != expected) {
            return refuse("the image has " + std::to_string(volume.voxels.size()) +
                          " bytes of voxels, its size and type (" + toString(volume.type) + ") need " +
                          std::to_string(expected));
        }
        return visitVoxels(volume, [&](const auto* voxels) { return rangeOf(volume.grid, voxels); });
    });
}

} // namespace voxtact

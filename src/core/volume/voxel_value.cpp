// SPDX-License-Identifier: MIT
#include "core/volume/voxel_value.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace voxtact {

namespace {

template <class Scalar> Result<VoxelBytes> bytesOf(double value, const char* type) {
    using Limits = std::numeric_limits<Scalar>;
    constexpr auto kLowest = static_cast<double>(Limits::lowest());
    constexpr auto kHighest = static_cast<double>(Limits::max());
    if (!(value >= kLowest && value <= kHighest) || (Limits::is_integer && value != std::floor(value))) {
        return refuse("the value " + number(value) + " is not one that a voxel of type " + type + " can have: " +
                      (Limits::is_integer ? "a whole number from " : "") + number(kLowest) + " to " + number(kHighest));
    }
    const auto voxel = static_cast<Scalar>(value);
    VoxelBytes bytes{};
    std::memcpy(bytes.data(), &voxel, sizeof voxel);
    return bytes;
}

template <class Scalar> Scalar at(std::span<const std::byte> voxels, std::size_t number) noexcept {
    Scalar voxel{};
    std::memcpy(&voxel, voxels.data() + number * sizeof voxel, sizeof voxel);
    return voxel;
}

template <class Scalar> Result<ValueRange> rangeOf(const VoxelBox& box, std::span<const std::byte> voxels) {
    Scalar lo = at<Scalar>(voxels, 0);
    Scalar hi = lo;
    for (std::size_t i = 0; i < voxels.size() / sizeof(Scalar); ++i) {
        const auto voxel = at<Scalar>(voxels, i);
        if constexpr (std::is_floating_point_v<Scalar>) {
            if (!std::isfinite(voxel)) {
                return refuse("voxel (" + std::to_string(i % box.size[0]) + ", " +
                              std::to_string(i / box.size[0] % box.size[1]) + ", " +
                              std::to_string(i / box.size[0] / box.size[1]) + ") of the box is " +
                              (std::isnan(voxel) ? "NaN" : "infinite"));
            }
        }
        lo = std::min(lo, voxel);
        hi = std::max(hi, voxel);
    }
    return ValueRange{static_cast<double>(lo), static_cast<double>(hi)};
}

} // namespace

Result<VoxelBytes> voxelOf(ScalarType type, double value) {
    switch (type) {
    case ScalarType::UInt8:
        return bytesOf<std::uint8_t>(value, toString(type));
    case ScalarType::Int16:
        return bytesOf<std::int16_t>(value, toString(type));
    case ScalarType::UInt16:
        return bytesOf<std::uint16_t>(value, toString(type));
    case ScalarType::Float32:
        break;
    }
    return bytesOf<float>(value, toString(type));
}

double valueOf(ScalarType type, const VoxelBytes& voxel) noexcept {
    switch (type) {
    case ScalarType::UInt8:
        return at<std::uint8_t>(voxel, 0);
    case ScalarType::Int16:
        return at<std::int16_t>(voxel, 0);
    case ScalarType::UInt16:
        return at<std::uint16_t>(voxel, 0);
    case ScalarType::Float32:
        break;
    }
    return static_cast<double>(at<float>(voxel, 0));
}

Result<void> checkVoxelBytes(ScalarType type, const VoxelBox& box, std::size_t bytes) {
    const std::uint64_t expected = std::uint64_t{box.size[0]} * box.size[1] * box.size[2] * bytesPerVoxel(type);
    if (bytes != expected) {
        return refuse("there are " + std::to_string(bytes) + " bytes of voxels, the box and the type (" +
                      toString(type) + ") need " + std::to_string(expected));
    }
    return {};
}

Result<ValueRange> checkVoxels(ScalarType type, const VoxelBox& box, std::span<const std::byte> voxels) {
    VOXTACT_TRY(checkVoxelBytes(type, box, voxels.size()));
    if (voxels.empty()) {
        return ValueRange{};
    }
    switch (type) {
    case ScalarType::UInt8:
        return rangeOf<std::uint8_t>(box, voxels);
    case ScalarType::Int16:
        return rangeOf<std::int16_t>(box, voxels);
    case ScalarType::UInt16:
        return rangeOf<std::uint16_t>(box, voxels);
    case ScalarType::Float32:
        break;
    }
    return rangeOf<float>(box, voxels);
}

} // namespace voxtact

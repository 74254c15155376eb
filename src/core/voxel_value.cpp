// SPDX-License-Identifier: MIT
#include "core/voxel_value.h"
#include "core/text.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace voxtact {

namespace {

Error refuse(std::string text) {
    return Error{ErrorCode::InvalidArgument, 0, std::move(text)};
}

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

Result<void> checkVoxels(ScalarType type, const VoxelBox& box, std::span<const std::byte> voxels) {
    const std::uint64_t expected = std::uint64_t{box.size[0]} * box.size[1] * box.size[2] * bytesPerVoxel(type);
    if (voxels.size() != expected) {
        return refuse("there are " + std::to_string(voxels.size()) + " bytes of voxels, the box and the type (" +
                      toString(type) + ") need " + std::to_string(expected));
    }
    if (type != ScalarType::Float32) {
        return {};
    }
    for (std::size_t i = 0; i < voxels.size() / sizeof(float); ++i) {
        float voxel = 0;
        std::memcpy(&voxel, voxels.data() + i * sizeof voxel, sizeof voxel);
        if (!std::isfinite(voxel)) {
            return refuse("voxel (" + std::to_string(i % box.size[0]) + ", " +
                          std::to_string(i / box.size[0] % box.size[1]) + ", " +
                          std::to_string(i / box.size[0] / box.size[1]) + ") of the box is " +
                          (std::isnan(voxel) ? "NaN" : "infinite"));
        }
    }
    return {};
}

} // namespace voxtact

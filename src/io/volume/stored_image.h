// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace voxtact::io {

/// Storage of a voxel in a file.
enum class StoredType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

[[nodiscard]] constexpr std::size_t storedBytes(StoredType type) noexcept {
    switch (type) {
    case StoredType::Int8:
    case StoredType::UInt8:
        return 1;
    case StoredType::Int16:
    case StoredType::UInt16:
        return 2;
    case StoredType::Int32:
    case StoredType::UInt32:
    case StoredType::Float32:
        return 4;
    case StoredType::Int64:
    case StoredType::UInt64:
    case StoredType::Float64:
        break;
    }
    return 8;
}

/// Calls `act` with a value of the type that the voxels are stored in.
template <class Act> auto withStored(StoredType type, Act&& act) {
    switch (type) {
    case StoredType::Int8:
        return act(std::int8_t{});
    case StoredType::UInt8:
        return act(std::uint8_t{});
    case StoredType::Int16:
        return act(std::int16_t{});
    case StoredType::UInt16:
        return act(std::uint16_t{});
    case StoredType::Int32:
        return act(std::int32_t{});
    case StoredType::UInt32:
        return act(std::uint32_t{});
    case StoredType::Int64:
        return act(std::int64_t{});
    case StoredType::UInt64:
        return act(std::uint64_t{});
    case StoredType::Float32:
        return act(float{});
    case StoredType::Float64:
        break;
    }
    return act(double{});
}

/// value = slope * stored + intercept
struct Scaling {
    double slope = 1;
    double intercept = 0;
};

/// An image as its file holds it, in the machine's byte order.
struct StoredImage {
    Grid grid;
    StoredType type = StoredType::UInt8;
    std::optional<Scaling> scaling; ///< none: the stored numbers are the values
    std::vector<std::byte> voxels;
};

/// Converts the voxels to a ScalarType: integers exactly, scaled voxels and doubles in single precision. Notes
/// conversions.
[[nodiscard]] Result<VolumeData> toScalars(StoredImage image, const std::filesystem::path& path);

/// The voxels as labels, without scaling. Refuses one that is not whole or beyond an int32.
[[nodiscard]] Result<std::vector<std::int32_t>> toLabels(const StoredImage& image, const std::filesystem::path& path);

} // namespace voxtact::io

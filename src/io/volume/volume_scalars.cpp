// SPDX-License-Identifier: MIT
#include "core/base/text.h"
#include "io/errors.h"
#include "io/volume/stored_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>

namespace voxtact::io {

namespace {

template <class Scalar> const Scalar* as(const std::vector<std::byte>& voxels) {
    return reinterpret_cast<const Scalar*>(voxels.data());
}

template <class To, class From> std::vector<std::byte> converted(const std::vector<std::byte>& voxels) {
    const std::size_t count = voxels.size() / sizeof(From);
    std::vector<std::byte> result(count * sizeof(To));
    auto* to = reinterpret_cast<To*>(result.data());
    std::transform(as<From>(voxels), as<From>(voxels) + count, to, [](From v) { return static_cast<To>(v); });
    return result;
}

/// A float has 24 significant bits.
template <std::integral Integer> bool isExactFloat(Integer value) {
    auto magnitude = static_cast<std::uint64_t>(+value); // promoted first: a narrow type keeps its sign
    if (std::cmp_less(value, 0)) {
        magnitude = 0 - magnitude;
    }
    return magnitude == 0 || (magnitude >> std::countr_zero(magnitude)) < (std::uint64_t{1} << 24);
}

std::string placeOf(const Grid& grid, std::size_t voxel) {
    const std::size_t x = voxel % grid.size[0];
    const std::size_t y = voxel / grid.size[0] % grid.size[1];
    const std::size_t z = voxel / grid.size[0] / grid.size[1];
    return "voxel (" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) + ")";
}

template <class To> void become(VolumeData& volume, ScalarType type, std::vector<std::byte> voxels, const char* from) {
    volume.type = type;
    volume.voxels = std::move(voxels);
    volume.notes.push_back(std::string("voxels converted from ") + from + " to " + toString(type) +
                           (std::is_floating_point_v<To> ? "" : ", exactly"));
}

template <std::integral Integer>
Result<VolumeData> narrowed(VolumeData volume, const StoredImage& image, const std::filesystem::path& path,
                            const char* from) {
    const Integer* begin = as<Integer>(image.voxels);
    const Integer* end = begin + image.voxels.size() / sizeof(Integer);
    const auto [lo, hi] = std::minmax_element(begin, end);
    if (std::in_range<std::int16_t>(*lo) && std::in_range<std::int16_t>(*hi)) {
        become<std::int16_t>(volume, ScalarType::Int16, converted<std::int16_t, Integer>(image.voxels), from);
        return volume;
    }
    if (std::in_range<std::uint16_t>(*lo) && std::in_range<std::uint16_t>(*hi)) {
        become<std::uint16_t>(volume, ScalarType::UInt16, converted<std::uint16_t, Integer>(image.voxels), from);
        return volume;
    }
    const Integer* inexact = std::find_if_not(begin, end, isExactFloat<Integer>);
    if (inexact != end) {
        return cannotRead(path, placeOf(image.grid, static_cast<std::size_t>(inexact - begin)) + " is " +
                                    std::to_string(*inexact) +
                                    ", which neither 16-bit integers nor floats hold exactly");
    }
    become<float>(volume, ScalarType::Float32, converted<float, Integer>(image.voxels), from);
    volume.notes.back() += ", exactly";
    return volume;
}

/// slope * stored + intercept in double, rounded once. A voxel that is not finite stays so, for the check that names
/// it; one that a float cannot hold is refused.
template <class Stored>
Result<VolumeData> inFloats(VolumeData volume, const StoredImage& image, const std::filesystem::path& path) {
    const Scaling scaling = image.scaling.value_or(Scaling{});
    const Stored* stored = as<Stored>(image.voxels);
    const std::size_t count = image.voxels.size() / sizeof(Stored);
    std::vector<std::byte> voxels(count * sizeof(float));
    auto* to = reinterpret_cast<float*>(voxels.data());
    for (std::size_t i = 0; i < count; ++i) {
        const auto value = static_cast<double>(stored[i]);
        const double scaled = image.scaling ? value * scaling.slope + scaling.intercept : value;
        to[i] = static_cast<float>(scaled);
        if (std::isinf(to[i]) && std::isfinite(value)) {
            return cannotRead(path, placeOf(image.grid, i) + " is too large for a float");
        }
    }
    if constexpr (std::is_same_v<Stored, double>) {
        become<float>(volume, ScalarType::Float32, std::move(voxels), "double");
        volume.notes.back() += ", rounded";
    } else {
        volume.type = ScalarType::Float32;
        volume.voxels = std::move(voxels);
    }
    return volume;
}

const char* nameOf(StoredType type) {
    constexpr std::array<const char*, 10> kNames{"int8",   "uint8", "int16",  "uint16", "int32",
                                                 "uint32", "int64", "uint64", "float",  "double"};
    return kNames[static_cast<std::size_t>(type)];
}

/// The ScalarType that holds the stored type as it is.
std::optional<ScalarType> kept(StoredType type) {
    switch (type) {
    case StoredType::UInt8:
        return ScalarType::UInt8;
    case StoredType::Int16:
        return ScalarType::Int16;
    case StoredType::UInt16:
        return ScalarType::UInt16;
    case StoredType::Float32:
        return ScalarType::Float32;
    default:
        return std::nullopt;
    }
}

} // namespace

Result<VolumeData> toScalars(StoredImage image, const std::filesystem::path& path) {
    VolumeData volume;
    volume.grid = image.grid;
    const std::optional<ScalarType> same = kept(image.type);
    if (same && !image.scaling) {
        volume.type = *same;
        volume.voxels = std::move(image.voxels);
        return volume;
    }
    return withStored(image.type, [&]<class Stored>(Stored) -> Result<VolumeData> {
        if constexpr (std::is_integral_v<Stored>) {
            if (!image.scaling) {
                return narrowed<Stored>(std::move(volume), image, path, nameOf(image.type));
            }
        }
        return inFloats<Stored>(std::move(volume), image, path);
    });
}

Result<std::vector<std::int32_t>> toLabels(const StoredImage& image, const std::filesystem::path& path) {
    return withStored(image.type, [&]<class Stored>(Stored) -> Result<std::vector<std::int32_t>> {
        const Stored* const stored = as<Stored>(image.voxels);
        std::vector<std::int32_t> labels(image.voxels.size() / sizeof(Stored));
        for (std::size_t i = 0; i < labels.size(); ++i) {
            bool isLabel = false;
            if constexpr (std::is_floating_point_v<Stored>) {
                const auto value = static_cast<double>(stored[i]);
                isLabel = value == std::floor(value) && std::abs(value) <= std::numeric_limits<std::int32_t>::max();
            } else {
                isLabel = std::in_range<std::int32_t>(stored[i]);
            }
            if (!isLabel) {
                return cannotRead(path, placeOf(image.grid, i) + " is " + number(static_cast<double>(stored[i])) +
                                            ", a label is a whole number that an int32 holds");
            }
            labels[i] = static_cast<std::int32_t>(stored[i]); // NOLINT(bugprone-signed-char-misuse): a number
        }
        return labels;
    });
}

} // namespace voxtact::io

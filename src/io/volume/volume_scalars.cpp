// SPDX-License-Identifier: MIT
#include "io/errors.h"
#include "io/volume/itk_image.h"

#include <algorithm>
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
Result<VolumeData> narrowed(VolumeData volume, const ItkImage& image, const std::filesystem::path& path,
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

Result<VolumeData> rounded(VolumeData volume, const ItkImage& image, const std::filesystem::path& path) {
    const auto* begin = as<double>(image.voxels);
    const auto* end = begin + image.voxels.size() / sizeof(double);
    const auto* large = std::find_if(begin, end, [](double value) {
        return std::isfinite(value) && std::abs(value) > static_cast<double>(std::numeric_limits<float>::max());
    });
    if (large != end) {
        return cannotRead(path,
                          placeOf(image.grid, static_cast<std::size_t>(large - begin)) + " is too large for a float");
    }
    become<float>(volume, ScalarType::Float32, converted<float, double>(image.voxels), "double");
    volume.notes.back() += ", rounded";
    return volume;
}

} // namespace

Result<VolumeData> toScalars(ItkImage image, const std::filesystem::path& path) {
    using itk::IOComponentEnum;
    VolumeData volume;
    volume.grid = image.grid;
    const auto keep = [&](ScalarType type) {
        volume.type = type;
        volume.voxels = std::move(image.voxels);
        return std::move(volume);
    };
    switch (image.component) {
    case IOComponentEnum::UCHAR:
        return keep(ScalarType::UInt8);
    case IOComponentEnum::SHORT:
        return keep(ScalarType::Int16);
    case IOComponentEnum::USHORT:
        return keep(ScalarType::UInt16);
    case IOComponentEnum::FLOAT:
        return keep(ScalarType::Float32);
    case IOComponentEnum::CHAR:
        return narrowed<std::int8_t>(std::move(volume), image, path, "int8");
    case IOComponentEnum::INT:
        return narrowed<std::int32_t>(std::move(volume), image, path, "int32");
    case IOComponentEnum::UINT:
        return narrowed<std::uint32_t>(std::move(volume), image, path, "uint32");
    case IOComponentEnum::LONG:
        return narrowed<long>(std::move(volume), image, path, "int64");
    case IOComponentEnum::ULONG:
        return narrowed<unsigned long>(std::move(volume), image, path, "uint64");
    case IOComponentEnum::LONGLONG:
        return narrowed<long long>(std::move(volume), image, path, "int64");
    case IOComponentEnum::ULONGLONG:
        return narrowed<unsigned long long>(std::move(volume), image, path, "uint64");
    case IOComponentEnum::DOUBLE:
        return rounded(std::move(volume), image, path);
    default:
        break;
    }
    return cannotRead(path, "its voxels are of a type that is not supported; convert it to integers or floats");
}

} // namespace voxtact::io

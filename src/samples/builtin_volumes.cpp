// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "samples/builtin_head.h"
#include "samples/builtin_name.h"
#include "samples/builtin_vessels.h"
#include "samples/value_noise.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace voxtact {

namespace {

constexpr std::uint32_t kDefaultSize = 128;
constexpr std::uint32_t kMinSize = 4;
constexpr std::uint32_t kMaxSize = 1024;
constexpr double kSide = 200;

constexpr HeadTissues kBytes{0, 95, 225, 45, 150, 185, 255};
constexpr HeadTissues kHounsfield{-1024, 40, 1200, 8, 40, 28, 3071};

Vec3 alongAxes(const Grid& grid, const Vec3& steps) {
    Vec3 sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t row = 0; row < 3; ++row) {
            sum[row] += grid.direction[3 * axis + row] * (steps[axis] * grid.spacing[axis]);
        }
    }
    return sum;
}

Grid centredGrid(const std::array<std::uint32_t, 3>& size, const std::array<double, 9>& direction) {
    Grid grid;
    grid.size = size;
    grid.direction = direction;
    grid.spacing = {kSide / size[0], kSide / size[1], kSide / size[2]};
    grid.origin = alongAxes(grid, {-0.5 * (size[0] - 1), -0.5 * (size[1] - 1), -0.5 * (size[2] - 1)});
    return grid;
}

Grid straightGrid(std::uint32_t size) {
    return centredGrid({size, size, size}, {1, 0, 0, 0, 1, 0, 0, 0, 1});
}

/// The rotation of the quaternion (16, 1, -2, 2), about 21 degrees: whole numbers over 265.
Grid obliqueGrid(std::uint32_t size) {
    constexpr std::array<double, 9> kWhole{249, 60, 68, -68, 255, 24, -60, -40, 255};
    std::array<double, 9> direction{};
    std::transform(kWhole.begin(), kWhole.end(), direction.begin(), [](double whole) { return whole / 265; });
    return centredGrid({size, size, (size + 2) / 3}, direction);
}

bool onBoundary(const Grid& grid, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return x == 0 || y == 0 || z == 0 || x + 1 == grid.size[0] || y + 1 == grid.size[1] || z + 1 == grid.size[2];
}

template <class T> T toScalar(double value) {
    if constexpr (std::numeric_limits<T>::is_integer) {
        return static_cast<T>(std::floor(value + 0.5));
    } else {
        return static_cast<T>(value);
    }
}

/// Calls `valueAt(world, boundary)` for each voxel.
template <class T, class ValueAt> VolumeData fill(const Grid& grid, ScalarType type, ValueAt&& valueAt) {
    VolumeData volume;
    volume.grid = grid;
    volume.type = type;
    volume.voxels.resize(sizeof(T) * grid.size[0] * grid.size[1] * grid.size[2]);
    std::byte* out = volume.voxels.data();
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const Vec3 offset =
                    alongAxes(grid, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
                const Vec3 world{grid.origin[0] + offset[0], grid.origin[1] + offset[1], grid.origin[2] + offset[2]};
                const T scalar = toScalar<T>(valueAt(world, onBoundary(grid, x, y, z)));
                std::memcpy(out, &scalar, sizeof scalar);
                out += sizeof scalar;
            }
        }
    }
    return volume;
}

double radius(const Vec3& p) {
    return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

VolumeData makeHead(std::uint32_t size) {
    const BuiltinHead head(kBytes, kSide / size);
    return fill<std::uint8_t>(straightGrid(size), ScalarType::UInt8,
                              [&](const Vec3& world, bool boundary) { return boundary ? 0.0 : head.at(world); });
}

VolumeData makeSphere(std::uint32_t size) {
    return fill<std::uint8_t>(straightGrid(size), ScalarType::UInt8, [](const Vec3& world, bool) {
        return 255 * std::max(0.0, 1 - radius(world) / (0.45 * kSide));
    });
}

/// Noise rarely comes near its bounds: it is stretched to reach both ends of the range.
void stretch(VolumeData& volume, std::uint32_t top) {
    std::vector<std::uint16_t> scalars(volume.voxels.size() / sizeof(std::uint16_t));
    std::memcpy(scalars.data(), volume.voxels.data(), volume.voxels.size());
    const auto [lowest, highest] = std::minmax_element(scalars.begin(), scalars.end());
    const std::uint32_t low = *lowest;
    const std::uint32_t range = std::max(1U, *highest - low);
    for (std::uint16_t& scalar : scalars) {
        scalar = static_cast<std::uint16_t>(((scalar - low) * top + range / 2) / range);
    }
    std::memcpy(volume.voxels.data(), scalars.data(), volume.voxels.size());
}

VolumeData makeNoise(std::uint32_t size) {
    constexpr double kCell = 25;
    constexpr std::uint32_t kTop = 4095;
    const ValueNoise noise(0x0123U);
    VolumeData volume = fill<std::uint16_t>(straightGrid(size), ScalarType::UInt16, [&](const Vec3& world, bool) {
        return 65535 * noise.octavesAt({world[0] / kCell, world[1] / kCell, world[2] / kCell});
    });
    stretch(volume, kTop);
    return volume;
}

VolumeData makeCt(std::uint32_t size) {
    const BuiltinHead head(kHounsfield, kSide / size);
    return fill<std::int16_t>(obliqueGrid(size), ScalarType::Int16,
                              [&](const Vec3& world, bool) { return head.at(world); });
}

VolumeData makeShells(std::uint32_t size) {
    constexpr double kGap = 20;
    constexpr double kOuter = 90;
    const double halfThickness = 1.5 * kSide / size;
    return fill<float>(straightGrid(size), ScalarType::Float32, [&](const Vec3& world, bool) {
        const double r = radius(world);
        const double fromShell = std::abs(r - kGap * std::max(1.0, std::floor(r / kGap + 0.5))) / halfThickness;
        const double fade = 1 - fromShell * fromShell;
        return fromShell < 1 && r < kOuter ? fade * fade : 0.0;
    });
}

VolumeData makeVessels(std::uint32_t size) {
    VolumeData volume;
    volume.grid = centredGrid({size, size, (size + 1) / 2}, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    volume.type = ScalarType::UInt8;
    volume.voxels.resize(voxelCount(volume.grid));
    drawVessels(vesselTree(), volume);
    return volume;
}

struct Maker {
    const char* stem;
    VolumeData (*make)(std::uint32_t size);
};

constexpr std::array<Maker, 6> kMakers{{{"head", makeHead},
                                        {"sphere", makeSphere},
                                        {"noise", makeNoise},
                                        {"ct", makeCt},
                                        {"shells", makeShells},
                                        {"vessels", makeVessels}}};

} // namespace

Result<VolumeData> makeBuiltinVolume(std::string_view name) {
    return guard([&]() -> Result<VolumeData> {
        Result<BuiltinName> parsed = parseBuiltinName("volume", name, "voxels per side");
        VOXTACT_TRY(parsed);
        std::string known;
        for (const Maker& maker : kMakers) {
            known += (known.empty() ? "" : ", ") + std::string(maker.stem);
        }
        const auto* const maker =
            std::find_if(kMakers.begin(), kMakers.end(), [&](const Maker& m) { return parsed->stem == m.stem; });
        if (maker == kMakers.end()) {
            return refuse("unknown builtin volume '" + parsed->stem + "': " + known);
        }
        const std::uint32_t size = parsed->number.value_or(kDefaultSize);
        if (size < kMinSize || size > kMaxSize) {
            return refuse("builtin volume '" + std::string(name) + "': " + std::to_string(size) +
                          " voxels a side is not possible, " + std::to_string(kMinSize) + " to " +
                          std::to_string(kMaxSize) + " is");
        }
        VolumeData volume = maker->make(size);
        volume.name = parsed->stem;
        return volume;
    });
}

} // namespace voxtact

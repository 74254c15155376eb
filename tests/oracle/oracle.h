// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

#include <cstdint>
#include <span>
#include <vector>

/// The oracle: the paper's fragment program on a plain double-precision rasteriser, written apart from the engine and
/// from src/exact/exact.h. Slow and simple: one triangle after the other, one pixel of its bounding box after the
/// other, nothing skipped. It shares two roundings with everybody: the opacities of the table and the threshold are
/// floats.
namespace voxtact::oracle {

/// One pair, as data, seen once. (Two-view: twice, the second time through sideView().)
struct OraclePair {
    MeshView mesh;
    VolumeView volume;
    TransferFunctionDesc transferFunction;
    View view;
    Mat4 world_from_object = identity();
    double threshold = kDefaultThreshold;
    Projection projection = Projection::View; ///< or DominantAxis: the view is not examined
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel;
};

/// A fragment: a triangle of the mesh at a pixel. A clipped triangle stays one triangle.
struct OracleFragment {
    std::uint32_t triangle = 0;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    // clang-tidy 14 takes the 0 that the compiler writes for a null pointer.
    auto operator<=>(const OracleFragment&) const = default; // NOLINT(modernize-use-nullptr)
};

/// Why two honest rasterisers may disagree on a fragment. A fragment that fails one of the three tests beyond doubt has
/// no doubt, however close the others are: on the edge of a triangle where the volume is transparent, all agree.
enum class Doubt : std::uint32_t {
    None,       ///< they may not: one of them is wrong
    Coverage,   ///< the pixel's centre is within rounding of an edge of the triangle, or of a clipping plane
    Coordinate, ///< the texture coordinate is within rounding of the domain's boundary
    Opacity,    ///< the opacity is within the filter's precision of the threshold
};
[[nodiscard]] const char* toString(Doubt doubt) noexcept;

/// What the oracle knows of one fragment.
struct Evidence {
    bool survives = false; ///< the oracle's own verdict
    bool covered = false;
    /// Pixels from the centre to the nearest edge of the clipped and snapped triangle; negative outside. Minus infinity
    /// where nothing of the triangle is in the view volume.
    double edgeDistance = 0;
    /// Texture space. Where the pixel is not covered, extrapolated in the triangle's plane; if another rasteriser may
    /// cover it, to what that one can reach at most.
    Vec3 coordinate{};
    double domainDistance = 0; ///< texture units to the nearest face of [0,1]^3; negative outside
    double opacity = 0;        ///< at the coordinate clamped to the domain
    double opacityLow = 0;     ///< the least and the greatest opacity within the tolerance of coordinate and weights
    double opacityHigh = 0;
    Doubt doubt = Doubt::None; ///< the first that applies, in the order of the enumeration
};

/// In stored units: a filter in 8-bit arithmetic makes three interpolations, each off by less than one.
inline constexpr double kEightBitFilterError = 3;

/// How far another rasteriser may be from the oracle. Rounding in single precision, from the products of the matrices
/// to the look-up, comes on top and need not be counted in. Defaults: both snap corners to the nearest 1/256 pixel,
/// which is less than 1.5/256 pixel together; filters have weights with 8 fraction bits
/// (VkPhysicalDeviceLimits::subTexelPrecisionBits), and 8-bit images may be filtered in 8 bits.
struct Tolerance {
    double pixels = 1.5 / 256; ///< of a corner on the screen, and so of the place where the triangle is sampled
    double weight = 1.0 / 256; ///< of a voxel, along each axis; and of an entry of the table
    double value = 0; ///< in stored units: kEightBitFilterError for images that are filtered in 8-bit arithmetic
};

/// Every surviving fragment in double precision, sorted. Refuses what the engine refuses.
[[nodiscard]] Result<std::vector<OracleFragment>> oracleSurvivors(const OraclePair& pair);

/// What the oracle knows of a fragment that somebody else has, or has not: any triangle at any pixel of the viewport,
/// covered or not. Refuses what oracleSurvivors() refuses, a fragment that is not of the mesh and viewport, and
/// tolerances that are negative or not finite. Each call checks the whole pair: ask for many fragments at once.
[[nodiscard]] Result<Evidence> oracleEvidence(const OraclePair& pair, const OracleFragment& fragment,
                                              const Tolerance& tolerance);
/// The same for many fragments of one pair, in their order.
[[nodiscard]] Result<std::vector<Evidence>>
oracleEvidence(const OraclePair& pair, std::span<const OracleFragment> fragments, const Tolerance& tolerance);

} // namespace voxtact::oracle

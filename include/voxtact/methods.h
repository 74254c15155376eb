// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace voxtact {

/// How passing fragments are counted. All methods count the same fragments.
enum class CountingMethod : std::uint32_t {
    Query = 0,    ///< precise occlusion query, one per pair
    QueryAny = 1, ///< occlusion query without the precise bit: zero or not zero
    Atomic = 2,   ///< one atomicAdd per passing fragment into the pair's slot; a batch item is one draw
    Subgroup = 3, ///< ballot, then one atomicAdd per subgroup
    Compute = 4,  ///< no rasteriser: a compute shader covers the same pixels by the same rule
    Cpu = 5,      ///< on the host, without a device (voxtact/cpu.h)
};

/// How triangles become fragments.
enum class Projection : std::uint32_t {
    View = 0,    ///< the paper's method: the caller's camera and viewport
    TwoView = 1, ///< the paper's workaround for triangles seen edge-on: the view, and its view volume seen along its x
    /// Needs no camera: projects each triangle along its dominant axis in voxel space, onto a grid of the voxels' size
    /// or finer. The axis is that of the largest component of the triangle's normal, the first of equal ones. Pixel
    /// centres lie at the centres of voxels, or of their samples; depth clips nothing. The viewport is a square with
    /// the volume's longest side, also for Boundary::Clamp.
    DominantAxis = 2,
    /// Needs no camera: decides every voxel cell that a triangle crosses, with bounds, and never misses a contact.
    Certified = 3,
};

/// Default number of samples along a voxel's side in the projection DominantAxis.
inline constexpr std::uint32_t kDefaultSamplesPerVoxel = 1;
/// Maximum number of samples along a voxel's side in the projection DominantAxis.
inline constexpr std::uint32_t kMaxSamplesPerVoxel = 16;
/// Default resolution of the projection Certified, voxels: shorter pieces of a triangle are not divided.
inline constexpr double kDefaultResolution = 1.0 / 64;
/// Default maximum depth of a contact, mm.
inline constexpr double kDefaultMaxDepth = 10;

/// How the image is sampled.
enum class Filter : std::uint32_t {
    Hardware = 0, ///< the device's sampler (on much hardware, weights have 8 fraction bits)
    Exact = 1,    ///< fp32 in a fixed order (src/exact/exact.h): the same bits on every device and on the host
};

/// Treatment of fragments whose texture coordinate leaves [0,1]^3 (paper, section 5).
enum class Boundary : std::uint32_t {
    Auto = 0,  ///< Clamp if it provably gives the same count for this volume, transfer function and threshold
    Range = 1, ///< a range test discards them
    Clamp = 2, ///< no test: the coordinate is clamped. The caller guarantees that the boundary voxels are transparent
};

/// Meaning of a count.
enum class Exactness : std::uint32_t {
    Exact = 0,
    LowerBound = 1, ///< after a boolean query or an early exit, or with undecided fragments
    Refused = 2,    ///< nothing was counted: the pose on the device is not finite or not affine
};

/// Returns the name on the command line ("query-any"), with static lifetime; "unknown" for an invalid method.
[[nodiscard]] VOXTACT_API const char* toString(CountingMethod method) noexcept;
/// Returns the name of a projection: "two-view".
[[nodiscard]] VOXTACT_API const char* toString(Projection projection) noexcept;
/// Returns the name of a filter: "hardware".
[[nodiscard]] VOXTACT_API const char* toString(Filter filter) noexcept;
/// Returns the name of a boundary: "range".
[[nodiscard]] VOXTACT_API const char* toString(Boundary boundary) noexcept;
/// Returns the name of an exactness: "lower-bound".
[[nodiscard]] VOXTACT_API const char* toString(Exactness exactness) noexcept;

/// Returns the methods in the order of their numbers.
[[nodiscard]] VOXTACT_API std::span<const CountingMethod> countingMethods() noexcept;
/// Inverts toString(): "query-any" -> QueryAny. Empty for an unknown name.
[[nodiscard]] VOXTACT_API std::optional<CountingMethod> countingMethodFromName(std::string_view name) noexcept;

/// Returns the projections in the order of their numbers.
[[nodiscard]] VOXTACT_API std::span<const Projection> projections() noexcept;
/// Inverts toString(): "two-view" -> TwoView. Empty for an unknown name.
[[nodiscard]] VOXTACT_API std::optional<Projection> projectionFromName(std::string_view name) noexcept;
/// True if the projection uses the batch's View.
[[nodiscard]] VOXTACT_API bool usesView(Projection projection) noexcept;

/// Returns Exact for methods that give the same count on every device with Exact (compute, cpu), and Hardware for the
/// others.
[[nodiscard]] VOXTACT_API Filter defaultFilter(CountingMethod method) noexcept;
/// Returns the best exactness of a method: LowerBound for QueryAny. An undecided fragment (Certified) or an early exit
/// also makes a count a lower bound; PairAnswer::exactness has the result.
[[nodiscard]] VOXTACT_API Exactness exactness(CountingMethod method) noexcept;

} // namespace voxtact

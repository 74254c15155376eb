// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace voxtact {

/// How surviving fragments are counted. All count the same thing.
enum class CountingMethod : std::uint32_t {
    Query = 0,    ///< precise occlusion query, one a pair
    QueryAny = 1, ///< occlusion query without the precise bit: zero or not zero
    Atomic = 2,   ///< one atomicAdd a survivor into the pair's slot; a batch item is one draw
    Subgroup = 3, ///< ballot, then one atomicAdd a subgroup
    Compute = 4,  ///< no rasteriser: a compute shader covers the same pixels by the same rule
    Cpu = 5,      ///< the host, no device (voxtact/cpu.h)
};

/// How a mesh is turned into fragments.
enum class Projection : std::uint32_t {
    View = 0,    ///< the paper's: the caller's camera and viewport
    TwoView = 1, ///< the paper's workaround for triangles seen edge-on: the view, and its view volume seen along its x
    /// Each triangle along its own dominant axis in voxel space, onto a grid of the voxels' size or finer: no camera.
    /// The axis is that of the largest component of the triangle's normal, of equals the first; pixel centres are at
    /// the centres of voxels, or of their samples; depth clips nothing. The viewport is the square of the volume's
    /// longest side, also for Boundary::Clamp.
    DominantAxis = 2,
    /// Every voxel cell that a triangle passes through, decided with bounds: a contact is never missed. No camera
    Certified = 3,
};

/// Samples along a voxel's side in the projection DominantAxis.
inline constexpr std::uint32_t kDefaultSamplesPerVoxel = 1;
/// The finest grid of the projection DominantAxis.
inline constexpr std::uint32_t kMaxSamplesPerVoxel = 16;
/// The projection Certified stops dividing pieces of a triangle that are no longer than this many voxels.
inline constexpr double kDefaultResolution = 1.0 / 64;
/// How far a contact's penetration is followed, in millimetres.
inline constexpr double kDefaultMaxDepth = 10;

/// How the image is sampled.
enum class Filter : std::uint32_t {
    Hardware = 0, ///< the device's sampler (8 fraction bits of weight on much hardware)
    Exact = 1,    ///< fp32 in a written order (src/exact/exact.h): the same bits on every device and on the host
};

/// What happens to fragments whose texture coordinate leaves [0,1]^3 (paper, section 5).
enum class Boundary : std::uint32_t {
    Auto = 0,  ///< Clamp where it provably gives the same count for this volume, transfer function and threshold
    Range = 1, ///< a range test discards them
    Clamp = 2, ///< no test: the coordinate is clamped. The caller vouches that the boundary voxels are transparent
};

/// What a count is worth.
enum class Exactness : std::uint32_t {
    Exact = 0,
    LowerBound = 1, ///< at least that many: a boolean query, an early exit, or fragments that could not be decided
    Refused = 2,    ///< nothing was counted: the pose, which is on the device, is not finite or not affine
};

/// The name as on the command line ("query-any"); static lifetime; "unknown" for no method.
[[nodiscard]] VOXTACT_API const char* toString(CountingMethod method) noexcept;
/// The same of a projection: "two-view".
[[nodiscard]] VOXTACT_API const char* toString(Projection projection) noexcept;
/// The same of a filter: "hardware".
[[nodiscard]] VOXTACT_API const char* toString(Filter filter) noexcept;
/// The same of a boundary: "range".
[[nodiscard]] VOXTACT_API const char* toString(Boundary boundary) noexcept;
/// The same of an exactness: "lower-bound".
[[nodiscard]] VOXTACT_API const char* toString(Exactness exactness) noexcept;

/// The methods in the order of their numbers.
[[nodiscard]] VOXTACT_API std::span<const CountingMethod> countingMethods() noexcept;
/// The inverse of toString(): "query-any" -> QueryAny. Nothing for an unknown name.
[[nodiscard]] VOXTACT_API std::optional<CountingMethod> countingMethodFromName(std::string_view name) noexcept;

/// The projections in the order of their numbers.
[[nodiscard]] VOXTACT_API std::span<const Projection> projections() noexcept;
/// The inverse of toString(): "two-view" -> TwoView. Nothing for an unknown name.
[[nodiscard]] VOXTACT_API std::optional<Projection> projectionFromName(std::string_view name) noexcept;
/// Whether the projection looks through the batch's View.
[[nodiscard]] VOXTACT_API bool usesView(Projection projection) noexcept;

/// Exact for the methods that are the same on every device with it (compute, cpu), hardware for the others.
[[nodiscard]] VOXTACT_API Filter defaultFilter(CountingMethod method) noexcept;
/// What a count by a method is worth: LowerBound for QueryAny. A fragment that stays undecided (Certified) and an
/// early exit make it a lower bound too; PairAnswer::exactness has the last word.
[[nodiscard]] VOXTACT_API Exactness exactness(CountingMethod method) noexcept;

} // namespace voxtact

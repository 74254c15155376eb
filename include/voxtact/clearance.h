// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

/// How near: plain types, the same for whatever measures.
///
/// The clearance of a pair is the least distance in world mm between the mesh's surface (its triangles; a closed mesh
/// is not filled) and the opaque part of the volume: the points of its closed box, out to the outermost voxels' faces,
/// where the trilinear interpolant's opacity reaches the threshold. It is what the projection `conservative` decides
/// about: 0 is a touch.
namespace voxtact {

/// mm: how near to each other bounds are brought, where nothing else is asked for.
inline constexpr double kDefaultTolerance = 0.01;

/// What is asked of a search for clearances.
struct ClearanceSearch {
    double tolerance = kDefaultTolerance; ///< mm, from 1e-6 on: how near to each other the bounds are brought
    double maximum = std::numeric_limits<double>::infinity(); ///< mm, above 0: what is farther is not measured
};

/// The clearance is at least `lo` and at most `hi`, mm, rounding counted in. Both are 0 where the pair certainly
/// touches, and infinite where nothing is opaque.
struct ClearanceBounds {
    double lo = 0; ///< no point of the surface is nearer to an opaque point
    double hi = 0; ///< some point of the surface is as near
};

/// Why the bounds are no nearer to each other.
enum class ClearanceEnd : std::uint32_t {
    Closed,   ///< they are within the tolerance, or both infinite
    Beyond,   ///< the clearance is not less than the maximum that was asked for: `lo` is the maximum, `hi` infinite
    Rounding, ///< what is left is decided by roundings: the verdict *possible* of a touch
    Budget,   ///< the steps that were allowed are used up
};
/// "closed", "beyond", "rounding" or "budget"; it lives for ever.
[[nodiscard]] VOXTACT_API const char* toString(ClearanceEnd end) noexcept;

/// Two points as far apart as `hi` says, and how the clearance changes with the pose. The same point twice where the
/// pair touches. Of a device they are no farther apart than that, and where they are is known to some ten-millionths of
/// the largest coordinate (ClosestResult in device_results.h).
struct ClosestPoints {
    std::uint32_t triangle = 0; ///< number in the mesh
    Vec3 mesh{};                ///< on that triangle, world mm
    /// Opaque, world mm. Where the opaque part is thinner than rounding can hit (a peak of the transfer function, and
    /// the threshold at its top), a point close to it: an opaque point is then no farther from the triangle, and not
    /// nearer than ClearanceBounds::lo.
    Vec3 volume{};
    /// Of the distance of these two: mm for each mm that the mesh is moved along the world's x, y and z, and mm for
    /// each radian that it is turned, right-handed, about the parallels of these through the object's origin. As long
    /// as they are the closest points. 0 where the pair touches.
    Vec3 perTranslation{};
    Vec3 perRotation{}; ///< see perTranslation
};

/// The clearance of one pair.
struct PairClearance {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    ClearanceBounds bounds; ///< mm
    ClearanceEnd end{};     ///< why they are no nearer to each other
    /// Of a cpu::ClearanceMeter, or of a Detector with DetectorDesc::closest, where `hi` is finite.
    std::optional<ClosestPoints> closest;
};

/// The clearance of one pair to what is opaque and has a label, or to what has it.
struct LabelClearance {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::int32_t label = 0; ///< as in LabelData::values
    ClearanceBounds bounds; ///< mm; infinite where nothing of it is looked for
    ClearanceEnd end{};     ///< why they are no nearer to each other
};

/// Labels that one batch is measured to, at most.
inline constexpr std::uint32_t kMostMeasuredLabels = 4096;

/// What a batch gave for some labels.
struct LabelClearanceAnswer {
    std::vector<LabelClearance> labels; ///< by pair, then in the order that the labels were asked for
    double wallMilliseconds = 0;        ///< of the whole call
};

/// What a batch gave.
struct ClearanceAnswer {
    std::vector<PairClearance> pairs; ///< in the order of the batch
    double wallMilliseconds = 0;      ///< of the whole call
};

/// What is known of a mesh that moves, at one of its poses.
struct TrackedClearance {
    ClearanceBounds bounds; ///< of this pose, mm; wider apart than a ClearanceMeter's
    bool hit = false;       ///< it certainly touches
    bool possible = false;  ///< roundings decide whether it touches; with neither it certainly does not
    bool searched = false;  ///< the volume was looked into; false: it follows from what was known before
};

} // namespace voxtact

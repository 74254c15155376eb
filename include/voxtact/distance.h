// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/bounds.h"
#include "voxtact/data.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

/// How near: plain types, the same for whatever measures.
///
/// The clearance of a pair is the least distance in world mm between the mesh's surface (its triangles; a closed mesh
/// is not filled) and the opaque part of the volume: the points of its closed box, out to the outermost voxels' faces,
/// where the trilinear interpolant's opacity reaches the threshold. It is what the projection `certified` decides
/// about: 0 is a touch.
namespace voxtact {

/// mm: how near to each other bounds are brought, where nothing else is asked for.
inline constexpr double kDefaultTolerance = 0.01;

/// Two points as far apart as `hi` says, and how the clearance changes with the pose. The same point twice where the
/// pair touches.
struct WitnessPoints {
    std::uint32_t triangle = 0; ///< number in the mesh; kInsideMesh: both points are one inside of it
    Vec3 mesh{};                ///< on that triangle, world mm
    /// Opaque, world mm. Where the opaque part is thinner than rounding can hit (a peak of the transfer function, and
    /// the threshold at its top), a point close to it: an opaque point is then no farther from the triangle, and not
    /// nearer than Bounds::lo.
    Vec3 volume{};
    /// Of the distance of these two: mm for each mm that the mesh is moved along the world's x, y and z, and mm for
    /// each radian that it is turned, right-handed, about the parallels of these through the object's origin. As long
    /// as they are the closest points. 0 where the pair touches.
    Vec3 perTranslation{};
    Vec3 perRotation{}; ///< see perTranslation
};

/// The clearance of one pair.
struct PairDistance {
    std::uint32_t pair = 0;               ///< number of the pair in its batch
    std::uint32_t item = 0;               ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0;               ///< number of the pose within that item
    Bounds bounds;                        ///< mm
    StopReason end{};                     ///< why they are no nearer to each other
    std::optional<WitnessPoints> closest; ///< where `hi` is finite
};

/// The clearance of one pair to what is opaque and has a label, or to what has it.
struct LabelDistance {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm; infinite where nothing of it is looked for
    StopReason end{};       ///< why they are no nearer to each other
};

/// Labels that one batch is measured to, at most.
inline constexpr std::uint32_t kMaxMeasuredLabels = 4096;

/// What a batch gave.
struct DistanceAnswer {
    std::vector<PairDistance> pairs;   ///< in the order of the batch; empty where labels were asked for
    std::vector<LabelDistance> labels; ///< by pair, then in the order that the labels were asked for
    double wallMilliseconds = 0;       ///< of the whole call
};

/// What is known of a mesh that moves, at one of its poses.
struct TrackedDistance {
    Bounds bounds;         ///< of this pose, mm; wider apart than those of Distance
    bool hit = false;      ///< it certainly touches
    bool possible = false; ///< roundings decide whether it touches; with neither it certainly does not
    bool searched = false; ///< the volume was looked into; false: it follows from what was known before
};

} // namespace voxtact

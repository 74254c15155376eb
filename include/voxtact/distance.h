// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/bounds.h"
#include "voxtact/data.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

/// Distance: plain types, the same for every engine.
///
/// The distance of a pair is the smallest distance, in world mm, between the mesh's surface (its triangles; a closed
/// mesh is not filled) and the opaque region of the volume. A point is opaque if it lies in the volume's closed box and
/// the opacity of the trilinear interpolant there reaches the threshold. The box extends to the outer faces of the
/// outermost voxels. As in the projection `certified`, distance 0 is a touch.
namespace voxtact {

/// Default tolerance, mm: maximum upper - lower.
inline constexpr double kDefaultTolerance = 0.01;

/// Two points whose distance is `upper`, and the derivative of the distance with respect to the pose. If the pair
/// touches, both points are equal.
struct WitnessPoints {
    std::uint32_t triangle = 0; ///< index in the mesh; kInsideMesh: both are one point inside the mesh
    Vec3 mesh{};                ///< point on that triangle, world mm
    /// Opaque point, world mm. If the opaque region is thinner than rounding can resolve (a peak of the transfer
    /// function that just reaches the threshold), a point close to the region. The nearest opaque point is then no
    /// farther from the triangle than this point, and no nearer than Bounds::lower.
    Vec3 volume{};
    /// Derivative of the distance: mm per mm of translation along the world's x, y and z. perRotation: mm per radian of
    /// right-handed rotation about parallels of these axes through the object's origin. Valid while these points stay
    /// the closest ones. 0 if the pair touches.
    Vec3 perTranslation{};
    Vec3 perRotation{}; ///< see perTranslation
};

/// The distance of one pair.
struct PairDistance {
    std::uint32_t pair = 0;               ///< index of the pair in its batch
    std::uint32_t item = 0;               ///< index of the BatchItem of the pair
    std::uint32_t pose = 0;               ///< index of the pose in that item
    Bounds bounds;                        ///< mm
    StopReason end{};                     ///< why the search stopped
    std::optional<WitnessPoints> closest; ///< if `upper` is finite
};

/// The distance of one pair to the opaque part of a label, or to the whole label.
struct LabelDistance {
    std::uint32_t pair = 0; ///< index of the pair in its batch
    std::uint32_t item = 0; ///< index of the BatchItem of the pair
    std::uint32_t pose = 0; ///< index of the pose in that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm; infinite without a point to measure to
    StopReason end{};       ///< why the search stopped
};

/// Maximum number of labels in one question.
inline constexpr std::uint32_t kMaxMeasuredLabels = 4096;

/// The answer for a batch.
struct DistanceAnswer {
    std::vector<PairDistance> pairs;   ///< in the order of the batch; empty if labels were requested
    std::vector<LabelDistance> labels; ///< by pair, then in the requested order
    double wallMilliseconds = 0;       ///< duration of the whole call
};

/// The state of a moving mesh at one pose.
struct TrackedDistance {
    Bounds bounds;         ///< mm, at this pose; wider than the bounds of Distance
    bool hit = false;      ///< the mesh certainly touches
    bool possible = false; ///< undecided because of rounding. Both false: the mesh certainly does not touch
    bool searched = false; ///< the volume was searched; false: earlier bounds were enough
};

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Continuous collision detection: plain types, the same for every engine.
///
/// A segment joins two poses `from` and `to` of a mesh by a motion. At a parameter t from 0 to 1, the pose is M(t) *
/// from. M(t) is rigid, M(0) is the identity, and M(1) * from is `to`. poseBetween() returns the pose at t. An answer
/// covers all poses of the segment.
namespace voxtact {

/// Kind of motion. A rotation of exactly 180 degrees is counter-clockwise about its axis. The axis points so that its
/// world coordinate of largest magnitude (the first of equal ones) is positive. If rounding makes the angle slightly
/// less, the rotation takes the shorter side.
enum class Interpolation : std::uint32_t {
    /// Along and about one axis, both at constant speed, by at most half a turn (Chasles, 1830).
    Screw,
    /// The centre of the mesh's box moves straight at constant speed; the mesh rotates about it, about one axis at
    /// constant speed, by at most half a turn (Shoemake, 1985).
    Slerp,
};
/// Returns "screw" or "slerp", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Interpolation interpolation) noexcept;

/// Default resolution, mm: maximum motion from toi_lower to toi_upper.
inline constexpr double kDefaultMotionResolution = 0.01;
/// Maximum non-rigid difference (scale, shear) of two poses, in each element of the matrix from one to the other. The
/// motion spreads the difference evenly.
inline constexpr double kMaxDeformation = 1e-3;

/// Returns the pose at a parameter: `from` at 0, `to` at 1; in between, the motion above up to rounding. `centre`:
/// centre of the mesh's box in object space (MeshFacts::bounds); only for Slerp. Refuses poses that are not affine or
/// not invertible, two poses whose motion is not rigid, and a parameter outside 0 to 1.
[[nodiscard]] VOXTACT_API Result<Mat4> poseBetween(const Mat4& from, const Mat4& to, double parameter,
                                                   Interpolation interpolation = Interpolation::Screw,
                                                   const Vec3& centre = {});

/// Returns the shape of a deforming mesh at a parameter, `from` at 0 and `to` at 1: each vertex moves straight, at
/// constant speed. Refuses shapes of different sizes, and a parameter outside 0 to 1.
[[nodiscard]] VOXTACT_API Result<std::vector<double>> shapeBetween(std::span<const double> from,
                                                                   std::span<const double> to, double parameter);

/// A touching pose of a segment.
struct MotionTouch {
    double at = 0;              ///< parameter of the pose
    Mat4 world_from_object{};   ///< the pose
    Vec3 position{};            ///< opaque point on the surface, world mm
    std::uint32_t triangle = 0; ///< index of the triangle in the mesh
};

/// Reason that the search of a segment stopped.
enum class MotionEnd : std::uint32_t {
    Decided, ///< the segment is free, or it touches within the resolution after its collision-free part
    Grazes,  ///< undecided: at some *t* the distance is within the resolution, and neither answer is proven
    Budget,  ///< the iteration limit was reached
};
/// Returns "decided", "grazes" or "budget", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(MotionEnd end) noexcept;

/// The answer for one segment.
struct SegmentMotion {
    std::uint32_t segment = 0; ///< index of the segment in its batch
    std::uint32_t item = 0;    ///< index of the BatchItem of the segment
    std::uint32_t pose = 0;    ///< index of the first pose of the segment in that item
    /// Proven: no pose from 0 to this parameter touches. 1: the whole segment is free. 0: the first pose may touch.
    double freeUntil = 0;
    std::optional<MotionTouch> touch; ///< the earliest certain touch that was found
    bool possible = false;            ///< undecided: neither free nor certainly touching
    MotionEnd end{};                  ///< why the search ended
};

/// The answer for a batch.
struct MotionAnswer {
    std::vector<SegmentMotion> segments; ///< in the order of the batch
    double wallMilliseconds = 0;         ///< duration of the whole call
};

/// Uncertainty of a pose: the mesh is rotated by at most `angle` about any axis through its object's origin, then
/// translated by at most `distance` in any direction.
struct PoseTolerance {
    double distance = 0; ///< mm, at least 0
    double angle = 0;    ///< degrees, 0 to 180
};

} // namespace voxtact

// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// On the way: plain types, the same for whatever checks motions.
///
/// A segment joins two poses `from` and `to` of a mesh by a motion: at a parameter t from 0 to 1 the pose is M(t) *
/// from, where M(t) is rigid, M(0) moves nothing and M(1) * from is `to`. The pose at t is poseBetween(); what is said
/// of a segment is about all of them, those in between included.
namespace voxtact {

/// Which motion. A turn of exactly 180 degrees goes counter-clockwise about that direction of its axis whose coordinate
/// of the largest magnitude in the world is positive (of equal magnitudes the first). Where rounding makes it slightly
/// less, the way is the shorter one.
enum class Interpolation : std::uint32_t {
    /// About and along one axis, both at constant speed, by no more than half a turn (Chasles, 1830).
    Screw,
    /// The middle of the mesh's box goes straight at constant speed, and the mesh turns about it, about one axis at
    /// constant speed and by no more than half a turn (Shoemake, 1985).
    Slerp,
};
/// "screw" or "slerp"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Interpolation interpolation) noexcept;

/// mm: how near to each other the end of what is free and a touch are brought, where nothing else is asked for.
inline constexpr double kDefaultMotionResolution = 0.01;
/// What two poses may differ by that is no rigid motion (scale, shear), in each element of the matrix from one to the
/// other. It is spread evenly over the way.
inline constexpr double kMaxDeformation = 1e-3;

/// The pose at a parameter: `from` at 0, `to` at 1, and rounding apart the motion above in between. `centre`: of the
/// mesh's box, object space (MeshFacts::bounds); Slerp alone needs it. Refuses poses that are not affine or cannot be
/// inverted, two whose motion is not rigid, and a parameter outside of 0 to 1.
[[nodiscard]] VOXTACT_API Result<Mat4> poseBetween(const Mat4& from, const Mat4& to, double parameter,
                                                   Interpolation interpolation = Interpolation::Screw,
                                                   const Vec3& centre = {});

/// The shape at a parameter of a mesh that bends on the way, `from` at 0 and `to` at 1: each vertex goes straight, at
/// constant speed. Refuses shapes of different sizes, and a parameter outside of 0 to 1.
[[nodiscard]] VOXTACT_API Result<std::vector<double>> shapeBetween(std::span<const double> from,
                                                                   std::span<const double> to, double parameter);

/// A pose on the way that touches.
struct MotionTouch {
    double at = 0;              ///< its parameter
    Mat4 world_from_object{};   ///< the pose
    Vec3 position{};            ///< world mm: on the surface, and opaque
    std::uint32_t triangle = 0; ///< number in the mesh
};

/// Why no more is said of a segment.
enum class MotionEnd : std::uint32_t {
    Decided, ///< it is free, or it touches within the resolution of where it is free until
    Grazes,  ///< somewhere it is so near that within the resolution neither is proven: the verdict *possible*
    Budget,  ///< the steps that were allowed are used up
};
/// "decided", "grazes" or "budget"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(MotionEnd end) noexcept;

/// What was found of one segment.
struct SegmentMotion {
    std::uint32_t segment = 0; ///< number of the segment in its batch
    std::uint32_t item = 0;    ///< number of the BatchItem that it came from
    std::uint32_t pose = 0;    ///< number within that item of the pose that it begins with
    /// Certainly no pose from 0 to this parameter touches; 1 where the whole segment is free. At 0 it may be that the
    /// first pose already does.
    double freeUntil = 0;
    std::optional<MotionTouch> touch; ///< certain; the earliest that was found
    bool possible = false;            ///< not free, and no certain touch
    MotionEnd end{};                  ///< why no more is said
};

/// What a batch gave.
struct MotionAnswer {
    std::vector<SegmentMotion> segments; ///< in the order of the batch
    double wallMilliseconds = 0;         ///< of the whole call
};

/// By how much a pose may be off: the mesh is turned by at most so much about any axis through its object's origin, and
/// then moved by at most so far in any direction.
struct PoseTolerance {
    double distance = 0; ///< mm, from 0 on
    double angle = 0;    ///< degrees, 0 to 180
};

} // namespace voxtact

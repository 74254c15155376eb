// SPDX-License-Identifier: MIT
#pragma once

#include "exact/rigid_pose.h"
#include "voxtact/motion.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <string>

namespace voxtact {

/// The motion from a pose to another (voxtact/motion.h): a world point x is at t at c(t) + R(t * angle) (x - c(0)), R
/// turning about the axis, and c(t) the path of the centre of the mesh, an arc for a screw.
class RigidMotion {
  public:
    /// `which` names the poses in an error.
    [[nodiscard]] static Result<RigidMotion> between(const Mat4& from, const Mat4& to, Interpolation interpolation,
                                                     const Vec3& centre, const std::string& which);
    /// Creates the motion between two poses of a batch item. `bounds`: of the mesh, object space.
    [[nodiscard]] static Result<RigidMotion> between(std::span<const Mat4> poses, std::size_t first,
                                                     Interpolation interpolation, const Box& bounds, std::size_t item);

    /// In the representation of src/exact/rigid_pose.h.
    [[nodiscard]] shader::RigidWay way() const;
    /// world_from_object at a parameter from 0 to 1, to the last bit: at the ends as it was given, in between
    /// rigidPose() of the way.
    [[nodiscard]] Mat4 at(double parameter) const;

    /// Velocity from a parameter on: linear * x + offset for a point at x, mm per unit of the parameter. Within a step
    /// s a point deviates from its tangent by at most s^2 / 2 * angle() times its speed without `straight`, because
    /// both motions have a constant acceleration.
    struct Tangent {
        glm::dmat3 linear{0};
        glm::dvec3 offset{};
        glm::dvec3 straight{};
    };
    [[nodiscard]] Tangent tangent(double parameter) const;
    [[nodiscard]] double angle() const noexcept { return angle_; } ///< radians, 0 to pi
    /// Upper bound of the speed of points in a box of object space, mm per unit of the parameter.
    [[nodiscard]] double speed(const Box& box) const;
    /// Upper bound of the deviation from the tangent's velocity by non-rigidity, mm per unit of the parameter.
    [[nodiscard]] double deformation(const Box& box) const;
    /// Upper bound of the rounding of a point's position on the way, mm.
    [[nodiscard]] double rounding(const Box& box) const;

  private:
    [[nodiscard]] double magnitude(const Box& box) const;

    glm::dmat4 from_{1};
    glm::dmat4 to_{1};
    glm::dmat4 deformation_{0}; ///< the non-rigid rest of `to_` at 1
    glm::dvec3 centre_{};       ///< world, at 0
    glm::dvec3 axis_{0, 0, 1};
    double angle_ = 0;
    glm::dvec3 along_{};  ///< straight part of the centre's path
    glm::dvec3 across_{}; ///< the chord of its arc; none for slerp
};

} // namespace voxtact

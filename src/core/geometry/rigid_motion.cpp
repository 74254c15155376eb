// SPDX-License-Identifier: MIT
#include "core/geometry/rigid_motion.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/glm_bridge.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dquat;
using glm::dvec3;

double largest(const dmat3& matrix) {
    double most = 0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            if (std::isnan(matrix[column][row])) {
                return matrix[column][row];
            }
            most = std::max(most, std::abs(matrix[column][row]));
        }
    }
    return most;
}

/// The rotation nearest to a matrix that is about one (Higham, "Computing the polar decomposition", 1986).
dmat3 nearestRotation(const dmat3& matrix) {
    constexpr int kMostSteps = 60;
    dmat3 rotation = matrix;
    for (int step = 0; step < kMostSteps; ++step) {
        const dmat3 next = 0.5 * (rotation + glm::transpose(glm::inverse(rotation)));
        const bool settled = largest(next - rotation) < 1e-15;
        rotation = next;
        if (settled) {
            break;
        }
    }
    return rotation;
}

dmat3 turn(const dvec3& axis, double angle) {
    return glm::mat3_cast(glm::angleAxis(angle, axis));
}

/// Times x it is cross(of, x).
dmat3 crossMatrix(const dvec3& of) {
    return {{0, of.z, -of.y}, {-of.z, 0, of.x}, {of.y, -of.x, 0}};
}

/// sin(part * angle / 2) / sin(angle / 2), for angles up to pi.
double shareOfChord(double part, double angle) {
    const double whole = std::sin(angle / 2);
    return whole > 0 ? std::sin(part * angle / 2) / whole : part;
}

/// Calls `visit` with the corners of a box.
template <class Visit> void forCorners(const Box& box, const Visit& visit) {
    for (unsigned i = 0; i < 8; ++i) {
        visit(dvec3((i & 1U) != 0 ? box.hi[0] : box.lo[0], (i & 2U) != 0 ? box.hi[1] : box.lo[1],
                    (i & 4U) != 0 ? box.hi[2] : box.lo[2]));
    }
}

double largestCoordinate(const dvec3& of) {
    return std::max({std::abs(of.x), std::abs(of.y), std::abs(of.z)});
}

} // namespace

Result<RigidMotion> RigidMotion::between(const Mat4& from, const Mat4& to, Interpolation interpolation,
                                         const Vec3& centre, const std::string& which) {
    VOXTACT_TRY(checkAffine(from, which + ", the first"));
    VOXTACT_TRY(checkAffine(to, which + ", the second"));
    RigidMotion out;
    out.from_ = toGlm(from);
    out.to_ = toGlm(to);
    const dmat3 back = glm::inverse(dmat3(out.from_));
    const dmat3 change = dmat3(out.to_) * back;
    const dmat3 rotation = nearestRotation(change);
    const double off = largest(change - rotation);
    if (!(off <= kMostDeformation) || !(glm::determinant(rotation) > 0)) {
        return refuse(which + (std::isfinite(off)
                                   ? ": the motion from one to the other is not rigid (scale, shear or a "
                                     "mirror image); give poses of one scale"
                                   : ": they cannot be inverted; give poses of full rank"));
    }
    const dquat half = glm::normalize(glm::quat_cast(rotation));
    const dvec3 sine = (half.w < 0 ? -1.0 : 1.0) * dvec3(half.x, half.y, half.z);
    if (const double size = glm::length(sine); size > 0) {
        out.axis_ = sine / size;
        out.angle_ = 2 * std::atan2(size, std::abs(half.w));
    }
    const glm::dvec4 middle(centre[0], centre[1], centre[2], 1);
    out.centre_ = dvec3(out.from_ * middle);
    const dvec3 way = dvec3(out.to_ * middle) - out.centre_;
    out.along_ = interpolation == Interpolation::Screw ? glm::dot(way, out.axis_) * out.axis_ : way;
    out.across_ = way - out.along_;
    out.deformation_ = out.to_ - toGlm(out.at(1));
    return out;
}

dvec3 RigidMotion::centreAt(double parameter) const {
    const dvec3 chord = turn(axis_, (parameter - 1) * angle_ / 2) * across_;
    return centre_ + parameter * along_ + shareOfChord(parameter, angle_) * chord;
}

Mat4 RigidMotion::at(double parameter) const {
    const dmat3 rotation = turn(axis_, parameter * angle_);
    dmat4 pose(rotation * dmat3(from_));
    pose[3] = glm::dvec4(centreAt(parameter) + rotation * (dvec3(from_[3]) - centre_), 1);
    return fromGlm(pose + parameter * deformation_);
}

RigidMotion::Tangent RigidMotion::tangent(double parameter) const {
    Tangent out;
    out.linear = crossMatrix(angle_ * axis_);
    const double whole = std::sin(angle_ / 2);
    const double arc = whole > 0 ? angle_ / 2 / whole : 1;
    out.straight = along_;
    out.offset = along_ + arc * (turn(axis_, (parameter - 0.5) * angle_) * across_) - out.linear * centreAt(parameter);
    return out;
}

/// A speed is the length of an affine function of the place at 0 for a screw, and bounded by one for slerp, where what
/// turns may go any way across the axis: convex, and so greatest at a corner.
double RigidMotion::speed(const Box& box) const {
    const Tangent start = tangent(0);
    double most = 0;
    forCorners(box, [&](const dvec3& corner) {
        const dvec3 place(from_ * glm::dvec4(corner, 1));
        const dvec3 turning = start.linear * place + start.offset - start.straight;
        const double straight = glm::dot(start.straight, axis_);
        const double across = glm::length(start.straight - straight * axis_) + glm::length(turning);
        most = std::max(most, std::hypot(straight, across));
    });
    return most + deformation(box);
}

double RigidMotion::deformation(const Box& box) const {
    double most = 0;
    forCorners(box, [&](const dvec3& corner) {
        most = std::max(most, glm::length(dvec3(deformation_ * glm::dvec4(corner, 1))));
    });
    // It moves what turns, and so changes velocity and acceleration.
    return (1 + angle_ + angle_ * angle_) * most;
}

double RigidMotion::magnitude(const Box& box) const {
    double most = largestCoordinate(centre_) + glm::length(along_) + (1 + angle_) * glm::length(across_);
    forCorners(box, [&](const dvec3& corner) {
        const dvec3 place = glm::abs(dmat3(from_)[0] * corner.x) + glm::abs(dmat3(from_)[1] * corner.y) +
                            glm::abs(dmat3(from_)[2] * corner.z);
        most = std::max(most, 2 * glm::length(place) + 2 * glm::length(dvec3(from_[3])) + 2 * glm::length(centre_));
    });
    return most + glm::length(along_) + glm::length(across_);
}

Result<Mat4> poseBetween(const Mat4& from, const Mat4& to, double parameter, Interpolation interpolation,
                         const Vec3& centre) {
    return guard([&]() -> Result<Mat4> {
        if (!(parameter >= 0 && parameter <= 1)) {
            return refuse("the parameter " + number(parameter) + " is outside of 0 to 1");
        }
        const Result<RigidMotion> motion = RigidMotion::between(from, to, interpolation, centre, "the two poses");
        VOXTACT_TRY(motion);
        return parameter == 0 ? from : parameter == 1 ? to : motion->at(parameter);
    });
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "core/geometry/rigid_motion.h"
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/glm_bridge.h"
#include "core/geometry/wide_matrix.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
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

/// Times x it is cross(of, x).
dmat3 crossMatrix(const dvec3& of) {
    return {{0, of.z, -of.y}, {-of.z, 0, of.x}, {of.y, -of.x, 0}};
}

dvec3 vectorAt(const shader::RigidPose& pose, std::size_t first) {
    return {pose.number[first], pose.number[first + 1], pose.number[first + 2]};
}

Mat4 poseOf(const RigidMotion& motion, double parameter) {
    return toMat4(shader::rigidMatrix(shader::rigidPose(motion.way(), parameter)));
}

/// Magnitude of a vector of three numbers.
void setTerms(shader::RigidWay& way, std::size_t first, const std::array<dvec3, RIGID_TERMS>& terms) {
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t term = 0; term < RIGID_TERMS; ++term) {
            way.term[RIGID_TERMS * (first + row) + term] = terms[term][static_cast<int>(row)];
        }
    }
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
    if (!(off <= kMaxDeformation) || !(glm::determinant(rotation) > 0)) {
        return refuse(which + (std::isfinite(off)
                                   ? ": the motion from one to the other is not rigid (scale, shear or a "
                                     "mirror image); give poses of one scale"
                                   : ": they cannot be inverted in double precision; give poses of full rank and "
                                     "of an ordinary scale"));
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
    out.deformation_ = out.to_ - toGlm(poseOf(out, 1));
    return out;
}

Result<RigidMotion> RigidMotion::between(std::span<const Mat4> poses, std::size_t first, Interpolation interpolation,
                                         const Box& bounds, std::size_t item) {
    const Vec3 centre{0.5 * (bounds.lo[0] + bounds.hi[0]), 0.5 * (bounds.lo[1] + bounds.hi[1]),
                      0.5 * (bounds.lo[2] + bounds.hi[2])};
    return between(poses[first], poses[first + 1], interpolation, centre,
                   "batch item " + std::to_string(item) + ", poses " + std::to_string(first) + " and " +
                       std::to_string(first + 1));
}

shader::RigidWay RigidMotion::way() const {
    const double whole = std::sin(angle_ / 2);
    shader::RigidWay out{};
    out.halfAngle = angle_ / 2;
    out.perSine = whole > 0 ? 1 / whole : 0;
    const dvec3 turned = glm::cross(axis_, across_);
    for (int column = 0; column < 4; ++column) {
        const bool isPlace = column == 3;
        const dvec3 place(from_[column]);
        const dvec3 arm = isPlace ? place - centre_ : place;
        const dvec3 more(deformation_[column]);
        setTerms(out, static_cast<std::size_t>(3 * column),
                 {place, glm::cross(axis_, arm), glm::dot(axis_, arm) * axis_ - arm, isPlace ? along_ + more : more,
                  isPlace ? across_ : dvec3(0), isPlace ? turned : dvec3(0)});
    }
    setTerms(out, RIGID_CENTRE, {centre_, {}, {}, along_, across_, turned});
    const double arc = whole > 0 ? angle_ / 2 / whole : 1; // over its chord
    setTerms(out, RIGID_SPEED, {along_, arc * across_, arc * turned, {}, {}, {}});
    return out;
}

Mat4 RigidMotion::at(double parameter) const {
    if (parameter == 0 || parameter == 1) {
        return fromGlm(parameter == 0 ? from_ : to_);
    }
    return poseOf(*this, parameter);
}

RigidMotion::Tangent RigidMotion::tangent(double parameter) const {
    const shader::RigidPose pose = shader::rigidPose(way(), parameter);
    Tangent out;
    out.linear = crossMatrix(angle_ * axis_);
    out.straight = along_;
    out.offset = vectorAt(pose, RIGID_SPEED) - out.linear * vectorAt(pose, RIGID_CENTRE);
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
    // The centre moves, which changes velocity and acceleration.
    return (1 + angle_ + angle_ * angle_) * most;
}

double RigidMotion::rounding(const Box& box) const {
    constexpr double kPoseError = 0x1p-46; // of the largest coordinate: the rounding of a few dozen operations
    return kPoseError * magnitude(box);
}

/// Upper bound, mm, of the coordinates of a box on the way, and of their terms.
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
        VOXTACT_TRY(checkInterpolation(interpolation));
        const Result<RigidMotion> motion = RigidMotion::between(from, to, interpolation, centre, "the two poses");
        VOXTACT_TRY(motion);
        return motion->at(parameter);
    });
}

} // namespace voxtact

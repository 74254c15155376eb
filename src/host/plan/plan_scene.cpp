// SPDX-License-Identifier: MIT
#include "host/plan/plan_scene.h"

#include "core/geometry/glm_bridge.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dmat3;
using glm::dvec3;

/// Rotation between two directions up to a right angle apart: beyond, 1 + cos loses precision.
dmat3 sharpTurn(const dvec3& from, const dvec3& to) {
    const dvec3 axis = glm::cross(from, to);
    return glm::mat3_cast(glm::normalize(glm::dquat(1 + glm::dot(from, to), axis.x, axis.y, axis.z)));
}

/// The smallest turn that brings one direction to another; half a turn about some axis where they are opposite.
dmat3 smallestTurn(const dvec3& from, const dvec3& to) {
    if (glm::dot(from, to) >= 0) {
        return sharpTurn(from, to);
    }
    // Half a turn about a perpendicular axis, then the small remaining rotation.
    dvec3 axis = glm::cross(from, to);
    if (glm::length(axis) == 0) {
        axis = glm::cross(from, std::abs(from.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0));
    }
    axis = glm::normalize(axis);
    const dmat3 half = 2.0 * glm::outerProduct(axis, axis) - dmat3(1);
    return sharpTurn(glm::normalize(half * from), to) * half;
}

Mat4 poseOf(const dmat3& turn, const dvec3& origin) {
    Mat4 out{};
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            out[static_cast<std::size_t>(4 * column + row)] = turn[column][row];
        }
    }
    for (int row = 0; row < 3; ++row) {
        out[static_cast<std::size_t>(12 + row)] = origin[row];
    }
    out[15] = 1;
    return out;
}

} // namespace

std::int32_t Obstacle::labelAt(const dvec3& local) const {
    constexpr double kFace = 1e-6; // voxels
    if (!labels) {
        return 0;
    }
    const dvec3 voxel = part->space.toVoxel(local) + part->space.centre + 0.5;
    const auto& size = given->labels->grid.size;
    for (unsigned i = 0; i < 8; ++i) {
        std::array<std::size_t, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double beside = ((i >> axis & 1U) != 0 ? kFace : -kFace) + voxel[static_cast<int>(axis)];
            at[axis] =
                static_cast<std::size_t>(std::clamp(std::floor(beside), 0.0, static_cast<double>(size[axis] - 1)));
        }
        const std::size_t index = given->labels->indices[(at[2] * size[1] + at[1]) * size[0] + at[0]];
        if (labels->with[index] != 0) {
            return given->labels->values[index];
        }
    }
    return 0;
}

Mat4 PlanScene::axisPose(const dvec3& direction, double entry) const {
    dmat3 stretch(0);
    stretch[2] = (axisEnd(entry) - axisBegin()) * direction;
    return poseOf(stretch, toGlm(task.target) + axisBegin() * direction);
}

Mat4 PlanScene::meshPose(const dvec3& direction, double entry, Sweep& sweep) const {
    const Vec3& held = task.mesh->axis;
    // Normalises without overflow or underflow, then to the last digit.
    const dvec3 along = toGlm(held) / std::hypot(held[0], held[1], held[2]);
    const dmat3 turn = smallestTurn(glm::normalize(along), direction);
    sweep.offset = 0.5 * entry * direction;
    sweep.straight = sweep.offset;
    return poseOf(turn, toGlm(task.target) + sweep.offset - turn * toGlm(task.mesh->tip));
}

} // namespace voxtact::cpu

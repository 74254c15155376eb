// SPDX-License-Identifier: MIT
#include "cli/plan/plan_colours.h"
#include "cli/plan/plan_picture.h"
#include "core/base/try.h"
#include "core/geometry/glm_bridge.h"
#include "voxtact/samples.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace voxtact::app {

namespace {

using glm::dvec3;

constexpr Colour kInstrument{0.93, 0.94, 0.97};
constexpr Colour kAvoided{0.96, 0.55, 0.10};

void addTriangle(MeshData& mesh, const std::array<dvec3, 3>& corners) {
    for (const dvec3& corner : corners) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size() / 3));
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back(corner[axis]);
        }
    }
}

/// Colour of a path with this safety and distance.
Rgb colourOf(const PlanInputs& inputs, const PlanAnswer& answer, const EntryTriangle& triangle, double maximum) {
    constexpr double kColours = 24; // one mesh per colour
    PlannedPath all = answer.paths[triangle.paths[0]];
    for (const std::uint32_t number : triangle.paths) {
        const PlannedPath& path = answer.paths[number];
        all.clearance.lower = std::min(all.clearance.lower, path.clearance.lower);
        all.safety = path.safety == Safety::Unsafe || all.safety == Safety::Unsafe ? Safety::Unsafe
                     : path.safety == Safety::Undecided                            ? Safety::Undecided
                                                                                   : all.safety;
    }
    if (all.safety == Safety::Safe && !triangle.safe && !inputs.task.mesh) {
        all.safety = Safety::Undecided;
    }
    all.clearance.lower = std::floor(all.clearance.lower / maximum * kColours) / kColours * maximum;
    return planColour(all, maximum);
}

/// Returns a rotation that maps z to a unit direction.
Mat4 poseAlong(const dvec3& direction, const dvec3& origin) {
    const dvec3 second =
        glm::normalize(glm::cross(direction, std::abs(direction.z) < 0.5 ? dvec3(0, 0, 1) : dvec3(1, 0, 0)));
    const dvec3 third = glm::cross(direction, second);
    return {second.x,    second.y,    second.z,    0, third.x,  third.y,  third.z,  0,
            direction.x, direction.y, direction.z, 0, origin.x, origin.y, origin.z, 1};
}

/// Returns half a turn about a unit axis.
glm::dmat3 halfTurn(const dvec3& axis) {
    return 2.0 * glm::outerProduct(axis, axis) - glm::dmat3(1);
}

/// Rotation between two directions, as in a plan with a mesh: half a turn about the first, then half a turn about the
/// bisector, which is one about both.
Mat4 smallestTurn(const dvec3& from, const dvec3& to) {
    dvec3 between = from + to;
    if (glm::length(between) < 1e-6) {
        between = glm::cross(from, std::abs(from.z) < 0.5 ? dvec3(0, 0, 1) : dvec3(1, 0, 0));
    }
    return fromGlm(glm::dmat4(halfTurn(glm::normalize(between)) * halfTurn(from)));
}

MeshData placed(MeshData mesh, const Mat4& world_from_object) {
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        const Vec3 at =
            transformPoint(world_from_object, {mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            mesh.positions[i + axis] = at[axis];
        }
    }
    return mesh;
}

/// The faces of voxels that no voxel of the same is behind.
class VoxelFaces {
  public:
    VoxelFaces(const LabelData& labels, std::set<std::size_t> voxels)
        : grid_(labels.grid), world_from_index_(worldFromIndex(labels.grid)), voxels_(std::move(voxels)) {}

    void addTo(MeshData& mesh) const {
        for (const std::size_t voxel : voxels_) {
            const std::array<std::size_t, 3> at{voxel % grid_.size[0], voxel / grid_.size[0] % grid_.size[1],
                                                voxel / grid_.size[0] / grid_.size[1]};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const int side : {-1, 1}) {
                    if (!has(at, axis, side)) {
                        addFace(mesh, at, axis, side);
                    }
                }
            }
        }
    }

  private:
    [[nodiscard]] bool has(std::array<std::size_t, 3> at, std::size_t axis, int side) const {
        if (side < 0 ? at[axis] == 0 : at[axis] + 1 == grid_.size[axis]) {
            return false;
        }
        at[axis] = side < 0 ? at[axis] - 1 : at[axis] + 1;
        return voxels_.contains((at[2] * grid_.size[1] + at[1]) * grid_.size[0] + at[0]);
    }
    void addFace(MeshData& mesh, const std::array<std::size_t, 3>& at, std::size_t axis, int side) const {
        std::array<dvec3, 4> corners;
        for (unsigned i = 0; i < corners.size(); ++i) {
            Vec3 index{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
            index[axis] += 0.5 * side;
            index[(axis + 1) % 3] += i == 1 || i == 2 ? 0.5 : -0.5;
            index[(axis + 2) % 3] += i >= 2 ? 0.5 : -0.5;
            corners[i] = toGlm(transformPoint(world_from_index_, index));
        }
        addTriangle(mesh, {corners[0], corners[1], corners[2]});
        addTriangle(mesh, {corners[0], corners[2], corners[3]});
    }

    Grid grid_;
    Mat4 world_from_index_;
    std::set<std::size_t> voxels_;
};

} // namespace

std::vector<ColouredMesh> entryMeshes(const PlanInputs& inputs, const TargetPlan& plan, double maximum,
                                      const std::function<bool(const Vec3&)>& kept) {
    const PlanAnswer& answer = plan.answer;
    const dvec3 target = toGlm(plan.target.at);
    const Vec3& spacing = inputs.head->volume.grid().spacing;
    const double lift = std::max({spacing[0], spacing[1], spacing[2]});
    std::map<Rgb, MeshData> meshes;
    for (const EntryTriangle& triangle : answer.triangles) {
        std::array<dvec3, 3> corners;
        dvec3 middle(0);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const PlannedPath& path = answer.paths[triangle.paths[i]];
            const dvec3 entry = toGlm(path.position);
            corners[i] = entry + lift / path.length * (entry - target);
            middle += entry / 3.0;
        }
        if (kept(fromGlm(middle))) {
            addTriangle(meshes[colourOf(inputs, answer, triangle, maximum)], corners);
        }
    }
    std::vector<ColouredMesh> out;
    for (auto& [rgb, mesh] : meshes) {
        out.push_back({std::move(mesh), {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0}});
    }
    return out;
}

Result<ColouredMesh> instrumentMesh(const PlanInputs& inputs, const TargetPlan& plan, const PlannedPath& path) {
    const dvec3 target = toGlm(plan.target.at);
    const dvec3 direction = glm::normalize(toGlm(path.position) - target);
    if (inputs.shownMesh) {
        const cpu::PlanMesh& given = *inputs.task.mesh;
        const dvec3 held = toGlm(given.axis) / std::hypot(given.axis[0], given.axis[1], given.axis[2]);
        Mat4 turn = smallestTurn(held, direction);
        const Vec3 tip = transformPoint(turn, given.tip);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            turn[12 + axis] = plan.target.at[axis] - tip[axis];
        }
        return ColouredMesh{placed(*inputs.shownMesh, turn), kInstrument};
    }
    constexpr double kOutside = 45; // mm
    const Needle& needle = inputs.task.needle;
    const double shown = std::clamp(path.length + kOutside, needle.diameter, needle.length);
    Result<MeshData> mesh = makeNeedle(needle.diameter, shown);
    VOXTACT_TRY(mesh);
    return ColouredMesh{placed(std::move(*mesh), poseAlong(direction, target)), kInstrument};
}

ColouredMesh avoidedMesh(const PlanInputs& inputs, const Vec3& point, const Vec3& normal) {
    ColouredMesh out{{}, kAvoided};
    for (const cpu::PlanObstacle& obstacle : inputs.obstacles) {
        if (obstacle.labels == nullptr) {
            continue;
        }
        const LabelData& labels = *obstacle.labels;
        const Mat4 world_from_index = worldFromIndex(labels.grid);
        const Vec3& spacing = labels.grid.spacing;
        const double thick = std::max({spacing[0], spacing[1], spacing[2]});
        std::set<std::size_t> voxels;
        std::size_t at = 0;
        for (std::uint32_t z = 0; z < labels.grid.size[2]; ++z) {
            for (std::uint32_t y = 0; y < labels.grid.size[1]; ++y) {
                for (std::uint32_t x = 0; x < labels.grid.size[0]; ++x, ++at) {
                    const std::int32_t label = labels.values[labels.indices[at]];
                    if (std::ranges::find(obstacle.avoid, label) == obstacle.avoid.end()) {
                        continue;
                    }
                    const Vec3 world = transformPoint(
                        world_from_index, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
                    const double before = glm::dot(toGlm(world) - toGlm(point), toGlm(normal));
                    if (before <= 0.5 * thick && before >= -2 * thick) {
                        voxels.insert(at);
                    }
                }
            }
        }
        VoxelFaces(labels, std::move(voxels)).addTo(out.mesh);
    }
    return out;
}

} // namespace voxtact::app

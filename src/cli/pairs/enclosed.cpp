// SPDX-License-Identifier: MIT
#include "cli/pairs/enclosed.h"

#include "cli/info/mesh_info.h"
#include "core/transfer/opaque_intervals.h"
#include "core/volume/voxel_visit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace voxtact::app {

namespace {

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns true if a ray from the point, parallel to no edge, crosses an odd number of triangles.
bool isInside(std::span<const std::array<Vec3, 3>> triangles, const Vec3& point) {
    constexpr Vec3 kWay{0.5377, 0.3182, 0.7807};
    bool inside = false;
    for (const auto& [a, b, c] : triangles) {
        const Vec3 u = minus(b, a);
        const Vec3 v = minus(c, a);
        const Vec3 normal = cross(kWay, v);
        const double size = dot(u, normal);
        const Vec3 from = minus(point, a);
        const double s = dot(from, normal) / size;
        const Vec3 other = cross(from, u);
        const double t = dot(kWay, other) / size;
        inside = inside != (size != 0 && s >= 0 && t >= 0 && s + t < 1 && dot(v, other) / size > 0);
    }
    return inside;
}

} // namespace

OpaqueVoxels someOpaqueVoxels(const VolumeView& volume, std::span<const ControlPoint> points, double threshold) {
    constexpr std::uint32_t kMaxPerSide = 64;
    std::array<std::uint32_t, 3> step{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        step[axis] = (volume.grid.size[axis] + kMaxPerSide - 1) / kMaxPerSide;
    }
    const OpaqueIntervals opaque(points, threshold);
    const Mat4 world_from_index = worldFromIndex(volume.grid);
    std::vector<Vec3> out;
    visitVoxels(volume, [&](const auto* voxels) {
        const auto& size = volume.grid.size;
        for (std::uint32_t z = step[2] / 2; z < size[2]; z += step[2]) {
            for (std::uint32_t y = step[1] / 2; y < size[1]; y += step[1]) {
                for (std::uint32_t x = step[0] / 2; x < size[0]; x += step[0]) {
                    const std::size_t number = (std::size_t{z} * size[1] + y) * size[0] + x;
                    const auto value = static_cast<double>(voxels[number]);
                    if (opaque.contain(value, value)) {
                        out.push_back(transformPoint(world_from_index, {double(x), double(y), double(z)}));
                    }
                }
            }
        }
    });
    return std::make_shared<const std::vector<Vec3>>(std::move(out));
}

std::optional<Vec3> enclosedVoxel(const MeshView& mesh, const Mat4& world_from_object,
                                  const std::vector<Vec3>& voxels) {
    constexpr std::size_t kMaxTried = 16;
    std::vector<std::array<Vec3, 3>> triangles(mesh.indices.size() / 3);
    Box box{transformPoint(world_from_object, {mesh.positions[0], mesh.positions[1], mesh.positions[2]}), {}};
    box.hi = box.lo;
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        const double* at = mesh.positions.data() + 3 * std::size_t{mesh.indices[corner]};
        const Vec3 world = transformPoint(world_from_object, {at[0], at[1], at[2]});
        triangles[corner / 3][corner % 3] = world;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], world[axis]);
            box.hi[axis] = std::max(box.hi[axis], world[axis]);
        }
    }
    std::vector<Vec3> near;
    std::ranges::copy_if(voxels, std::back_inserter(near), [&](const Vec3& voxel) {
        return voxel[0] > box.lo[0] && voxel[1] > box.lo[1] && voxel[2] > box.lo[2] && voxel[0] < box.hi[0] &&
               voxel[1] < box.hi[1] && voxel[2] < box.hi[2];
    });
    if (near.empty() || !closednessOf(mesh).closed()) {
        return std::nullopt;
    }
    const auto fromMiddle = [&](const Vec3& voxel) {
        return std::hypot(2 * voxel[0] - box.lo[0] - box.hi[0], 2 * voxel[1] - box.lo[1] - box.hi[1],
                          2 * voxel[2] - box.lo[2] - box.hi[2]);
    };
    const auto tried = near.begin() + static_cast<std::ptrdiff_t>(std::min(kMaxTried, near.size()));
    std::ranges::partial_sort(near, tried, {}, fromMiddle);
    const auto found = std::find_if(near.begin(), tried, [&](const Vec3& voxel) { return isInside(triangles, voxel); });
    return found == tried ? std::nullopt : std::optional(*found);
}

} // namespace voxtact::app

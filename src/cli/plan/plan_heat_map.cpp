// SPDX-License-Identifier: MIT
#include "cli/plan/plan_colours.h"
#include "cli/plan/plan_run.h"
#include "core/geometry/glm_bridge.h"
#include "voxtact/io.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <ostream>

namespace voxtact::app {

namespace {

using glm::dvec3;

/// Corners of a triangle, in voxels: voxel i reaches from i - 0.5 to i + 0.5.
using Corners = std::array<dvec3, 3>;

/// Returns true if a triangle meets a voxel, or rounding decides: tests all separating axes, those of the voxel, the
/// triangle's normal, and the cross products of axes and edges.
bool meets(const Corners& triangle, const dvec3& voxel) {
    constexpr double kDoubt = 1e-9; // voxels
    const Corners at{triangle[0] - voxel, triangle[1] - voxel, triangle[2] - voxel};
    const auto separates = [&](const dvec3& normal) {
        const double a = glm::dot(normal, at[0]);
        const double b = glm::dot(normal, at[1]);
        const double c = glm::dot(normal, at[2]);
        const double reach = (0.5 + kDoubt) * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    const std::array<dvec3, 3> axes{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
    for (const dvec3& axis : axes) {
        if (separates(axis)) {
            return false;
        }
    }
    if (separates(glm::cross(at[1] - at[0], at[2] - at[0]))) {
        return false;
    }
    for (std::size_t edge = 0; edge < at.size(); ++edge) {
        for (const dvec3& axis : axes) {
            if (separates(glm::cross(axis, at[(edge + 1) % at.size()] - at[edge]))) {
                return false;
            }
        }
    }
    return true;
}

/// Collects the minimum over the paths through each voxel.
class HeatMap {
  public:
    explicit HeatMap(const Grid& grid)
        : grid_(grid), index_from_world_(glm::inverse(toGlm(worldFromIndex(grid)))),
          values_(std::size_t{grid.size[0]} * grid.size[1] * grid.size[2], kNoPath) {}

    void addPoint(const Vec3& world, double distance) {
        const dvec3 at = indexOf(world);
        forVoxels(glm::round(at), glm::round(at),
                  [&](const dvec3& /*voxel*/, float& value) { lower(value, distance); });
    }
    void addTriangle(const std::array<Vec3, 3>& world, double distance) {
        const Corners at{indexOf(world[0]), indexOf(world[1]), indexOf(world[2])};
        const dvec3 lo = glm::min(glm::min(at[0], at[1]), at[2]);
        const dvec3 hi = glm::max(glm::max(at[0], at[1]), at[2]);
        forVoxels(glm::floor(lo), glm::ceil(hi), [&](const dvec3& voxel, float& value) {
            if (meets(at, voxel)) {
                lower(value, distance);
            }
        });
    }
    [[nodiscard]] VolumeData volume() const {
        VolumeData out;
        out.grid = grid_;
        out.type = ScalarType::Float32;
        out.voxels.resize(values_.size() * sizeof(float));
        std::memcpy(out.voxels.data(), values_.data(), out.voxels.size());
        return out;
    }

  private:
    static constexpr float kNoPath = -1;

    [[nodiscard]] dvec3 indexOf(const Vec3& world) const {
        return dvec3(index_from_world_ * glm::dvec4(world[0], world[1], world[2], 1));
    }
    static void lower(float& value, double distance) {
        const float one = roundedDown(distance);
        value = value == kNoPath ? one : std::min(value, one);
    }
    /// Visits the voxels of a box inside the grid.
    template <class Visit> void forVoxels(const dvec3& lo, const dvec3& hi, const Visit& visit) {
        const dvec3 last(grid_.size[0] - 1.0, grid_.size[1] - 1.0, grid_.size[2] - 1.0);
        const dvec3 from = glm::max(lo, dvec3(0));
        const dvec3 to = glm::min(hi, last);
        dvec3 voxel;
        for (voxel.z = from.z; voxel.z <= to.z; ++voxel.z) {
            for (voxel.y = from.y; voxel.y <= to.y; ++voxel.y) {
                for (voxel.x = from.x; voxel.x <= to.x; ++voxel.x) {
                    visit(voxel, values_[static_cast<std::size_t>((voxel.z * grid_.size[1] + voxel.y) * grid_.size[0] +
                                                                  voxel.x)]);
                }
            }
        }
    }

    Grid grid_;
    glm::dmat4 index_from_world_;
    std::vector<float> values_;
};

} // namespace

VolumeData planHeatMap(const Grid& grid, const PlanAnswer& answer, bool certified) {
    HeatMap map(grid);
    if (!certified) {
        for (const PlannedPath& path : answer.paths) {
            map.addPoint(path.position, path.clearance.lower);
        }
        return map.volume();
    }
    for (const EntryTriangle& triangle : answer.triangles) {
        const auto& [a, b, c] = triangle.paths;
        map.addTriangle({answer.paths[a].position, answer.paths[b].position, answer.paths[c].position},
                        triangle.clearance);
    }
    return map.volume();
}

std::string volumeEnding(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    for (const char* ending : {".nii.gz", ".nii", ".nrrd", ".mha"}) {
        if (name.ends_with(ending)) {
            return ending;
        }
    }
    return {};
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#pragma once

#include "host/scene/scene_impl.h"
#include "host/search/cells/volume_space.h"
#include "host/search/placed.h"
#include "host/search/sweep.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace voxtact::cpu {

/// A mesh at a pose in the space of a volume: places boxes and triangles at first use. For one thread; reused between
/// pairs for its memory.
class MeshPlace {
  public:
    /// All must live until the next call. `sweep`: where else the mesh may be; in the world's coordinates.
    void begin(const MeshImpl& mesh, const VolumeSpace& space, const Mat4& world_from_object,
               const std::optional<Sweep>& sweep = {});

    [[nodiscard]] const MeshImpl& mesh() const noexcept { return *mesh_; }
    /// Returns true if the mesh is swept.
    [[nodiscard]] bool isSwept() const noexcept { return sweep_.has_value(); }
    [[nodiscard]] Direction along(const glm::dvec3& normal) const noexcept {
        return {normal, sweep_ ? &*sweep_ : nullptr};
    }
    /// A point that is about the closest one, of all places where it may be.
    template <class Placed> [[nodiscard]] glm::dvec3 near(const Placed& placed, const glm::dvec3& from) const noexcept {
        if (!sweep_) {
            return placed.near(from);
        }
        const glm::dvec3 point = sweep_->near(placed, from);
        return placed.own > 0 ? towards(from, point, placed.own) : point;
    }
    /// Returns the nearest point, at its pose.
    [[nodiscard]] glm::dvec3 nearest(const PlacedTriangle& triangle, const glm::dvec3& from) const noexcept {
        return sweep_ ? sweep_->nearest(triangle, from) : triangle.near(from);
    }
    /// Returns a box of the mesh's tree.
    [[nodiscard]] const PlacedBox& box(std::uint32_t level, std::uint32_t node);
    /// The box in centred voxel coordinates around a box of object space, wherever it may be.
    void voxelBounds(const RunBox& box, glm::dvec3& lo, glm::dvec3& hi) const;
    /// The triangles of a cluster: as many as it has are in place. Valid until the next begin().
    [[nodiscard]] const PlacedCluster& cluster(std::uint32_t cluster) {
        if (clusters_[cluster] != pair_) {
            placeCluster(cluster);
            clusters_[cluster] = pair_;
        }
        return placed_[cluster];
    }
    [[nodiscard]] PlacedTriangle triangle(std::uint32_t clusterOfIt, std::uint32_t number) {
        return cluster(clusterOfIt).triangle(number);
    }
    /// Adds the corners of some triangles of a cluster, each once: a bit for each triangle.
    void addCorners(std::uint32_t cluster, std::uint64_t triangles, PointList& points) const;
    /// Returns the number of triangles in a run.
    [[nodiscard]] std::uint32_t count(std::uint32_t run) const;
    /// Returns the number of triangles in a cluster.
    [[nodiscard]] std::uint32_t countOfCluster(std::uint32_t cluster) const;
    /// The place of a run's first triangle in the mesh's arrays.
    [[nodiscard]] std::uint32_t first(std::uint32_t run) const {
        return mesh_->clusters[run / ClusterTree::kRunsOfCluster].firstTriangle +
               run % ClusterTree::kRunsOfCluster * kRunTriangles;
    }
    /// Upper bound of the error of a computed distance between mesh and volume, mm. Infinite if the numbers are too
    /// large or too small to bound it.
    [[nodiscard]] double error() const noexcept { return error_; }
    /// The object's origin, local.
    [[nodiscard]] glm::dvec3 origin() const noexcept { return origin_; }

  private:
    template <class Placed> struct Slot {
        std::uint32_t pair = 0;
        Placed placed;
    };
    /// `own`: PlacedBox::own.
    [[nodiscard]] PlacedBox placed(const RunBox& box, double own) const;
    /// A point, and its maximum approach to another.
    [[nodiscard]] static glm::dvec3 towards(const glm::dvec3& to, const glm::dvec3& from, double by) noexcept;
    void placeCluster(std::uint32_t cluster);
    void placeSwept(std::uint32_t cluster);
    void findError(const Mat4& world_from_object);

    const MeshImpl* mesh_ = nullptr;
    const VolumeSpace* space_ = nullptr;
    std::optional<Sweep> sweep_; ///< local
    glm::dmat3 local_from_object_{1};
    glm::dmat3 voxel_from_object_{1};
    glm::dvec3 origin_{};
    glm::dvec3 floats_{}; ///< the origin of the mesh's floats, local
    double error_ = 0;
    std::uint32_t pair_ = 0; ///< data of another pair are stale
    bool whole_ = false;     ///< there was memory for all that follows
    std::vector<std::vector<Slot<PlacedBox>>> boxes_;
    std::vector<std::uint32_t> clusters_; ///< the pair that they are placed for
    /// A vertex, and where it may be.
    struct PlacedVertex {
        glm::dvec3 lo{}; ///< centred voxel coordinates
        glm::dvec3 hi{};
        double wide = 0; ///< mm, as PlacedBox has them
        double own = 0;
    };
    [[nodiscard]] glm::dvec3 vertex(std::size_t at) const;
    [[nodiscard]] PlacedVertex placedVertex(const glm::dvec3& local, double own) const;
    std::array<std::vector<double>, 3> vertices_; ///< local x, y and z
    std::vector<PlacedVertex> clusterVertices_;   ///< of the cluster that is placed
    std::vector<PlacedCluster> placed_;
};

} // namespace voxtact::cpu

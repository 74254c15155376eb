// SPDX-License-Identifier: MIT
#pragma once

#include "app/opaque_cells.h"

#include <memory>
#include <span>

/// What people use today, to compare with: the Flexible Collision Library, a mesh of triangles against an octree of
/// the opaque voxels. Part of the program where FCL and OctoMap are found when it is built.
namespace voxtact::app {

/// "FCL 0.7.0", or nothing where it is not built in.
[[nodiscard]] std::string fclVersion();

enum class FclScalar { Float, Double };

/// A mesh (BVHModel of OBBRSS) against an octree. One thread.
class FclPeer {
  public:
    FclPeer() = default;
    FclPeer(const FclPeer&) = delete;
    FclPeer& operator=(const FclPeer&) = delete;
    virtual ~FclPeer() = default;
    /// Whether they collide at a rigid pose.
    [[nodiscard]] virtual bool touches(const Mat4& world_from_object) const = 0;
};

/// The octree, which peers share.
class FclVolume {
  public:
    /// Unsupported where FCL is not built in; LimitExceeded beyond the 65,536 cells a side that OctoMap has keys for.
    [[nodiscard]] static Result<FclVolume> create(const OpaqueCells& cells);
    [[nodiscard]] Result<std::unique_ptr<FclPeer>> peer(const MeshView& mesh, FclScalar scalar) const;

    struct State;

  private:
    explicit FclVolume(std::shared_ptr<const State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<const State> state_;
};

} // namespace voxtact::app

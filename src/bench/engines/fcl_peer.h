// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// A library to compare with: the Flexible Collision Library, a mesh of triangles against an octree of the opaque
/// voxels. Part of the program if the build finds FCL and OctoMap. Uses plain types only: FCL's headers take minutes to
/// compile, and need no recompilation after changes of ours.
namespace voxtact::lab {

/// Column-major, as Mat4.
using FclMatrix = std::array<double, 16>;

/// Cubes, x fastest. Cell (i, j, k) is from (i, j, k) * side to one side further on.
struct FclCells {
    std::array<std::uint32_t, 3> size{};
    double side = 0;
    const std::vector<bool>* occupied = nullptr;
    /// From the space whose origin is the cell at half of each size, rounded down; rigid.
    FclMatrix world_from_tree{};
};

enum class FclScalar { Float, Double };

/// FCL's method to find the first contact of a motion.
enum class FclOnTheWay {
    Poses,   ///< at a number of poses, with the first and the last: CCDC_NAIVE
    Advance, ///< conservative advancement; -1 if unavailable
};

/// Three numbers per vertex, three vertices per triangle. Objects made of it copy it.
struct FclMesh {
    std::span<const double> positions;
    std::span<const std::uint32_t> indices;
};

/// Tests whether a mesh (BVHModel of OBBRSS) collides with an octree at a rigid pose. One thread.
using FclPeer = std::function<bool(const FclMatrix& world_from_object)>;
/// The distance of the two as FCL has it, in double: -1 where they collide.
using FclDistance = std::function<double(const FclMatrix& world_from_object)>;
/// The parameter of the first contact on the screw motion from one pose to another, in double; 1 where there is none.
using FclMotion = std::function<double(const FclMatrix& from, const FclMatrix& to, FclOnTheWay how, unsigned poses)>;

/// An octree, shared by the objects made of it.
struct FclVolume {
    std::string version; ///< "FCL 0.7.0"
    std::function<FclPeer(const FclMesh& mesh, FclScalar scalar)> peer;
    std::function<FclDistance(const FclMesh& mesh)> distance;
    std::function<FclMotion(const FclMesh& mesh)> motion;
};
/// Null, with the reason in `why`, where FCL is not built in, and beyond the 65,536 cells per side that OctoMap has
/// keys for.
[[nodiscard]] std::shared_ptr<const FclVolume> makeFclVolume(const FclCells& cells, std::string& why);

} // namespace voxtact::lab

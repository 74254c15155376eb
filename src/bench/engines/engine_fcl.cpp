// SPDX-License-Identifier: MIT
#include "bench/engines/engine.h"
#include "bench/engines/opaque_cells.h"
#include "bench/measure/stopwatch.h"

namespace voxtact::lab {

namespace {

Result<Pass> askFcl(const FclPeer& peer, const Work& work, const Feeding& /*feeding*/) {
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    const Stopwatch watch;
    for (const Mat4& pose : work.poses) {
        const bool hit = peer(pose);
        pass.pairs.push_back({.hit = hit, .count = hit ? 1U : 0U});
    }
    pass.wallMilliseconds = watch.milliseconds();
    return pass;
}

} // namespace

Engine makeFclEngine(const VolumePart& volume, const MeshPart& mesh, FclScalar scalar) {
    return engineOf({.name = scalar == FclScalar::Float ? "fcl-float" : "fcl-double",
                     .projection = "octree",
                     .question = questionOf(true, {})},
                    volume.fcl->peer({mesh.data.positions, mesh.data.indices}, scalar), askFcl);
}

std::string makeOctree(VolumePart& volume) {
    const Result<OpaqueCells> cells = opaqueCells(volume.data.view(), volume.transferFunction(), volume.threshold);
    if (!cells.ok()) {
        return "FCL: " + cells.error().text;
    }
    Vec3 origin{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto before = cells->size[axis] / 2; // whole cells: the octree's origin is between two of them
        origin[axis] = before * cells->side;
    }
    std::string why;
    volume.fcl = makeFclVolume(
        {cells->size, cells->side, &cells->opaque, multiply(cells->world_from_cells, translation(origin))}, why);
    if (volume.fcl == nullptr) {
        return "FCL: " + why;
    }
    return volume.fcl->version + ": BVHModel of OBBRSS against an octree of opaque voxels" +
           (cells->resampled
                ? ", which are no cubes: cells of the smallest spacing, each with the value of the voxel at "
                  "its centre"
                : "");
}

} // namespace voxtact::lab

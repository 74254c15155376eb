// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/oracle_scenes.h"
#include "support/scenes.h"

#include <array>

namespace voxtact::test {

/// One opaque voxel in an empty image whose voxels are not cubes, and triangles of known distance to it.
struct OneVoxel {
    Grid grid = anisotropic();
    VolumeData image =
        makeBytes(grid, [](auto x, auto y, auto z) { return x == 12 && y == 10 && z == 11 ? 255.0 : 0.0; });
    std::array<ControlPoint, 2> points{ControlPoint{0, 0}, ControlPoint{255, 1}};

    /// A point, a segment or a triangle, by axis, that is so many mm away from what is opaque at a threshold of 0.5:
    /// along an axis that ends half a voxel from the voxel's centre. `side`: 1 above, -1 below.
    [[nodiscard]] MeshData meshAt(std::size_t axis, double side, double distance) const {
        Vec3 tip{6, 10, 8.8};
        tip[axis] += side * (distance + grid.spacing[axis] / 2);
        Vec3 far = tip;
        far[axis] += side * 5;
        far[(axis + 1) % 3] += 1;
        MeshData mesh;
        addTriangle(mesh, tip, far, axis == 0 ? tip : far);
        return mesh;
    }

  private:
    static Grid anisotropic() {
        Grid grid;
        grid.size = {24, 20, 22};
        grid.spacing = {0.5, 1, 0.8};
        return grid;
    }
};

} // namespace voxtact::test

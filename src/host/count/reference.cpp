// SPDX-License-Identifier: MIT
#include "host/count/reference.h"
#include "core/geometry/pair_transform.h"
#include "core/geometry/projection.h"
#include "core/geometry/recentre.h"
#include "core/method/method_table.h"
#include "core/volume/voxel_visit.h"
#include "exact/dominant.h"
#include "host/scene/stored_voxels.h"

#include <vector>

namespace voxtact::cpu {

namespace {

using namespace shader;

struct Scene {
    const ReferencePair& pair;
    Recentred mesh{};
    PairTransform transform{};
    ItemConstants constants{};
    std::vector<float> table;
    float guardX = 0;
    float guardY = 0;
    int width = 0;
    int height = 0;
};

Scene makeScene(const ReferencePair& pair) {
    Scene scene{
        .pair = pair, .mesh = recentred(pair.mesh.positions), .table = sampleTable(pair.transferFunction).value()};
    const Cameras cameras(pair.projection, pair.view);
    scene.transform =
        pairTransform(cameras.clip_from_world().front(), worldFromFloats(pair.world_from_object, scene.mesh.origin),
                      textureFromWorld(pair.volume.grid).value());
    scene.constants =
        itemConstants(1, storedIntercept(pair.volume.type), tableDomain(pair.transferFunction), pair.threshold);
    const auto side = static_cast<std::uint32_t>(dominantSide(pair.volume.grid, pair.samplesPerVoxel));
    const bool dominant = rowOf(pair.projection).voxelGrid;
    const std::uint32_t width = dominant ? side : pair.view.width;
    const std::uint32_t height = dominant ? side : pair.view.height;
    scene.guardX = exactGuard(width);
    scene.guardY = exactGuard(height);
    scene.width = static_cast<int>(width);
    scene.height = static_cast<int>(height);
    return scene;
}

float interpolated(const Scene& scene, const ExactCell& x, const ExactCell& y, const ExactCell& z) {
    const auto& size = scene.pair.volume.grid.size;
    return visitVoxels(scene.pair.volume, [&](const auto* voxels) {
        const auto row = [&](int atY, int atZ) {
            const auto first = (static_cast<std::size_t>(atZ) * size[1] + static_cast<std::size_t>(atY)) * size[0];
            return exactLerp(storedValue(voxels[first + static_cast<std::size_t>(x.below)]),
                             storedValue(voxels[first + static_cast<std::size_t>(x.above)]), x.weight);
        };
        const float nearer = exactLerp(row(y.below, z.below), row(y.above, z.below), y.weight);
        const float farther = exactLerp(row(y.below, z.above), row(y.above, z.above), y.weight);
        return exactLerp(nearer, farther, z.weight);
    });
}

bool survives(const Scene& scene, float tx, float ty, float tz) {
    if (scene.pair.rangeTest && !(exactInDomain(tx) && exactInDomain(ty) && exactInDomain(tz))) {
        return false;
    }
    const auto& size = scene.pair.volume.grid.size;
    const float stored = interpolated(scene, exactCell(exactClamp(tx), static_cast<int>(size[0])),
                                      exactCell(exactClamp(ty), static_cast<int>(size[1])),
                                      exactCell(exactClamp(tz), static_cast<int>(size[2])));
    const ExactCell entry = exactEntry(stored, scene.constants.scalarScale, scene.constants.scalarBias,
                                       static_cast<int>(scene.table.size()));
    const float opacity = exactLerp(scene.table[static_cast<std::size_t>(entry.below)],
                                    scene.table[static_cast<std::size_t>(entry.above)], entry.weight);
    return opacity >= scene.constants.threshold;
}

void addTriangle(const Scene& scene, const ExactTriangle& triangle, ReferenceCounts& counts) {
    for (int y = triangle.minY; y <= triangle.maxY; ++y) {
        for (int x = triangle.minX; x <= triangle.maxX; ++x) {
            float tx = 0;
            float ty = 0;
            float tz = 0;
            if (exactFragment(triangle, x, y, tx, ty, tz)) {
                ++counts.covered;
                counts.survivors += survives(scene, tx, ty, tz) ? 1U : 0U;
            }
        }
    }
}

ExactCorner cornerOf(const Scene& scene, std::uint32_t vertex) {
    const float* at = scene.mesh.positions.data() + std::size_t{3} * vertex;
    return exactVertex(scene.transform, at[0], at[1], at[2]);
}

} // namespace

ReferenceCounts referenceCounts(const ReferencePair& pair) {
    const Scene scene = makeScene(pair);
    ReferenceCounts counts;
    for (std::size_t i = 0; i < pair.mesh.indices.size(); i += 3) {
        ExactCorner corners[EXACT_MAX_CORNERS];
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = cornerOf(scene, pair.mesh.indices[i + k]);
        }
        if (pair.rangeTest && exactBeyond(corners[0], corners[1], corners[2])) {
            continue;
        }
        if (rowOf(pair.projection).voxelGrid &&
            !dominantProject(corners[0], corners[1], corners[2], dominantGrid(pair.volume.grid))) {
            continue;
        }
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
            inside = inside && exactInside(corners[k], scene.guardX, scene.guardY);
        }
        const int count = inside ? 3 : exactClip(3, corners, scene.guardX, scene.guardY);
        for (int k = 1; k + 1 < count; ++k) {
            ExactTriangle triangle;
            if (exactSetUp(corners[0], corners[k], corners[k + 1], scene.width, scene.height, triangle)) {
                addTriangle(scene, triangle, counts);
            }
        }
    }
    return counts;
}

} // namespace voxtact::cpu

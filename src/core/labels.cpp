// SPDX-License-Identifier: MIT
#include "voxtact/labels.h"
#include "core/guard.h"
#include "core/text.h"
#include "core/voxel_visit.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

Result<LabelData> makeLabels(const VolumeView& volume) {
    return guard([&]() -> Result<LabelData> {
        if (const Result<ValueRange> range = checkVolume(volume); !range.ok()) {
            return range.error();
        }
        LabelData out{volume.grid, {}, {0}};
        visitVoxels(volume, [&](const auto* voxels) {
            const std::uint64_t count = voxelCount(volume.grid);
            for (std::uint64_t i = 0; i < count; ++i) {
                out.values.push_back(static_cast<std::int32_t>(voxels[i]));
            }
            std::sort(out.values.begin(), out.values.end());
            out.values.erase(std::unique(out.values.begin(), out.values.end()), out.values.end());
            for (std::uint64_t i = 0; i < count; ++i) {
                const auto at =
                    std::lower_bound(out.values.begin(), out.values.end(), static_cast<std::int32_t>(voxels[i]));
                out.indices.push_back(static_cast<std::uint16_t>(at - out.values.begin()));
            }
        });
        return out;
    });
}

std::uint32_t labelAt(const LabelData& labels, const Vec3& world) noexcept {
    const auto zero = std::lower_bound(labels.values.begin(), labels.values.end(), 0) - labels.values.begin();
    const Vec3 texture = transformPoint(textureFromWorld(labels.grid).value(), world);
    std::size_t at = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        if (!(texture[axis] >= 0 && texture[axis] <= 1)) {
            return static_cast<std::uint32_t>(zero);
        }
        const std::size_t size = labels.grid.size[axis];
        const auto voxel = static_cast<std::size_t>(texture[axis] * static_cast<double>(size));
        at = at * size + std::min(voxel, size - 1);
    }
    return labels.indices[at];
}

} // namespace voxtact

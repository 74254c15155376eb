// SPDX-License-Identifier: MIT
#include "core/volume/boundary.h"
#include "core/volume/voxel_visit.h"

#include <algorithm>

namespace voxtact {

namespace {

/// One face: `origin` is the index of its first voxel, `du`, `dv` the strides along it, `nu`, `nv` its size.
struct Face {
    std::uint64_t origin, du, dv;
    std::uint32_t nu, nv;
};

std::vector<Face> facesOf(const Grid& grid) {
    const std::uint64_t stride[3] = {1, grid.size[0], std::uint64_t{grid.size[0]} * grid.size[1]};
    std::vector<Face> faces;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        faces.push_back({0, stride[u], stride[v], grid.size[u], grid.size[v]});
        faces.push_back({stride[axis] * (grid.size[axis] - 1), stride[u], stride[v], grid.size[u], grid.size[v]});
    }
    return faces;
}

template <class Scalar> void addFace(const Face& face, const Scalar* voxels, std::vector<ValueRange>& ranges) {
    for (std::uint32_t v = 0; v < std::max(face.nv - 1, 1U); ++v) {
        for (std::uint32_t u = 0; u < std::max(face.nu - 1, 1U); ++u) {
            // An image of one voxel along an axis has cells of one voxel.
            const std::uint64_t stepU = face.nu > 1 ? face.du : 0;
            const std::uint64_t stepV = face.nv > 1 ? face.dv : 0;
            const Scalar* cell = voxels + face.origin + u * face.du + v * face.dv;
            const auto [lo, hi] = std::minmax({cell[0], cell[stepU], cell[stepV], cell[stepU + stepV]});
            ranges.push_back({static_cast<double>(lo), static_cast<double>(hi)});
        }
    }
}

/// Sorts and merges in place.
void merge(std::vector<ValueRange>& ranges) {
    std::sort(ranges.begin(), ranges.end(), [](const ValueRange& a, const ValueRange& b) { return a.lo < b.lo; });
    std::size_t kept = 0;
    for (const ValueRange& range : ranges) {
        if (kept > 0 && range.lo <= ranges[kept - 1].hi) {
            ranges[kept - 1].hi = std::max(ranges[kept - 1].hi, range.hi);
        } else {
            ranges[kept++] = range;
        }
    }
    ranges.resize(kept);
}

} // namespace

std::vector<ValueRange> boundaryRanges(const VolumeView& volume) {
    std::vector<ValueRange> ranges;
    for (const Face& face : facesOf(volume.grid)) {
        visitVoxels(volume, [&](const auto* voxels) { addFace(face, voxels, ranges); });
        merge(ranges);
    }
    return ranges;
}

} // namespace voxtact

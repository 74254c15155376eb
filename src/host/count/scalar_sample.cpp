// SPDX-License-Identifier: MIT
#include "host/count/scalar_sample.h"
#include "exact/exact.h"
#include "host/scene/stored_voxels.h"

#include <limits>

namespace voxtact::cpu {

namespace {

/// exactCell(), as an index into the padded image.
struct PaddedCell {
    std::int64_t index;
    float weight;
};

PaddedCell paddedCell(float coordinate, std::int32_t size) {
    const float shifted = coordinate * static_cast<float>(size) - 0.5F;
    const float whole = shader::floor(shifted);
    return {static_cast<std::int64_t>(whole) + 1, shifted - whole};
}

} // namespace

bool fitsOffsets(const StoredImage& image) noexcept {
    return image.bytes.size() <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
}

float storedAt(const StoredImage& image, float x, float y, float z) noexcept {
    const PaddedCell cellX = paddedCell(x, image.size[0]);
    const PaddedCell cellY = paddedCell(y, image.size[1]);
    const PaddedCell cellZ = paddedCell(z, image.size[2]);
    return image.visit([&](const auto* voxels) {
        const auto* first = voxels + cellX.index + cellY.index * image.stride[1] + cellZ.index * image.stride[2];
        const auto row = [&](const auto* at) {
            return shader::exactLerp(storedValue(at[0]), storedValue(at[1]), cellX.weight);
        };
        const auto layer = [&](const auto* at) {
            return shader::exactLerp(row(at), row(at + image.stride[1]), cellY.weight);
        };
        return shader::exactLerp(layer(first), layer(first + image.stride[2]), cellZ.weight);
    });
}

bool sampleIsOpaque(const StoredImage& image, const Occupancy& occupancy, float x, float y, float z) noexcept {
    return isOpaque(occupancy.table(), occupancy.constants(), storedAt(image, x, y, z));
}

} // namespace voxtact::cpu

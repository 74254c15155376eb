// SPDX-License-Identifier: MIT
#include "core/volume/label_lookup.h"

#include <algorithm>
#include <optional>

namespace voxtact {

namespace {

/// Returns the cell of a texture coordinate; none outside [0,1].
std::optional<std::uint32_t> cellOf(double coordinate, std::uint32_t size) {
    if (!(coordinate >= 0 && coordinate <= 1)) {
        return std::nullopt;
    }
    return std::min(static_cast<std::uint32_t>(coordinate * size), size - 1);
}

} // namespace

LabelLookup::LabelLookup(const LabelData& labels)
    : labels_(labels), texture_from_world_(textureFromWorld(labels.grid).value()),
      none_(static_cast<std::uint32_t>(std::lower_bound(labels.values.begin(), labels.values.end(), 0) -
                                       labels.values.begin())) {}

std::uint32_t LabelLookup::at(const Vec3& world) const noexcept {
    const Vec3 texture = transformPoint(texture_from_world_, world);
    const Grid& grid = labels_.grid;
    const std::optional<std::uint32_t> x = cellOf(texture[0], grid.size[0]);
    const std::optional<std::uint32_t> y = cellOf(texture[1], grid.size[1]);
    const std::optional<std::uint32_t> z = cellOf(texture[2], grid.size[2]);
    if (!x || !y || !z) {
        return none_;
    }
    return labels_.indices[(std::size_t{*z} * grid.size[1] + *y) * grid.size[0] + *x];
}

} // namespace voxtact

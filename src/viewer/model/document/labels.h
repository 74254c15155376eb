// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/results.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// Names of structures at positions.
namespace voxtact::view {

/// A label map and the names of its labels; a label may have no name.
struct Labels {
    LabelData map;
    std::map<std::int32_t, std::string> names;
};

/// Returns the label at a world point; 0 outside the map.
[[nodiscard]] std::int32_t labelOf(const Labels& labels, const Vec3& world) noexcept;

/// Returns the name of a label; empty if none.
[[nodiscard]] std::string nameOf(const Labels& labels, std::int32_t label);

/// "7 skull", or "7" where it has no name.
[[nodiscard]] std::string labelText(const Labels& labels, std::int32_t label);

/// Sorts by passing fragments, descending; equal ones by label. Drops 0 if there is another label: the background has
/// no information.
[[nodiscard]] std::vector<LabelCount> touchedLabels(std::vector<LabelCount> counts);

/// "x, y, z mm: value", and with labels "7 skull". `labels` may be null.
[[nodiscard]] std::string placeText(const VolumeView& volume, const Mat4& texture_from_world, const Labels* labels,
                                    const Vec3& world);

} // namespace voxtact::view

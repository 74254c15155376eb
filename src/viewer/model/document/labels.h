// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/results.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// Which structure is where, in words.
namespace voxtact::view {

/// A label map, and what its labels are called; a label may have no name.
struct Labels {
    LabelData map;
    std::map<std::int32_t, std::string> names;
};

/// The label at a world point; 0 outside of the map.
[[nodiscard]] std::int32_t labelOf(const Labels& labels, const Vec3& world) noexcept;

/// The name; empty where it has none.
[[nodiscard]] std::string nameOf(const Labels& labels, std::int32_t label);

/// "7 skull", or "7" where it has no name.
[[nodiscard]] std::string labelText(const Labels& labels, std::int32_t label);

/// Those with the most survivors first; of equal ones the lowest label. Without 0, where there is another: the
/// background says nothing then.
[[nodiscard]] std::vector<LabelCount> touchedLabels(std::vector<LabelCount> counts);

/// "x, y, z mm: value", and with labels "7 skull". `labels` may be null.
[[nodiscard]] std::string placeText(const VolumeView& volume, const Mat4& texture_from_world, const Labels* labels,
                                    const Vec3& world);

} // namespace voxtact::view

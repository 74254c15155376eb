// SPDX-License-Identifier: MIT
#include "viewer/model/document/labels.h"

#include "viewer/model/shown/histogram.h"
#include "viewer/model/shown/slice.h"

#include <algorithm>
#include <cstdio>
#include <optional>

namespace voxtact::view {

std::int32_t labelOf(const Labels& labels, const Vec3& world) noexcept {
    return labels.map.values[labelAt(labels.map, world)];
}

std::string nameOf(const Labels& labels, std::int32_t label) {
    const auto name = labels.names.find(label);
    return name == labels.names.end() ? std::string() : name->second;
}

std::string labelText(const Labels& labels, std::int32_t label) {
    const std::string name = nameOf(labels, label);
    return std::to_string(label) + (name.empty() ? "" : " " + name);
}

std::vector<LabelCount> touchedLabels(std::vector<LabelCount> counts) {
    if (std::ranges::any_of(counts, [](const LabelCount& entry) { return entry.label != 0; })) {
        std::erase_if(counts, [](const LabelCount& entry) { return entry.label == 0; });
    }
    std::ranges::sort(counts, [](const LabelCount& a, const LabelCount& b) {
        return a.count != b.count ? a.count > b.count : a.label < b.label;
    });
    return counts;
}

std::string placeText(const VolumeView& volume, const Mat4& texture_from_world, const Labels* labels,
                      const Vec3& world) {
    const std::optional<double> value = valueAt(volume, texture_from_world, world);
    char number[32] = "outside the volume";
    if (value) {
        std::snprintf(number, sizeof number, "%g", *value);
    }
    const auto place = [&](std::size_t axis) { return mmText(volume.grid, 1, world[axis]); };
    const std::string text = place(0) + ", " + place(1) + ", " + place(2) + " mm: " + number;
    return labels == nullptr ? text : text + "   label " + labelText(*labels, labelOf(*labels, world));
}

} // namespace voxtact::view

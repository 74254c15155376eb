// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/volume/label_lookup.h"
#include "voxtact/plan.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

const char* toString(Safety safety) noexcept {
    switch (safety) {
    case Safety::Unsafe:
        return "unsafe";
    case Safety::Safe:
        return "safe";
    case Safety::Possible:
        return "possible";
    }
    return "unknown";
}

namespace {

std::vector<std::int32_t> labelsBetween(const LabelData& labels, const Mat4& texture_from_world, const Vec3& from,
                                        const Vec3& to) {
    std::vector<std::int32_t> out;
    const Vec3 first = transformPoint(texture_from_world, from);
    const Vec3 last = transformPoint(texture_from_world, to);
    // Where the line goes from one layer of voxels to another, as its part from 0 to 1.
    std::vector<double> steps{0, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = labels.grid.size[axis];
        const double begin = first[axis] * size;
        const double way = last[axis] * size - begin;
        const double lo = std::max(std::ceil(std::min(begin, begin + way)), 0.0);
        const double hi = std::min(std::max(begin, begin + way), size);
        for (double face = lo; face <= hi && way != 0; ++face) {
            steps.push_back(std::clamp((face - begin) / way, 0.0, 1.0));
        }
    }
    std::sort(steps.begin(), steps.end());
    const LabelLookup lookup(labels);
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        const double middle = 0.5 * (steps[i] + steps[i + 1]);
        const Vec3 at{from[0] + middle * (to[0] - from[0]), from[1] + middle * (to[1] - from[1]),
                      from[2] + middle * (to[2] - from[2])};
        const std::int32_t label = labels.values[lookup.at(at)];
        if (steps[i + 1] > steps[i] && label != 0 && std::find(out.begin(), out.end(), label) == out.end()) {
            out.push_back(label);
        }
    }
    return out;
}

} // namespace

Result<std::vector<std::int32_t>> labelsAlong(const LabelData& labels, const Vec3& from, const Vec3& to) {
    return guard([&]() -> Result<std::vector<std::int32_t>> {
        const auto isFinite = [](const Vec3& v) {
            return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
        };
        if (!isFinite(from) || !isFinite(to)) {
            return refuse("an end of the line is not finite");
        }
        const Result<Mat4> texture = textureFromWorld(labels.grid);
        VOXTACT_TRY(texture);
        return labelsBetween(labels, *texture, from, to);
    });
}

} // namespace voxtact

// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "voxtact/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace voxtact {

const char* toString(Safety safety) noexcept {
    switch (safety) {
    case Safety::Unsafe:
        return "unsafe";
    case Safety::Safe:
        return "safe";
    case Safety::Undecided:
        return "undecided";
    }
    return "unknown";
}

namespace {

/// In voxels: the grid is 0 to `size` along each axis.
struct Line {
    Vec3 from;
    Vec3 to;
};

Vec3 between(const Vec3& from, const Vec3& to, double part) {
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[axis] = std::lerp(from[axis], to[axis], part);
    }
    return out;
}

/// Returns the part of the line in the grid, if any. Positions between distant ends would be rounded to more than a
/// voxel; counting each part from its inner end is exact for any distance of the other one.
std::optional<Line> inGrid(Line line, const Vec3& size) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const auto& [face, inward] : {std::pair{0.0, 1}, std::pair{size[axis], -1}}) {
            const double from = inward * (line.from[axis] - face);
            const double to = inward * (line.to[axis] - face);
            if (from < 0 && to < 0) {
                return std::nullopt;
            }
            if (from < 0) {
                line.from = between(line.to, line.from, to / (to - from));
                line.from[axis] = face;
            } else if (to < 0) {
                line.to = between(line.from, line.to, from / (from - to));
                line.to[axis] = face;
            }
        }
    }
    return line;
}

std::vector<std::int32_t> labelsBetween(const LabelData& labels, const Line& whole, const Vec3& size) {
    std::vector<std::int32_t> out;
    const std::optional<Line> line = inGrid(whole, size);
    if (!line) {
        return out;
    }
    // Parameters from 0 to 1 at which the line crosses from one layer of voxels to the next.
    std::vector<double> steps{0, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double begin = line->from[axis];
        const double way = line->to[axis] - begin;
        for (double face = std::ceil(std::min(begin, begin + way)); face <= std::max(begin, begin + way) && way != 0;
             ++face) {
            steps.push_back(std::clamp((face - begin) / way, 0.0, 1.0));
        }
    }
    std::sort(steps.begin(), steps.end());
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        const Vec3 middle = between(line->from, line->to, 0.5 * (steps[i] + steps[i + 1]));
        std::size_t voxel = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
            const double place = std::clamp(std::floor(middle[axis]), 0.0, size[axis] - 1);
            voxel = voxel * labels.grid.size[axis] + static_cast<std::size_t>(place);
        }
        const std::int32_t label = labels.values[labels.indices[voxel]];
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
        Line line{transformPoint(*texture, from), transformPoint(*texture, to)};
        Vec3 size{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            size[axis] = labels.grid.size[axis];
            line.from[axis] *= size[axis];
            line.to[axis] *= size[axis];
        }
        // Half of the largest number, so that differences are finite.
        constexpr double kMost = std::numeric_limits<double>::max() / 2;
        for (const Vec3& end : {line.from, line.to}) {
            if (!std::ranges::all_of(end, [](double x) { return std::abs(x) <= kMost; })) {
                return refuse("an end of the line is too far away");
            }
        }
        return labelsBetween(labels, line, size);
    });
}

} // namespace voxtact

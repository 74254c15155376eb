// SPDX-License-Identifier: MIT
#include "app/pair_window.h"

#include "voxtact/broad_phase.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace voxtact::app {

namespace {

/// Coordinates of fragments are floats, and devices interpolate them with fewer bits than that: parts of the size of
/// the box, and of the numbers that a coordinate is the sum of.
constexpr double kOfTheBox = 1.0 / 64;
constexpr double kOfTheNumbers = 1.0 / (1U << 18U);

/// Whether a box in texture space is certainly away from the volume, however its fragments are rounded.
bool isAway(const Box& box, const Mat4& texture_from_object, const Box& object) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double numbers = std::abs(texture_from_object[12 + axis]);
        for (std::size_t c = 0; c < 3; ++c) {
            numbers +=
                std::abs(texture_from_object[4 * c + axis]) * std::max(std::abs(object.lo[c]), std::abs(object.hi[c]));
        }
        const double margin = kOfTheBox * (box.hi[axis] - box.lo[axis] + 1) + kOfTheNumbers * numbers;
        if (box.lo[axis] - margin > 1 || box.hi[axis] + margin < 0) {
            return true;
        }
    }
    return false;
}

} // namespace

PairWindows::PairWindows(const DetectOptions& options, DetectInputs& inputs, std::uint32_t begin, std::uint32_t end)
    : jobs_(options.jobs), inputs_(inputs), job_(begin), end_(end),
      // Who writes the poses as we read them may want the answers as soon.
      pace_(kWindowPairs, inputs.pairs(options.jobs).has_value()) {}

Result<void> PairWindows::next(Window& window) {
    window.items.clear();
    window.pairs = 0;
    if (!failure_.ok()) {
        return failure_;
    }
    const auto begun = std::chrono::steady_clock::now();
    while (job_ < end_ && window.pairs < pace_.size() && failure_.ok()) {
        PoseSource& source = inputs_.poses[jobs_.jobs[job_].poses];
        if (!pose_) {
            if (Result<void> started = source.begin(); !started.ok()) {
                return started;
            }
            pose_ = 0;
        }
        WindowItem item;
        item.job = job_;
        item.firstPose = *pose_;
        const std::size_t wanted = pace_.size() - window.pairs;
        failure_ = source.next(wanted, item.poses);
        *pose_ += item.poses.size();
        window.pairs += item.poses.size();
        if (failure_.ok() && item.poses.size() < wanted) {
            ++job_;
            pose_.reset();
        }
        if (!item.poses.empty()) {
            window.items.push_back(std::move(item));
        }
    }
    pace_.took(static_cast<std::uint32_t>(window.pairs),
               std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count());
    return window.pairs > 0 ? Result<void>() : failure_;
}

void selectPoses(const DetectOptions& options, const DetectInputs& inputs, const Grid& grid, Window& window,
                 std::vector<std::uint64_t>& near) {
    const Result<Mat4> texture_from_world = textureFromWorld(grid);
    const bool all = options.timing || options.method.boundary == Boundary::Clamp || !texture_from_world.ok();
    for (WindowItem& item : window.items) {
        const Box& object = inputs.bounds[options.jobs.jobs[item.job].mesh];
        for (std::uint32_t pose = 0; pose < item.poses.size(); ++pose) {
            bool isNear = true;
            if (texture_from_world.ok()) {
                const Mat4 texture_from_object = multiply(*texture_from_world, item.poses[pose]);
                isNear = !isAway(transformBox(texture_from_object, object), texture_from_object, object);
            }
            near[item.job] += isNear ? 1 : 0;
            if (all || isNear) {
                item.selected.push_back(item.poses[pose]);
                item.numbers.push_back(pose);
            }
        }
    }
}

} // namespace voxtact::app

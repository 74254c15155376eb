// SPDX-License-Identifier: MIT
#include "cli/pairs/pair_window.h"

#include "core/base/infinity.h"
#include "core/base/try.h"
#include "voxtact/data.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>

namespace voxtact::app {

namespace {

/// Rounding of fragment coordinates: floats, which devices interpolate with even fewer bits. Relative to the box size
/// and to the terms of a coordinate.
constexpr double kOfTheBox = 1.0 / 64;
constexpr double kOfTheNumbers = 1.0 / (1U << 18U);

/// The volume in texture space.
constexpr Box kVolume{{0, 0, 0}, {1, 1, 1}};

/// Returns a box in texture space that holds all fragments of an object, also after rounding.
Box fragmentsOf(const Mat4& texture_from_object, const Box& object) {
    Box box = transformBox(texture_from_object, object);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double numbers = std::abs(texture_from_object[12 + axis]);
        for (std::size_t c = 0; c < 3; ++c) {
            numbers +=
                std::abs(texture_from_object[4 * c + axis]) * std::max(std::abs(object.lo[c]), std::abs(object.hi[c]));
        }
        const double margin = kOfTheBox * (box.hi[axis] - box.lo[axis] + 1) + kOfTheNumbers * numbers;
        // Overflow: unknown.
        const bool known = margin < kInfinity;
        box.lo[axis] = known ? box.lo[axis] - margin : -kInfinity;
        box.hi[axis] = known ? box.hi[axis] + margin : kInfinity;
    }
    return box;
}

/// Returns the poses near the volume.
Result<std::vector<std::uint32_t>> nearPoses(std::span<const Mat4> world_from_object, const Mat4& texture_from_world,
                                             const Box& object) {
    std::vector<Box> boxes;
    boxes.reserve(world_from_object.size());
    for (const Mat4& pose : world_from_object) {
        boxes.push_back(fragmentsOf(multiply(texture_from_world, pose), object));
    }
    const Result<std::vector<BoxPair>> pairs = overlappingPairs(boxes, {&kVolume, 1});
    VOXTACT_TRY(pairs);
    std::vector<std::uint32_t> numbers;
    numbers.reserve(pairs->size());
    std::ranges::transform(*pairs, std::back_inserter(numbers), &BoxPair::first);
    return numbers;
}

} // namespace

PairWindows::PairWindows(const PairOptions& options, PairInputs& inputs, const PairRange& range)
    : inputs_(inputs), job_(range.begin), end_(range.end), first_(range.first), left_(range.count),
      // A process that streams poses may wait for their answers.
      pace_(kWindowPairs, inputs.pairs(options.jobs).has_value()) {
    for (; first_ > 0 && job_ < end_; ++job_) {
        const std::uint64_t poses = inputs.poses->count().value_or(UINT64_MAX);
        if (first_ < poses) {
            break;
        }
        first_ -= poses;
    }
}

Result<void> PairWindows::next(Window& window) {
    window.items.clear();
    window.pairs = 0;
    if (!failure_.ok()) {
        return failure_;
    }
    const auto begun = std::chrono::steady_clock::now();
    while (job_ < end_ && left_ > 0 && window.pairs < pace_.size() && failure_.ok()) {
        PoseSource& source = *inputs_.poses;
        if (!pose_) {
            VOXTACT_TRY(source.begin(first_));
            pose_ = first_;
            first_ = 0;
        }
        WindowItem item;
        item.job = job_;
        item.firstPose = *pose_;
        const std::size_t wanted = std::min<std::uint64_t>(pace_.size() - window.pairs, left_);
        failure_ = source.next(wanted, item.poses);
        *pose_ += item.poses.size();
        window.pairs += item.poses.size();
        left_ -= item.poses.size();
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

Result<void> selectPoses(const PairOptions& options, const PairInputs& inputs, const Grid& grid, Window& window,
                         std::vector<std::uint64_t>& near) {
    const Result<Mat4> texture_from_world = textureFromWorld(grid);
    const bool all = options.timing || options.question.measures || options.touch.margin || options.touch.uncertainty ||
                     options.method.boundary == Boundary::Clamp || !texture_from_world.ok();
    for (WindowItem& item : window.items) {
        std::vector<std::uint32_t> everyPose(item.poses.size());
        std::iota(everyPose.begin(), everyPose.end(), 0U);
        Result<std::vector<std::uint32_t>> numbers = everyPose;
        if (texture_from_world.ok()) {
            numbers = nearPoses(item.poses, *texture_from_world, inputs.bounds[options.jobs.jobs[item.job].mesh]);
        }
        VOXTACT_TRY(numbers);
        near[item.job] += numbers->size();
        item.numbers = all ? std::move(everyPose) : std::move(*numbers);
        for (const std::uint32_t number : item.numbers) {
            item.selected.push_back(item.poses[number]);
        }
    }
    return {};
}

} // namespace voxtact::app

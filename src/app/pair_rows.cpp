// SPDX-License-Identifier: MIT
#include "app/pair_rows.h"

#include "voxtact/broad_phase.h"

#include <algorithm>
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

std::vector<SelectedPoses> selectPoses(const DetectOptions& options, const DetectInputs& inputs, const Grid& grid) {
    const Result<Mat4> texture_from_world = textureFromWorld(grid);
    const bool all = options.timing || options.method.boundary == Boundary::Clamp || !texture_from_world.ok();
    std::vector<SelectedPoses> selected(inputs.meshes.size());
    for (std::size_t mesh = 0; mesh < selected.size(); ++mesh) {
        const Box& object = inputs.bounds[mesh];
        for (std::uint32_t pose = 0; pose < inputs.poses.size(); ++pose) {
            if (!all) {
                const Mat4 texture_from_object = multiply(*texture_from_world, inputs.poses[pose]);
                if (isAway(transformBox(texture_from_object, object), texture_from_object, object)) {
                    continue;
                }
            }
            selected[mesh].world_from_object.push_back(inputs.poses[pose]);
            selected[mesh].numbers.push_back(pose);
        }
    }
    return selected;
}

PairRows::PairRows(const DetectOptions& options, const DetectInputs& inputs, const std::vector<SelectedPoses>& selected,
                   std::uint32_t volume, const PairAnswer& answer, DetectRun& run)
    : extra_(options.extra), selected_(selected), run_(run), firstRow_(run.rows.size()), poses_(inputs.poses.size()) {
    run.rows.resize(firstRow_ + selected.size() * poses_);
    for (std::size_t i = firstRow_; i < run.rows.size(); ++i) {
        Row& row = run.rows[i];
        row.volume = volume;
        row.timed.item = static_cast<std::uint32_t>((i - firstRow_) / poses_);
        row.timed.pose = static_cast<std::uint32_t>((i - firstRow_) % poses_);
        row.timed.answer = answer;
    }
}

void PairRows::add(const TimedAnswer& timed) {
    const std::uint32_t pose = selected_[timed.item].numbers[timed.pose];
    const std::size_t row = firstRow_ + timed.item * poses_ + pose;
    run_.rows[row].timed = timed;
    run_.rows[row].timed.pose = pose;
    batch_.push_back(static_cast<std::uint32_t>(row));
}

void PairRows::addOutputs(const BatchAnswer& answer) {
    for (TouchedTriangle touched : answer.triangles) {
        touched.pair = batch_[touched.pair];
        ++run_.rows[touched.pair].triangles;
        run_.triangles.push_back(touched);
    }
    for (Contact contact : answer.contacts) {
        contact.pair = batch_[contact.pair];
        Row& row = run_.rows[contact.pair];
        ++row.contacts;
        if (run_.contacts.size() < extra_.contactRoom()) {
            row.depth = std::max(row.depth, contact.depth);
            run_.contacts.push_back(contact);
        }
    }
    run_.contactsFound += answer.contactsFound;
    // Each survivor is a contact: a list that was cut does not say how many a pair has, its count does.
    if (answer.contactsFound > answer.contacts.size()) {
        for (const std::uint32_t row : batch_) {
            run_.rows[row].contacts = std::max(run_.rows[row].contacts, run_.rows[row].timed.answer.count);
        }
    }
    for (std::size_t pair = 0; pair < answer.bounds.size(); ++pair) {
        run_.rows[batch_[pair]].bounds = answer.bounds[pair];
    }
    for (const LabelCount& label : answer.labels) {
        run_.rows[batch_[label.pair]].labels.push_back(label);
    }
    batch_.clear();
}

} // namespace voxtact::app

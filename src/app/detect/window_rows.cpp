// SPDX-License-Identifier: MIT
#include "app/detect/window_rows.h"

#include <algorithm>
#include <span>

namespace voxtact::app {

WindowRows::WindowRows(const DetectOptions& options, const Window& window, const PairAnswer& untouched,
                       DetectOutput& output)
    : options_(options), window_(window), output_(output), rows_(window.pairs) {
    std::size_t row = 0;
    for (const WindowItem& item : window.items) {
        firstRows_.push_back(row);
        for (std::size_t pose = 0; pose < item.poses.size(); ++pose, ++row) {
            rows_[row].job = item.job;
            rows_[row].pose = item.firstPose + pose;
            rows_[row].timed.answer = untouched;
        }
    }
}

void WindowRows::add(const device::TimedAnswer& timed) {
    const std::size_t row = firstRows_[timed.item] + window_.items[timed.item].numbers[timed.pose];
    rows_[row].timed = timed;
    if (options_.yesNo()) {
        // Methods that cannot stop early have counted them all.
        PairAnswer& answer = rows_[row].timed.answer;
        answer.count = std::min<std::uint64_t>(answer.count, 1);
        answer.exactness = Exactness::LowerBound;
    }
    batch_.push_back(static_cast<std::uint32_t>(row));
}

void WindowRows::addClearance(const PairClearance& clearance) {
    rows_[batch_[clearance.pair]].clearance = clearance;
}

void WindowRows::addClearance(const LabelClearance& clearance) {
    output_.addLabelClearance(rows_[batch_[clearance.pair]], clearance);
}

void WindowRows::addArea(const PairArea& area) {
    rows_[batch_[area.pair]].area = area;
}

void WindowRows::addArea(const LabelArea& area) {
    output_.addLabelArea(rows_[batch_[area.pair]], area);
}

void WindowRows::addArea(const TriangleArea& area) {
    output_.addTriangleArea(rows_[batch_[area.pair]], area);
}

void WindowRows::endBatch(const BatchAnswer& answer) {
    keepExtra(answer, batch_, rows_, output_);
    if (answer.counters) {
        output_.addCounters(*answer.counters);
    }
    if (!batch_.empty() && !options_.timing) {
        deliver(std::size_t{batch_.back()} + 1);
    }
    batch_.clear();
}

void WindowRows::endWindow() {
    deliver(rows_.size());
}

void WindowRows::deliver(std::size_t end) {
    if (written_.ok()) {
        written_ = output_.add(std::span<const Row>(rows_).subspan(delivered_, end - delivered_));
    }
    delivered_ = end;
}

} // namespace voxtact::app

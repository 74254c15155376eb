// SPDX-License-Identifier: MIT
#include "cli/pairs/window_rows.h"

#include "cli/files/pair_files.h"

#include <algorithm>
#include <span>

namespace voxtact::app {

WindowRows::WindowRows(const PairOptions& options, const Window& window, const PairAnswer& untouched,
                       PairOutput& output)
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
    if (options_.question == Question::Touch) {
        // Methods that cannot stop early have counted them all.
        PairAnswer& answer = rows_[row].timed.answer;
        answer.count = std::min<std::uint64_t>(answer.count, 1);
        answer.exactness = Exactness::LowerBound;
    }
    batch_.push_back(static_cast<std::uint32_t>(row));
}

void WindowRows::setTime(double milliseconds) {
    for (const std::uint32_t row : batch_) {
        rows_[row].timed.wallMilliseconds = milliseconds;
    }
}

void WindowRows::addWitness(std::uint32_t pair, const WitnessPoint& witness) {
    rows_[batch_[pair]].witness = witness;
}

/// Touches at distance 0, and possible touches, for the notes and the summary.
template <class Distance> void WindowRows::keepDistance(const Distance& distance, std::int32_t label) {
    Row& row = rows_[batch_[distance.pair]];
    const Bounds bounds = roundedOutward(distance.bounds);
    row.measured.push_back({label, bounds.lower, bounds.upper});
    row.timed.answer.hit = row.timed.answer.hit || distance.bounds.upper == 0;
    row.timed.answer.possible = row.timed.answer.possible || distance.bounds.lower == 0;
    output_.countEnd(distance.end == StopReason::Rounding, distance.end == StopReason::Budget);
}

template <class Area> void WindowRows::keepArea(const Area& area, std::int32_t label) {
    Row& row = rows_[batch_[area.pair]];
    const Bounds bounds = roundedOutward(area.bounds, options_.measure.tolerance);
    row.measured.push_back({label, bounds.lower, bounds.upper});
    row.timed.answer.hit = row.timed.answer.hit || area.bounds.lower > 0;
    row.timed.answer.possible = row.timed.answer.possible || area.bounds.upper > 0;
    output_.countEnd(area.end == StopReason::Rounding, area.end == StopReason::Budget);
}

void WindowRows::addDistance(const PairDistance& distance) {
    keepDistance(distance, 0);
    if (distance.closest) {
        output_.addWitnesses(rows_[batch_[distance.pair]], *distance.closest, distance.bounds.upper);
    }
}

void WindowRows::addDistance(const LabelDistance& distance) {
    keepDistance(distance, distance.label);
}

void WindowRows::addArea(const PairArea& area) {
    keepArea(area, 0);
}

void WindowRows::addArea(const LabelArea& area) {
    keepArea(area, area.label);
}

void WindowRows::addArea(const TriangleArea& area) {
    output_.addTriangleArea(rows_[batch_[area.pair]], area);
}

/// Pairs with an opaque region inside, and possible ones.
template <class Overlap> Measured& WindowRows::keepOverlap(const Overlap& overlap) {
    Row& row = rows_[batch_[overlap.pair]];
    const Bounds bounds = roundedOutward(overlap.bounds, options_.measure.tolerance);
    output_.countEnd(overlap.end == StopReason::Rounding, overlap.end == StopReason::Budget);
    row.timed.answer.hit = row.timed.answer.hit || overlap.bounds.lower > 0;
    row.timed.answer.possible = row.timed.answer.possible || overlap.bounds.upper > 0;
    return row.measured.emplace_back(Measured{.lower = bounds.lower, .upper = bounds.upper});
}

void WindowRows::addOverlap(const PairOverlap& overlap) {
    Measured& kept = keepOverlap(overlap);
    kept.inside = overlap.inside;
    kept.solid = roundedOutward(overlap.solid, options_.measure.tolerance);
}

void WindowRows::addOverlap(const LabelOverlap& overlap) {
    Measured& kept = keepOverlap(overlap);
    kept.label = overlap.label;
    kept.inside = overlap.inside;
}

void WindowRows::addOverlap(const BandOverlap& overlap) {
    keepOverlap(overlap).band = overlap.band;
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

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
    if (options_.isTouch()) {
        // Methods without an early exit count all fragments.
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

void WindowRows::addMeasured(const AnswerTables& answer) {
    const auto table = std::make_shared<const AnswerTable>(*answer.find(options_.measure.settings.table()));
    const Column* const pair = table->column("pair");
    for (std::size_t i = 0; i < table->rows; ++i) {
        Row& row = rows_[batch_[pair == nullptr ? i : static_cast<std::size_t>(table->number(*pair, i))]];
        const Bounds bounds{table->number("lower", i), table->number("upper", i)};
        row.measured.push_back({table, i, roundedOutward(bounds, options_)});
        // A distance of 0 is a touch, and so is any other measure above 0.
        const bool isLeast = options_.question.isLeastWorst;
        PairAnswer& touch = row.timed.answer;
        touch.hit = touch.hit || (isLeast ? bounds.upper == 0 : bounds.lower > 0);
        touch.possible = touch.possible || (isLeast ? bounds.lower == 0 : bounds.upper > 0);
        const auto end = static_cast<StopReason>(table->number("end", i));
        output_.countEnd(end == StopReason::Rounding, end == StopReason::Budget);
    }
    if (!options_.measure.witness.empty()) {
        for (std::size_t i = 0; i < table->rows; ++i) {
            if (table->number("witness", i) == 1) {
                output_.addWitnesses(rows_[batch_[i]]);
            }
        }
    }
    if (!options_.measure.triangles.empty()) {
        const AnswerTable& triangles = *answer.find("triangles");
        for (std::size_t i = 0; i < triangles.rows; ++i) {
            output_.addTriangle(rows_[batch_[static_cast<std::size_t>(triangles.number("pair", i))]], triangles, i);
        }
    }
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

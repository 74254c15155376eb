// SPDX-License-Identifier: MIT
#include "cli/pairs/summary.h"

#include "cli/output/text_for_messages.h"
#include "core/base/text.h"

namespace voxtact::app {

void Summary::add(const PairOptions& options, std::span<const Row> rows) {
    for (const Row& row : rows) {
        const PairAnswer& answer = row.timed.answer;
        ++pairs_;
        yes_ += answer.hit ? 1 : 0;
        undecided_ += answer.possible && !answer.hit ? 1 : 0;
        if (options.isCount() && answer.count > (worst_ ? worst_->timed.answer.count : 0)) {
            worst_ = row;
        }
        for (const Measured& measured : row.measured) {
            addMeasured(options, row, measured);
        }
    }
}

void Summary::addMeasured(const PairOptions& options, const Row& row, const Measured& measured) {
    const Bounds& bounds = measured.bounds;
    const bool worse =
        options.question.isLeastWorst
            ? bounds.lower < extreme_.lower || (bounds.lower == extreme_.lower && bounds.upper < extreme_.upper)
            : bounds.upper > extreme_.upper;
    if (!worst_ || worse) {
        worst_ = row;
        extreme_ = bounds;
    }
}

std::string Summary::text(const PairOptions& options) const {
    std::string out = std::to_string(pairs_) + (pairs_ == 1 ? " pair" : " pairs");
    if (!options.question.measures) {
        out += ": " + std::to_string(yes_) + " touch, " + std::to_string(pairs_ - yes_ - undecided_) + " do not, " +
               std::to_string(undecided_) + " undecided";
    }
    if (!worst_) {
        return out;
    }
    const Job& job = options.jobs.jobs[worst_->job];
    if (options.isCount()) {
        out += "; maximum count " + std::to_string(worst_->timed.answer.count);
    } else {
        out += (options.question.isLeastWorst ? "; minimum " : "; maximum ") + std::string(options.question.name) +
               " " + number(extreme_.lower) + " to " + number(extreme_.upper) + " " +
               worst_->measured.front().table->column("lower")->unit;
    }
    return out + " at pose " + std::to_string(worst_->pose) + " of " + fileNameOf(options.jobs.meshes[job.mesh]) +
           " against " + fileNameOf(options.jobs.volumes[job.volume]);
}

} // namespace voxtact::app

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
        if (options.question == Question::Count && answer.count > (worst_ ? worst_->timed.answer.count : 0)) {
            worst_ = row;
        }
        for (const Measured& measured : row.measured) {
            addMeasured(options, row, measured);
        }
    }
}

void Summary::addMeasured(const PairOptions& options, const Row& row, const Measured& measured) {
    const bool worse =
        options.question == Question::Distance
            ? measured.lower < extreme_.lower || (measured.lower == extreme_.lower && measured.upper < extreme_.upper)
            : measured.upper > extreme_.upper;
    if (!worst_ || worse) {
        worst_ = row;
        extreme_ = measured;
    }
}

std::string Summary::text(const PairOptions& options) const {
    std::string out = std::to_string(pairs_) + (pairs_ == 1 ? " pair" : " pairs");
    if (!options.measures()) {
        out += ": " + std::to_string(yes_) + " touch, " + std::to_string(pairs_ - yes_ - undecided_) + " do not, " +
               std::to_string(undecided_) + " undecided";
    }
    if (!worst_) {
        return out;
    }
    const Job& job = options.jobs.jobs[worst_->job];
    if (options.question == Question::Count) {
        out += "; maximum count " + std::to_string(worst_->timed.answer.count);
    } else {
        const bool isArea = options.question == Question::Area;
        const bool isDistance = options.question == Question::Distance;
        out += std::string(isDistance ? "; minimum distance "
                           : isArea   ? "; maximum area "
                                      : "; maximum overlap ") +
               number(extreme_.lower) + " to " + number(extreme_.upper) +
               (isDistance ? " mm"
                : isArea   ? " mm^2"
                           : " mm^3");
    }
    return out + " at pose " + std::to_string(worst_->pose) + " of " + fileNameOf(options.jobs.meshes[job.mesh]) +
           " against " + fileNameOf(options.jobs.volumes[job.volume]);
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "lab/bench/parts.h"
#include "lab/measure/numbers.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

/// By a method that knows whether there are survivors and not how many.
bool countsNothing(const PairAnswer& answer) {
    return rowOf(answer.method).exactness == Exactness::LowerBound;
}

/// Whether a rasteriser's answer can be the host's but for roundings at pixels' centres and between table entries.
bool isNear(const PairAnswer& answer, const PairAnswer& host) {
    const bool any = countsNothing(answer);
    const std::uint64_t counted = any ? (answer.hit ? 1 : 0) : answer.count;
    return explainedByRounding(counted, host.count, any) && answer.hit == (counted > 0);
}

/// Whether an answer in the view is not the host's.
bool differs(const PairAnswer& answer, const PairAnswer& host) {
    return answer.exactness == Exactness::LowerBound ? answer.hit != host.hit : answer.count != host.count;
}

} // namespace

std::string judgePose(const EngineFacts& engine, const PairAnswer& answer, PoseTruth& truth) {
    const bool raster = rowOf(answer.method).coverage == Coverage::Rasteriser;
    const bool any = countsNothing(answer);
    const auto says = [any](const PairAnswer& one, std::uint64_t counted) {
        return one.possible ? std::string("possible") : any ? one.hit ? "a hit" : "no hit" : std::to_string(counted);
    };
    const std::string said =
        engine.name + " " + engine.projection + " " + engine.question + " says " + says(answer, answer.count);
    if (raster && !any && !truth.raster) {
        truth.raster = answer;
    }
    if (raster && !isNear(answer, truth.view)) {
        return said + " where cpu counts " + std::to_string(truth.view.count) +
               ": more than what roundings of a rasteriser explain";
    }
    const PairAnswer& must = engine.certified ? truth.certified : raster ? truth.raster.value_or(answer) : truth.view;
    const bool yesNo = engine.question == questionOf(true, {});
    const std::uint64_t count = yesNo ? (must.hit ? 1 : 0) : must.count;
    const bool right = answer.hit == must.hit && answer.possible == must.possible && (any || answer.count == count);
    return right ? std::string() : said + ", it must be " + says(must, count);
}

Result<void> KnownPoses::learn(std::size_t end) {
    const std::size_t begin = truths_.size();
    if (begin >= end) {
        return {};
    }
    const Work work = at(begin, end - begin);
    const Result<Pass> certified = certified_.run(work, {});
    VOXTACT_TRY(certified);
    const Result<Pass> view = view_.run(work, {});
    VOXTACT_TRY(view);
    learning_ = certified->wallMilliseconds + view->wallMilliseconds;
    for (std::size_t i = 0; i < work.poses.size(); ++i) {
        truths_.push_back({certified->pairs[i], view->pairs[i]});
    }
    return {};
}

Result<double> KnownPoses::take(const Engine& engine, std::size_t first, bool kept, BenchRow& row) {
    const Result<Pass> pass = engine.run(at(first, row.pairs), {});
    VOXTACT_TRY(pass);
    for (std::size_t i = 0; i < pass->pairs.size(); ++i) {
        const PairAnswer& answer = pass->pairs[i];
        PoseTruth& truth = truths_[first + i];
        const std::string wrong = judgePose(row.engine, answer, truth);
        row.touching += kept && answer.hit ? 1 : 0;
        row.rounding += kept && !row.engine.certified && differs(answer, truth.view) ? 1 : 0;
        if (!wrong.empty()) {
            const std::string number = std::to_string(first + i);
            run_.result.disagreement =
                row.mesh +
                (run_.settings.mode == BenchMode::Latency ? ", tick " + number
                                                          : ", pose " + number + " of " + std::to_string(row.pairs)) +
                ": " + wrong;
            break;
        }
    }
    if (kept) {
        row.wall.push_back(pass->wallMilliseconds);
        keep(pass->gpuMilliseconds, row.gpu);
        keep(pass->recordMilliseconds, row.recording);
    }
    return pass->wallMilliseconds;
}

} // namespace voxtact::lab

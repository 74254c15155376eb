// SPDX-License-Identifier: MIT
#include "lab/paper/frames.h"
#include "lab/paper/parts.h"

#include "core/base/try.h"
#include "lab/measure/numbers.h"
#include "lab/measure/rounds.h"
#include "lab/measure/stopwatch.h"
#include "voxtact/looks.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace voxtact::lab {

namespace {

/// What is timed of each method.
constexpr std::array<FramePart, 2> kFrameParts{FramePart::Detection, FramePart::Both};

/// A scene on the device and the host, with what was verified of it.
struct PaperWork {
    const PaperInput& input;
    std::vector<NamedCounts> counts;     ///< by method
    std::vector<CountingMethod> methods; ///< theirs
    std::size_t firstRow;                ///< theirs follow each other
};

/// Counts every pose by every method. The first broken rule is the result's.
Result<std::vector<NamedCounts>> verify(const PaperRun& run, const PaperInput& input) {
    CompareResult compared;
    const CompareSettings settings;
    const Result<Engines> engines = makeMethodEngines(run.session, settings, compared);
    VOXTACT_TRY(engines);
    if (run.result.methods.empty()) {
        run.result.methods = compared.methods;
        VOXTACT_TRY(addTrust(run.session, run.result.methods, run.result.notes));
    }
    VOXTACT_TRY(checkCounts({run.session, settings, input.scene, *engines, compared, run.steps.step}));
    for (const std::string& note : compared.notes) {
        run.note(note);
    }
    if (const Verdict* const failure = compared.firstFailure(); failure != nullptr) {
        run.disagree(input.facts.name + ", " + failure->rule + ": pose " + std::to_string(failure->first->pose) + ": " +
                     failure->first->text);
    }
    return std::move(compared.counts);
}

PaperWork addRows(const PaperInput& input, std::vector<NamedCounts> counts, PaperResult& result) {
    PaperWork work{input, std::move(counts), {}, result.rows.size()};
    for (const NamedCounts& by : work.counts) {
        work.methods.push_back(*countingMethodFromName(by.method));
        const auto sum = static_cast<double>(std::accumulate(by.counts.begin(), by.counts.end(), 0ULL));
        const auto hits = std::ranges::count_if(by.counts, [](std::uint64_t count) { return count > 0; });
        result.rows.push_back({.scene = result.scenes.size(),
                               .method = by.method,
                               .survivors = sum / static_cast<double>(by.counts.size()),
                               .hits = static_cast<std::uint32_t>(hits)});
    }
    result.scenes.push_back(input.facts);
    return work;
}

void keepFrame(FramePart part, const FrameSample& sample, PaperRow& row) {
    // In the order of FramePart.
    constexpr std::array kColumns{&PaperColumns::rendering, &PaperColumns::collision, &PaperColumns::total};
    const auto column = kColumns.at(static_cast<std::size_t>(part));
    keep(sample.gpu, row.gpu.*column);
    (row.wall.*column).push_back(sample.wall);
    if (part == FramePart::Rendering) {
        keep(sample.mesh, row.gpu.mesh);
        keep(sample.volume, row.gpu.volume);
    }
}

/// Frames of a scene, of which each round has another pose.
struct PaperFrames {
    FrameLoop loop;
    const PaperWork& work;
    const PaperRun& run;

    [[nodiscard]] std::size_t poseOf(std::uint64_t round) const {
        const std::size_t poses = work.input.scene.poses.size();
        return (round + poses - 1) % poses;
    }
    Result<double> render(const Turn& turn);
    Result<double> detect(std::size_t method, const Turn& turn);
};

/// A frame without detection. It is the same by every method, so that a round takes one for all of them.
Result<double> PaperFrames::render(const Turn& turn) {
    const Result<FrameSample> sample =
        loop.run(FramePart::Rendering, work.methods.front(), work.input.scene.poses[poseOf(turn.round)]);
    VOXTACT_TRY(sample);
    for (std::size_t method = 0; turn.round > 0 && method < work.methods.size(); ++method) {
        keepFrame(FramePart::Rendering, *sample, run.result.rows[work.firstRow + method]);
    }
    return sample->wall;
}

/// The two frames of a method. A count that is not the verified one is the result's disagreement.
Result<double> PaperFrames::detect(std::size_t method, const Turn& turn) {
    const std::size_t pose = poseOf(turn.round);
    const std::uint64_t verified = work.counts[method].counts[pose];
    double wall = 0;
    for (std::size_t i = 0; i < kFrameParts.size(); ++i) {
        const FramePart part = kFrameParts.at(turn.backwards ? kFrameParts.size() - 1 - i : i);
        const Result<FrameSample> sample = loop.run(part, work.methods[method], work.input.scene.poses[pose]);
        VOXTACT_TRY(sample);
        if (sample->count.value_or(verified) != verified) {
            run.disagree(work.input.facts.name + ", pose " + std::to_string(pose) + ": " + work.counts[method].method +
                         (part == FramePart::Both ? " in a frame" : " alone") + " counts " +
                         std::to_string(*sample->count) + ", before it was " + std::to_string(verified));
        }
        if (turn.round > 0) {
            keepFrame(part, *sample, run.result.rows[work.firstRow + method]);
        }
        wall += sample->wall;
    }
    return wall;
}

/// Every method in turn, and in their middle the frame that they are held against.
Result<void> timeFrames(const PaperRun& run, double seconds, const PaperWork& work) {
    const Stopwatch watch;
    Result<FrameLoop> loop = FrameLoop::create(run.session, work.input.scene, plainColours());
    VOXTACT_TRY(loop);
    PaperFrames frames{std::move(*loop), work, run};
    std::vector<Timed> things;
    for (std::size_t method = 0; method < work.methods.size(); ++method) {
        VOXTACT_TRY(frames.loop.add(work.methods[method]));
        if (method == work.methods.size() / 2) {
            things.push_back({.take = [&frames](const Turn& turn) { return frames.render(turn); }});
        }
        things.push_back({.take = [&frames, method](const Turn& turn) { return frames.detect(method, turn); }});
    }
    const Result<std::uint64_t> taken = takeRounds(things, {.repeats = run.settings.repetitions,
                                                            .warmUp = true,
                                                            .limit = seconds * 1000 - watch.milliseconds(),
                                                            .cycle = work.input.scene.poses.size(),
                                                            .step = run.steps.step,
                                                            .stop = [&run] { return !run.agrees(); }});
    VOXTACT_TRY(taken);
    if (*taken < run.settings.repetitions && run.agrees()) {
        run.note(work.input.facts.name + ": " + std::to_string(*taken) + " of " +
                 std::to_string(run.settings.repetitions) + " repetitions fit in --time-limit");
    }
    return {};
}

} // namespace

Result<void> measurePaperScene(const PaperRun& run, double seconds, const PaperInput& input) {
    VOXTACT_TRY(makeReady(run.session, input.scene, {.bricks = true}));
    Result<std::vector<NamedCounts>> counts = verify(run, input);
    VOXTACT_TRY(counts);
    return timeFrames(run, seconds, addRows(input, std::move(*counts), run.result));
}

std::uint64_t paperSceneSteps(const PaperSettings& settings) {
    return std::uint64_t{2} + settings.repetitions;
}

} // namespace voxtact::lab

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
    std::vector<CountingMethod> methods{};
    std::vector<NamedCounts> counts{}; ///< by method, in their order
    std::size_t firstRow = 0;          ///< theirs follow each other
};

void addNote(std::string note, PaperResult& result) {
    if (std::ranges::find(result.notes, note) == result.notes.end()) {
        result.notes.push_back(std::move(note));
    }
}

/// Counts every pose by every method. The first broken rule is the result's.
Result<void> verify(const device::Session& session, PaperWork& work, PaperResult& result) {
    EngineList list;
    for (const CountingMethod method : work.methods) {
        list.add(makeMethodEngine(session, method));
    }
    const Result<Engines> engines = list.take();
    VOXTACT_TRY(engines);
    const Scene& scene = work.input.scene;
    Result<std::vector<NamedCounts>> counts = countAll(*engines, Work(scene));
    VOXTACT_TRY(counts);
    work.counts = std::move(*counts);
    for (const Verdict& verdict : judgeCounts(work.counts, scene.poseNumbers)) {
        if (verdict.failed() && result.disagreement.empty()) {
            result.disagreement = work.input.facts.name + ", " + verdict.rule + ": pose " +
                                  std::to_string(verdict.first->pose) + ": " + verdict.first->text;
        }
    }
    return {};
}

void addRows(PaperWork& work, PaperResult& result) {
    work.firstRow = result.rows.size();
    for (const NamedCounts& counts : work.counts) {
        const auto sum = static_cast<double>(std::accumulate(counts.counts.begin(), counts.counts.end(), 0ULL));
        const auto hits = std::ranges::count_if(counts.counts, [](std::uint64_t count) { return count > 0; });
        result.rows.push_back({.scene = result.scenes.size(),
                               .method = counts.method,
                               .survivors = sum / static_cast<double>(counts.counts.size()),
                               .hits = static_cast<std::uint32_t>(hits)});
    }
    result.scenes.push_back(work.input.facts);
}

void keepFrame(FramePart part, const FrameSample& sample, PaperRow& row) {
    switch (part) {
    case FramePart::Rendering:
        keep(sample.mesh, row.gpu.mesh);
        keep(sample.volume, row.gpu.volume);
        keep(sample.all, row.gpu.rendering);
        row.wall.rendering.push_back(sample.wall);
        return;
    case FramePart::Detection:
        keep(sample.detection, row.gpu.collision);
        row.wall.collision.push_back(sample.wall);
        return;
    case FramePart::Both:
        keep(sample.all, row.gpu.total);
        row.wall.total.push_back(sample.wall);
        return;
    }
}

/// Frames of a scene, of which each round has another pose.
struct PaperFrames {
    FrameLoop loop;
    const PaperWork& work;
    PaperResult& result;

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
        keepFrame(FramePart::Rendering, *sample, result.rows[work.firstRow + method]);
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
        if (sample->count.value_or(verified) != verified && result.disagreement.empty()) {
            result.disagreement = work.input.facts.name + ", pose " + std::to_string(pose) + ": " +
                                  work.counts[method].method + (part == FramePart::Both ? " in a frame" : " alone") +
                                  " counts " + std::to_string(*sample->count) + ", before it was " +
                                  std::to_string(verified);
        }
        if (turn.round > 0) {
            keepFrame(part, *sample, result.rows[work.firstRow + method]);
        }
        wall += sample->wall;
    }
    return wall;
}

/// Every method in turn, and in their middle the frame that they are held against.
Result<void> timeFrames(const device::Session& session, const PaperSettings& settings, double seconds,
                        const PaperWork& work, PaperResult& result, const std::function<void()>& step) {
    const Stopwatch watch;
    Result<FrameLoop> loop = FrameLoop::create(session, work.input.scene, plainColours());
    VOXTACT_TRY(loop);
    PaperFrames frames{std::move(*loop), work, result};
    std::vector<Timed> things;
    for (std::size_t method = 0; method < work.methods.size(); ++method) {
        VOXTACT_TRY(frames.loop.add(work.methods[method]));
        if (method == work.methods.size() / 2) {
            things.push_back({.take = [&frames](const Turn& turn) { return frames.render(turn); }});
        }
        things.push_back({.take = [&frames, method](const Turn& turn) { return frames.detect(method, turn); }});
    }
    const auto disagree = [&result] { return !result.disagreement.empty(); };
    const Result<std::uint64_t> taken = takeRounds(things, {.repeats = settings.repetitions,
                                                            .warmUp = true,
                                                            .limit = seconds * 1000 - watch.milliseconds(),
                                                            .cycle = work.input.scene.poses.size(),
                                                            .step = step,
                                                            .stop = disagree});
    VOXTACT_TRY(taken);
    if (*taken < settings.repetitions && !disagree()) {
        addNote(work.input.facts.name + ": " + std::to_string(*taken) + " of " + std::to_string(settings.repetitions) +
                    " repetitions fit in --time-limit",
                result);
    }
    return {};
}

} // namespace

Result<void> measurePaperScene(const device::Session& session, const PaperSettings& settings, double seconds,
                               const PaperInput& input, PaperResult& result, const std::function<void()>& step) {
    VOXTACT_TRY(makeReady(session, {.bricks = true}, *input.scene.volume));
    VOXTACT_TRY(makeReady(&session, *input.scene.mesh));
    PaperWork work{.input = input};
    for (const CountingMethod method : countingMethods()) {
        if (const std::string why = whyNot(session, method); why.empty()) {
            work.methods.push_back(method);
        } else {
            addNote(std::string("no ") + toString(method) + " on this device: " + why, result);
        }
    }
    VOXTACT_TRY(verify(session, work, result));
    step();
    addRows(work, result);
    return timeFrames(session, settings, seconds, work, result, step);
}

std::uint64_t paperSceneSteps(const PaperSettings& settings) {
    return std::uint64_t{2} + settings.repetitions;
}

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "lab/paper/paper_tables.h"

#include "core/try.h"
#include "lab/compare/compare_verify.h"
#include "lab/measure/stopwatch.h"
#include "lab/paper/paper_frames.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace voxtact::lab {

namespace {

/// What is timed of each method.
constexpr std::array<FramePart, 2> kParts{FramePart::Detection, FramePart::Both};

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
Result<void> verify(const Session& session, PaperWork& work, PaperResult& result) {
    Engines engines;
    for (const CountingMethod method : work.methods) {
        MadeEngine engine = makeMethodEngine(session, method);
        VOXTACT_TRY(engine);
        engines.push_back(std::move(*engine));
    }
    const Scene& scene = work.input.scene;
    Result<std::vector<NamedCounts>> counts = countAll(engines, Work(scene));
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

void add(const std::optional<double>& time, std::vector<double>& samples) {
    if (time) {
        samples.push_back(*time);
    }
}

void keep(FramePart part, const FrameSample& sample, PaperRow& row) {
    switch (part) {
    case FramePart::Rendering:
        add(sample.mesh, row.gpu.mesh);
        add(sample.volume, row.gpu.volume);
        add(sample.all, row.gpu.rendering);
        row.wall.rendering.push_back(sample.wall);
        return;
    case FramePart::Detection:
        add(sample.detection, row.gpu.collision);
        row.wall.collision.push_back(sample.wall);
        return;
    case FramePart::Both:
        add(sample.all, row.gpu.total);
        row.wall.total.push_back(sample.wall);
        return;
    }
}

/// The two frames of a method at a pose. A count that is not the verified one is the result's disagreement.
Result<void> takeFrames(FrameLoop& frames, const PaperWork& work, std::size_t method, std::size_t pose, bool backwards,
                        PaperRow* row, PaperResult& result) {
    const std::uint64_t verified = work.counts[method].counts[pose];
    for (std::size_t i = 0; i < kParts.size(); ++i) {
        const FramePart part = kParts.at(backwards ? kParts.size() - 1 - i : i);
        const Result<FrameSample> sample = frames.run(part, work.methods[method], work.input.scene.poses[pose]);
        VOXTACT_TRY(sample);
        if (sample->count.value_or(verified) != verified && result.disagreement.empty()) {
            result.disagreement = work.input.facts.name + ", pose " + std::to_string(pose) + ": " +
                                  work.counts[method].method + (part == FramePart::Both ? " in a frame" : " alone") +
                                  " counts " + std::to_string(*sample->count) + ", before it was " +
                                  std::to_string(verified);
        }
        if (row != nullptr) {
            keep(part, *sample, *row);
        }
    }
    return {};
}

/// A frame without detection. It is the same by every method, so that a round takes one for all of them.
Result<void> takeRendering(FrameLoop& frames, const PaperWork& work, std::size_t pose, bool kept, PaperResult& result) {
    const Result<FrameSample> sample =
        frames.run(FramePart::Rendering, work.methods.front(), work.input.scene.poses[pose]);
    VOXTACT_TRY(sample);
    for (std::size_t method = 0; kept && method < work.methods.size(); ++method) {
        keep(FramePart::Rendering, *sample, result.rows[work.firstRow + method]);
    }
    return {};
}

/// Every method in turn, and in their middle the frame that they are held against. `round` counts from 1; in round 0 no
/// time is kept.
Result<void> takeRound(FrameLoop& frames, const PaperWork& work, std::uint64_t round, PaperResult& result) {
    const std::size_t poses = work.input.scene.poses.size();
    const std::size_t pose = (round + poses - 1) % poses;
    // A pose that comes again, after an even number of rounds too, is taken the other way round.
    const bool backwards = (round + (round + poses - 1) / poses) % 2 == 0;
    for (std::size_t i = 0; i < work.methods.size() && result.disagreement.empty(); ++i) {
        if (i == work.methods.size() / 2) {
            VOXTACT_TRY(takeRendering(frames, work, pose, round > 0, result));
        }
        const std::size_t method = backwards ? work.methods.size() - 1 - i : i;
        PaperRow* row = round == 0 ? nullptr : &result.rows[work.firstRow + method];
        VOXTACT_TRY(takeFrames(frames, work, method, pose, backwards, row, result));
    }
    return {};
}

Result<void> timeFrames(const Session& session, const PaperSettings& settings, double seconds, const PaperWork& work,
                        PaperResult& result, const std::function<void()>& step) {
    const Stopwatch watch;
    Result<FrameLoop> frames = FrameLoop::create(session, work.input.scene, settings.colours);
    VOXTACT_TRY(frames);
    for (const CountingMethod method : work.methods) {
        VOXTACT_TRY(frames->add(method));
    }
    std::uint64_t taken = 0;
    for (std::uint64_t round = 0; round <= settings.repetitions && result.disagreement.empty(); ++round) {
        const double next = round == 0 ? 0 : watch.milliseconds() / static_cast<double>(round);
        if (round <= 1 || watch.milliseconds() + next <= seconds * 1000) {
            VOXTACT_TRY(takeRound(*frames, work, round, result));
            taken = round;
        }
        step();
    }
    if (taken < settings.repetitions && result.disagreement.empty()) {
        addNote(work.input.facts.name + ": " + std::to_string(taken) + " of " + std::to_string(settings.repetitions) +
                    " repetitions fit in --time-limit",
                result);
    }
    return {};
}

} // namespace

Result<void> measurePaperScene(const Session& session, const PaperSettings& settings, double seconds,
                               const PaperInput& input, PaperResult& result, const std::function<void()>& step) {
    VOXTACT_TRY(makeReady(session, {.bricks = true}, *input.scene.volume));
    VOXTACT_TRY(makeReady(&session, *input.scene.mesh));
    PaperWork work{.input = input};
    work.methods = availableMethods(session, [&](CountingMethod method, const std::string& reason) {
        addNote(std::string("no ") + toString(method) + " on this device: " + reason, result);
    });
    VOXTACT_TRY(verify(session, work, result));
    step();
    addRows(work, result);
    return timeFrames(session, settings, seconds, work, result, step);
}

std::uint64_t paperSceneSteps(const PaperSettings& settings) {
    return std::uint64_t{2} + settings.repetitions;
}

} // namespace voxtact::lab

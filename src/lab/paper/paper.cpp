// SPDX-License-Identifier: MIT
#include "lab/paper/parts.h"

#include "core/base/try.h"
#include "lab/measure/numbers.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

/// Of the time, with sweeps.
constexpr double kFramesShare = 0.65;

void addNotes(const PaperSettings& settings, PaperResult& result) {
    result.notes.emplace_back(
        "recording is in none of the times; collision: the detection of one pair, alone; "
        "overhead: of a frame with the detection in it against one without, round by round; a round "
        "has one frame without it for all methods");
    result.notes.emplace_back("mesh and volume are times of the GPU only; cpu detects while the picture is made, which "
                              "the wall clock alone tells");
    // More samples never have less of an interval, and there may be more than the memory holds at once.
    constexpr std::uint32_t kEnough = 100;
    if (!medianInterval(std::vector<double>(std::min(settings.repetitions, kEnough)), kConfidence)) {
        result.notes.emplace_back("the overhead has no interval: its median is known with a confidence of 95 % from 6 "
                                  "--repetitions on");
    }
    if (settings.scale > 1) {
        result.notes.emplace_back("--scale " + std::to_string(settings.scale) +
                                  ": the volumes are smaller than the paper's, and the times are not to be compared");
    }
}

/// Of each two samples of one round.
template <class Percent>
std::vector<double> paired(const std::vector<double>& rendering, const std::vector<double>& other, Percent percent) {
    std::vector<double> out;
    if (rendering.size() != other.size()) {
        return out;
    }
    for (std::size_t i = 0; i < other.size(); ++i) {
        // A clock may be so coarse, or stand still, that a small picture takes no time.
        if (rendering[i] > 0) {
            out.push_back(percent(rendering[i], other[i]));
        }
    }
    return out;
}

} // namespace

void PaperRun::note(const std::string& text) const {
    if (std::ranges::find(result.notes, text) == result.notes.end()) {
        result.notes.push_back(text);
    }
}

std::vector<double> collisionPercent(const PaperColumns& columns) {
    return paired(columns.rendering, columns.collision,
                  [](double rendering, double collision) { return 100 * collision / rendering; });
}

std::vector<double> overheadPercent(const PaperColumns& columns) {
    return paired(columns.rendering, columns.total,
                  [](double rendering, double total) { return 100 * (total - rendering) / rendering; });
}

Result<void> measurePaper(const PaperSettings& settings, const device::Session& session, const Steps& steps,
                          PaperResult& result) {
    VOXTACT_TRY(checkViewport(session, settings.size));
    const Result<std::vector<PaperInput>> inputs = loadPaperScenes(settings);
    VOXTACT_TRY(inputs);
    result.machine = describeMachine(session, inputs->front().scene.volume->data.type, result.machine.provenance);
    result.width = settings.size.width;
    result.height = settings.size.height;
    addNotes(settings, result);
    const auto scenes = static_cast<double>(inputs->size());
    const double frames = settings.noSweeps ? 1 : kFramesShare;
    steps.begin(inputs->size() * paperSceneSteps(settings) + (settings.noSweeps ? 0 : paperSweepSteps(settings)));
    const PaperRun run{session, settings, steps, result};
    for (const PaperInput& input : *inputs) {
        steps.doing("frames of " + input.facts.name);
        Result<void> measured = measurePaperScene(run, settings.timeLimit * frames / scenes, input);
        if (!measured.ok() || !run.agrees()) {
            return measured;
        }
    }
    if (!settings.noSweeps) {
        VOXTACT_TRY(runPaperSweeps(run, settings.timeLimit * (1 - kFramesShare), inputs->front().scene));
    }
    noteMissedTimes(session, result.notes);
    return {};
}

} // namespace voxtact::lab

// SPDX-License-Identifier: MIT
#include "lab/paper/parts.h"

#include "core/base/try.h"
#include "device/timed_submission.h"
#include "lab/measure/numbers.h"
#include "lab/measure/rounds.h"
#include "voxtact/render.h"

#include <array>

namespace voxtact::lab {

namespace {

constexpr std::array<std::uint32_t, 5> kEntries{64, 128, 256, 512, 1024};
constexpr ValueRange kDomain{0, 255};

/// Two functions with colours that take turns.
constexpr std::array<std::array<ControlPoint, 3>, 2> kOpacities{
    {{{{40, 0}, {80, 0.6}, {255, 1}}}, {{{60, 0}, {120, 0.3}, {255, 0.9}}}}};
constexpr std::array<std::array<ColourPoint, 3>, 2> kColours{
    {{{{0, {0.3, 0.1, 0.1}}, {120, {0.9, 0.6, 0.5}}, {255, {1, 1, 0.95}}}},
     {{{0, {0.1, 0.1, 0.3}}, {140, {0.5, 0.6, 0.9}}, {255, {0.95, 1, 1}}}}}};

RenderTransferFunctionDesc functionOf(std::uint32_t entries, std::size_t number) {
    return {.opacity = {kOpacities.at(number), kDomain, entries}, .colours = kColours.at(number)};
}

} // namespace

Result<std::vector<IntegrationPoint>> timeIntegration(const PaperRun& run) {
    const Result<Renderer> renderer = Renderer::create(run.session.context);
    VOXTACT_TRY(renderer);
    std::vector<RenderTransferFunction> tables;
    std::vector<IntegrationPoint> points;
    for (const std::uint32_t entries : kEntries) {
        Result<RenderTransferFunction> made = RenderTransferFunction::create(*renderer, functionOf(entries, 0));
        VOXTACT_TRY(made);
        tables.push_back(std::move(*made));
        points.push_back({.entries = entries});
    }
    Result<device::TimedSubmission> submission = device::TimedSubmission::create(run.session);
    VOXTACT_TRY(submission);
    std::vector<Timed> things;
    for (std::size_t i = 0; i < points.size(); ++i) {
        things.push_back({.take = [&, i](const Turn& turn) -> Result<double> {
            const auto times = submission->run([&](VkCommandBuffer commands) {
                return tables[i].cmdUpdate(commands,
                                           functionOf(kEntries.at(i), turn.round % 2)); // one that has changed
            });
            VOXTACT_TRY(times);
            if (turn.round > 0) {
                points[i].wall.push_back(times->wallMilliseconds);
                keep(times->gpuMilliseconds, points[i].gpu);
            }
            return times->wallMilliseconds;
        }});
    }
    VOXTACT_TRY(takeRounds(things, {.repeats = run.settings.repetitions, .warmUp = true, .step = run.steps.step}));
    return points;
}

} // namespace voxtact::lab

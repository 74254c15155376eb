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

/// One size of the table.
struct SizedTable {
    RenderTransferFunction function;
    IntegrationPoint point;
};

Result<std::vector<SizedTable>> makeTables(const Renderer& renderer) {
    std::vector<SizedTable> tables;
    for (const std::uint32_t entries : kEntries) {
        Result<RenderTransferFunction> made = RenderTransferFunction::create(renderer, functionOf(entries, 0));
        VOXTACT_TRY(made);
        tables.push_back({std::move(*made), {.entries = entries}});
    }
    return tables;
}

/// Of a function that has changed.
Result<double> makeTable(device::TimedSubmission& submission, std::uint64_t round, SizedTable& table) {
    const Result<device::TimedSubmission::Times> times = submission.run([&](VkCommandBuffer commands) {
        return table.function.cmdUpdate(commands, functionOf(table.point.entries, round % 2));
    });
    VOXTACT_TRY(times);
    if (round > 0) {
        table.point.wall.push_back(times->wallMilliseconds);
        keep(times->gpuMilliseconds, table.point.gpu);
    }
    return times->wallMilliseconds;
}

} // namespace

Result<std::vector<IntegrationPoint>> timeIntegration(const device::Session& session, std::uint32_t repetitions,
                                                      const std::function<void()>& step) {
    const Result<Renderer> renderer = Renderer::create(session.context);
    VOXTACT_TRY(renderer);
    Result<std::vector<SizedTable>> tables = makeTables(*renderer);
    VOXTACT_TRY(tables);
    Result<device::TimedSubmission> submission = device::TimedSubmission::create(session);
    VOXTACT_TRY(submission);
    std::vector<Timed> things;
    for (SizedTable& table : *tables) {
        things.push_back({.take = [&](const Turn& turn) { return makeTable(*submission, turn.round, table); }});
    }
    VOXTACT_TRY(takeRounds(things, {.repeats = repetitions, .warmUp = true, .step = step}));
    std::vector<IntegrationPoint> points;
    for (SizedTable& table : *tables) {
        points.push_back(std::move(table.point));
    }
    return points;
}

} // namespace voxtact::lab

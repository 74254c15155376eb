// SPDX-License-Identifier: MIT
#include "bench/compare/localize.h"
#include "bench/program/compare_inputs.h"
#include "bench/program/lab_run.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

using namespace lab;

namespace {

constexpr std::uint32_t kDefaultPoses = 8;
constexpr std::uint32_t kDefaultRepeats = 3;

CompareOptions withDefaults(const CompareOptions& given, const CLI::App& parser) {
    CompareOptions options = given;
    if (parser.get_option("--number")->empty()) {
        options.number = kDefaultPoses;
    }
    if (parser.get_option("--repetitions")->empty()) {
        options.settings.repeats = kDefaultRepeats;
    }
    return options;
}

Outcome outcomeOf(const LocalizeResult& result, const CLI::App& parser) {
    if (!result.verdict.failed()) {
        return {};
    }
    return {kExitVerify, disagreementOf(result.verdict) + "; reproduce with: " +
                             commandLine(parser, {"--output", "--format", "--only-pose", "--progress"}) +
                             " --only-pose " + std::to_string(result.verdict.first->pose)};
}

} // namespace

Outcome runLocalize(const CompareOptions& given, const CLI::App& parser) {
    const CompareOptions options = withDefaults(given, parser);
    if (const Result<void> writable =
            checkOutputs({{"--output", options.output.path}},
                         inputPaths(options.volumes, options.meshes, options.transferFunction, options.view));
        !writable.ok()) {
        return writable.error();
    }
    const Result<lab::Scene> scene = readScene(options);
    VOXTACT_TRY(scene);
    LocalizeResult result;
    const auto measure = [&](const device::Session& session) {
        const DeviceStay stay(*scene);
        result.machine = describeMachine(session, scene->volume->data.type, provenanceOf(parser));
        ShownSteps shown(options.progress, "voxtact compare");
        const Steps steps = shown.steps();
        steps.begin(std::uint64_t{options.settings.repeats} * scene->poses.size());
        return localize(session, options.settings, *scene, result, steps.step);
    };
    if (Outcome failed = measureOn(options.device, measure); failed.status != kExitDone) {
        return failed;
    }
    Outcome outcome = outcomeOf(result, parser);
    if (outcome.status != kExitDone && !options.settings.keepGoing) {
        return outcome;
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        writeLocalize(out, options.output.format(), *scene, result);
        return {};
    });
    return written.ok() ? outcome : Outcome(written.error());
}

} // namespace voxtact::app

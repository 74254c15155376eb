// SPDX-License-Identifier: MIT
#include "app/compare/compare_inputs.h"
#include "app/options/lab_run.h"
#include "lab/compare_localize.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

constexpr std::uint32_t kDefaultPoses = 8;
constexpr std::uint32_t kDefaultRepeats = 3;

CompareOptions withDefaults(const CompareOptions& given, const CLI::App& parser) {
    CompareOptions options = given;
    if (parser.get_option("--count")->empty()) {
        options.count = kDefaultPoses;
    }
    if (parser.get_option("--repeats")->empty()) {
        options.settings.repeats = kDefaultRepeats;
    }
    return options;
}

Outcome outcomeOf(const LocalizeResult& result, const CLI::App& parser) {
    if (!result.failedPose) {
        return {};
    }
    return {kExitVerify, disagreementOf(result) + "; again with: " +
                             commandLine(parser, {"--output", "--format", "--only-pose", "--progress"}) +
                             " --only-pose " + std::to_string(*result.failedPose)};
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
    const Result<CompareData> data = readCompareData(options);
    if (!data.ok()) {
        return data.error();
    }
    LocalizeResult result;
    std::shared_ptr<const ValidationMessages> messages;
    {
        const Result<Session> session = openSession(options.device);
        if (!session.ok()) {
            return session.error();
        }
        messages = session->instance.messages();
        result.machine = describeMachine(*session, data->volume.type, provenanceOf(parser));
        ShownSteps shown(options.progress, "voxtact compare");
        const Steps steps = shown.steps();
        steps.begin(std::uint64_t{options.settings.repeats} * data->poses.size());
        const Result<void> done = localize(*session, options.settings, *data, result, steps.step);
        if (!done.ok()) {
            return done.error();
        }
    }
    if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
        return invalid;
    }
    Outcome outcome = outcomeOf(result, parser);
    if (outcome.status != kExitDone && !options.settings.keepGoing) {
        return outcome;
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        writeLocalize(out, options.output.format(), *data, result);
        return {};
    });
    return written.ok() ? outcome : Outcome(written.error());
}

} // namespace voxtact::app

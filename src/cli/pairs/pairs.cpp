// SPDX-License-Identifier: MIT
#include "cli/files/pair_files.h"
#include "cli/options/inputs.h"
#include "cli/options/output_paths.h"
#include "cli/output/interrupt.h"
#include "cli/output/standard_streams.h"
#include "cli/pairs/pair_engine.h"
#include "core/base/try.h"
#include "core/method/method_table.h"

namespace voxtact::app {

namespace {

/// The method of a device.
CountingMethod deviceMethod(const PairOptions& options, const Context& context) {
    return options.method.count.value_or(rowOf(*options.method.projection).certified ? CountingMethod::Compute
                                                                                     : context.defaultMethod());
}

/// Refuses an output that is an input or another output.
Result<void> checkPairPaths(const PairOptions& options) {
    const SideFile side = sideFile(options);
    return checkOutputs(
        {{"--output", options.output.path.empty() ? "-" : options.output.path},
         {side.option, side.path},
         {"--contacts", options.extra.contacts}},
        inputPaths(options.volumes, options.meshes, options.transferFunction, options.view, options.labels));
}

/// Runs on the host, or on the device of the options.
Result<void> withEngine(const PairOptions& options, const PairInputs& inputs, std::vector<std::string>& notes,
                        std::shared_ptr<const device::ValidationMessages>& messages, const UseEngine& answer) {
    if (isForHost(options)) {
        if (!options.device.wanted.empty()) {
            notes.push_back("--device " + options.device.wanted + " is not used: the host engine answers");
        }
        return withHostEngine(options, inputs, answer);
    }
    const Result<device::Session> session = openSession(options.device);
    VOXTACT_TRY(session);
    messages = session->instance.messages();
    const CountingMethod method = deviceMethod(options, session->context);
    if (options.threads > 0) {
        notes.push_back("--threads " + std::to_string(options.threads) + " is not used: the device engine answers");
    }
    if (options.isTouch() && !options.labels.path.empty()) {
        notes.emplace_back("--labels is not used: the device engine gives no witness point");
    }
    Result<void> answered = withDeviceEngine(options, inputs, *session, method, answer);
    const device::VulkanDevice& device = session->device;
    if (options.timing && (!device.hasTimestamps() || device.missedTimestamps())) {
        notes.emplace_back("--timing: gpu_ms is empty if the device has no timestamps, or they went "
                           "backwards or did not move");
    }
    return answered;
}

Outcome interruptedOutcome(const PairOptions& options, PairOutput& output) {
    VOXTACT_TRY(output.breakOff());
    const bool toFile = !options.output.path.empty();
    return interruptOutcome(toFile ? "'" + options.output.path.string() + "' is not written"
                                   : std::to_string(output.rows()) + " pairs are written");
}

/// Prints the notes and the summary of a run that succeeded.
void printEnd(const PairOptions& options, const PairOutput& output, std::vector<std::string> notes) {
    notes.push_back(output.noteOfContacts());
    notes.push_back(output.openBounds().note(options.question.name));
    for (const std::string& note : notes) {
        if (!note.empty()) {
            printNote(note);
        }
    }
    if (options.summary) {
        printSummary(output.summary());
    }
}

} // namespace

Outcome runPairs(PairOptions options) {
    VOXTACT_TRY(resolveOptions(options));
    VOXTACT_TRY(checkPairPaths(options));
    const InterruptGuard guard;
    Result<PairInputs> inputs = readPairInputs(options);
    if (!inputs.ok()) {
        return interrupted() ? interruptOutcome("nothing is written") : Outcome(inputs.error());
    }
    Result<PairOutput> output = PairOutput::create(options, *inputs);
    VOXTACT_TRY(output);
    std::vector<std::string> notes; // printed after success: an error is one line
    std::shared_ptr<const device::ValidationMessages> messages;
    double milliseconds = 0;
    const Result<void> done = withEngine(options, *inputs, notes, messages, [&](PairEngine& engine) -> Result<void> {
        const Result<double> took = answerPairs(options, *inputs, engine, *output, notes);
        milliseconds = took.ok() ? *took : 0;
        return took.ok() ? Result<void>() : took.error();
    });
    if (!done.ok()) {
        VOXTACT_TRY(output->fail());
        return done.error();
    }
    if (messages) {
        if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
            return invalid;
        }
    }
    if (interrupted()) {
        return interruptedOutcome(options, *output);
    }
    VOXTACT_TRY(output->finish(milliseconds));
    printEnd(options, *output, std::move(notes));
    return {};
}

} // namespace voxtact::app

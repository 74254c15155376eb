// SPDX-License-Identifier: MIT
#include "app/auto_method.h"
#include "app/commands.h"
#include "app/detect_run.h"
#include "app/standard_streams.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

constexpr const char* kFooter =
    R"(--volume and --mesh may be given several times. One row a pair: every pose of every mesh against every volume. Columns:
  pose,mesh,volume             number of the pose in its file from 0; the sources as they were given
  hit,count                    1 when at least one fragment survives; how many do
  exact                        1: the count is exact; 0: only zero or not zero is known (query-any)
  method,projection            what the count comes from
  gpu_ms,wall_ms (--timing)    device time, and time from the start of recording to the results in host memory, of
                               the row's submission divided by its pairs. Submissions overlap: the last line
                               '# pairs= wall_ms= pairs_per_s=' has the time of all. Reading files, uploads and making
                               pipelines are not included; there is no warm-up. With --batch 1 each pair is submitted
                               and waited for alone. With --count cpu gpu_ms is 0.

Examples:
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --opacity "40:0,80:1" --format json
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --count atomic --timing --batch 1
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel --count cpu)";

/// What cannot go together with a method, found before anything is read.
Result<void> checkMethodOptions(const DetectOptions& options) {
    if (options.method.count != CountingMethod::Cpu) {
        return {};
    }
    if (options.method.filter == Filter::Hardware) {
        return badArgument("--filter hardware: the counting method cpu has no device's sampler; it filters exact only");
    }
    if (options.device.validate) {
        return badArgument("--validate: the counting method cpu uses no Vulkan, there is nothing to validate; leave "
                           "out one of the two");
    }
    return {};
}

AutoLimits autoLimits(const DetectOptions& options) {
    // Who names a device, or wants Vulkan validated, wants it used.
    const bool host = options.device.wanted.empty() && !options.device.validate;
    return {options.method.filter, options.view.size, host && options.method.filter != Filter::Hardware};
}

/// By the device that the options name; by the host where they, or the want of a device, say so.
Result<void> detect(const DetectOptions& options, const DetectInputs& inputs, DetectRun& run,
                    std::shared_ptr<const ValidationMessages>& messages) {
    if (options.method.count == CountingMethod::Cpu) {
        if (!options.device.wanted.empty()) {
            run.notes.push_back("--device " + options.device.wanted +
                                " is not used: the counting method cpu runs on the host");
        }
        return detectOnHost(options, inputs, run);
    }
    const AutoLimits limits = autoLimits(options);
    {
        const Result<Session> session = openSession(options.device);
        if (session.ok()) {
            messages = session->instance.messages();
            const Result<AutoChoice> choice = options.method.count
                                                  ? AutoChoice{*options.method.count, {}}
                                                  : autoMethod(*session, limits, !options.device.validate);
            if (!choice.ok()) {
                return choice.error();
            }
            if (!choice->note.empty()) {
                run.notes.push_back(choice->note);
            }
            if (choice->method != CountingMethod::Cpu) {
                return detectOnDevice(options, inputs, *session, choice->method, run);
            }
        } else if (options.method.count || !limits.host) {
            return session.error();
        } else {
            run.notes.push_back(noDeviceNote(session.error()));
        }
    }
    return detectOnHost(options, inputs, run);
}

Outcome runDetect(const DetectOptions& options) {
    if (const Result<void> usable = checkMethodOptions(options); !usable.ok()) {
        return usable.error();
    }
    if (const Result<void> writable = checkOutput(options.output.path); !writable.ok()) {
        return writable.error();
    }
    const Result<DetectInputs> inputs = readDetectInputs(options);
    if (!inputs.ok()) {
        return inputs.error();
    }
    DetectRun run;
    std::shared_ptr<const ValidationMessages> messages;
    if (const Result<void> done = detect(options, *inputs, run, messages); !done.ok()) {
        return done.error();
    }
    if (messages) {
        if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
            return invalid;
        }
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        writeTable(out, options.output.format(), makeDetectTable(options, run));
        return {};
    });
    if (!written.ok()) {
        return written.error();
    }
    for (const std::string& note : run.notes) {
        printNote(note);
    }
    return {};
}

} // namespace

Command addDetect(CLI::App& program) {
    auto options = std::make_shared<DetectOptions>();
    CLI::App* parser = program.add_subcommand("detect", "which pairs of mesh and volume touch, and how much");
    parser->footer(kFooter);
    addVolumeOption(*parser, options->volumes);
    addMeshOptions(*parser, options->meshes);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addViewOptions(*parser, options->view);
    addMethodOptions(*parser, options->method);
    addWholeNumber(*parser, "--batch", options->batch, 1, "pairs a submission");
    parser->add_flag("--timing", options->timing, "adds gpu_ms and wall_ms to each row, and a last line; see below");
    addDeviceOptions(*parser, options->device);
    addOutputOptions(*parser, options->output);
    addProgressOption(*parser, options->progress);
    return {parser, [options] { return runDetect(*options); }};
}

} // namespace voxtact::app

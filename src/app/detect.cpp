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
  hit,count                    1 (yes) when at least one fragment survives; how many do; 2 (possible), with
                               conservative: nothing certain, but fragments that could not be decided
  exact                        1: the count is exact; 0: at least so many (query-any: zero or not zero is known)
  method,projection            what the count comes from
  triangles (--triangles)      how many triangles have survivors
  contacts,depth (--contacts)  how many contacts there are, and the deepest in mm
  labels (--labels)            survivors by label, most first: Frontal_Sup_L:12;Precentral_L:3
  min_x,...,max_z (--bounds)   world box of the survivors in mm
  gpu_ms,wall_ms (--timing)    device time, and time from the start of recording to the results in host memory, of
                               the row's submission divided by its pairs. Submissions overlap: the last line
                               '# pairs= wall_ms= pairs_per_s=' has the time of all. Reading files, uploads and making
                               pipelines are not included; there is no warm-up. With --batch 1 each pair is submitted
                               and waited for alone. With --count cpu gpu_ms is 0.
Contacts (--contacts): pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label, in world mm, LPS; as points in PLY.

Examples:
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --opacity "40:0,80:1" --format json
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --count atomic --timing --batch 1
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel --count cpu
  voxtact detect --volume head.nii.gz --mesh tool.stl --labels atlas.nii.gz --contacts contacts.ply)";

AutoLimits autoLimits(const DetectOptions& options) {
    // Who names a device, or wants Vulkan validated, wants it used.
    const bool host = options.device.wanted.empty() && !options.device.validate;
    return {options.method.filter, options.view.size, host && options.method.filter != Filter::Hardware};
}

Result<AutoChoice> choose(const DetectOptions& options, const Session& session, const AutoLimits& limits) {
    if (options.method.count) {
        return AutoChoice{*options.method.count, {}};
    }
    if (options.method.projection == Projection::Conservative) {
        return AutoChoice{conservativeMethod(session, limits), {}};
    }
    return autoMethod(session, limits, !options.device.validate);
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
            const Result<AutoChoice> choice = choose(options, *session, limits);
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

/// A list that was cut is still a good run, with fewer contacts than there are.
void noteContacts(const DetectOptions& options, DetectRun& run) {
    if (run.contactsFound > run.contacts.size()) {
        run.notes.push_back(options.extra.contacts.string() + ": " + std::to_string(run.contacts.size()) + " of " +
                            std::to_string(run.contactsFound) + " contacts were kept (--most-contacts " +
                            std::to_string(options.extra.contactRoom()) + ")");
    }
}

Outcome runDetect(DetectOptions options) {
    if (const Result<void> usable = resolveOptions(options); !usable.ok()) {
        return usable.error();
    }
    for (const std::filesystem::path& path : {options.output.path, options.extra.triangles, options.extra.contacts}) {
        if (const Result<void> writable = checkOutput(path); !writable.ok()) {
            return writable.error();
        }
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
    if (const Result<void> written = writeDetectOutputs(options, *inputs, run); !written.ok()) {
        return written.error();
    }
    noteContacts(options, run);
    for (const std::string& note : run.notes) {
        printNote(note);
    }
    return {};
}

void addExtraOptions(CLI::App& parser, ExtraOptions& options) {
    addPath(parser, "--triangles", options.triangles, "a CSV file for the touched triangles: pose,triangle,count");
    addPath(parser, "--contacts", options.contacts,
            "a .csv or .ply file for the places where survivors are, with normal and depth; see below");
    addNumber(
        parser, "--max-depth", [&options](double depth) { options.maxDepth = depth; },
        "mm, how far a contact's depth is followed", [](double depth) { return depth > 0; }, "above 0", "10");
    addWholeNumber(
        parser, "--most-contacts", [&options](std::uint32_t most) { options.mostContacts = most; }, {.least = 1},
        "contacts that are kept; a longer list is cut, with a note", kDefaultMostContacts);
    addPath(parser, "--labels", options.labels, "a label map (an image of whole numbers): names what is touched");
    addPath(parser, "--label-names", options.labelNames,
            "lines 'number name'; default: the label map's path without .gz, with .txt, where that file is");
    parser.add_flag("--bounds", options.bounds, "adds the world box of the survivors to each row");
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
    addExtraOptions(*parser, options->extra);
    addWholeNumber(*parser, "--batch", options->batch, 1, "pairs a submission");
    parser->add_flag("--timing", options->timing, "adds gpu_ms and wall_ms to each row, and a last line; see below");
    addDeviceOptions(*parser, options->device);
    addOutputOptions(*parser, options->output);
    addProgressOption(*parser, options->progress);
    return {parser, [options] { return runDetect(*options); }};
}

} // namespace voxtact::app

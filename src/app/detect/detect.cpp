// SPDX-License-Identifier: MIT
#include "app/chunks/run_folder.h"
#include "app/commands.h"
#include "app/detect/auto_method.h"
#include "app/detect/detect_chunks.h"
#include "app/detect/pair_engine.h"
#include "app/detect/side_files.h"
#include "app/options/inputs.h"
#include "app/options/output_paths.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "core/base/try.h"
#include "core/method/method_table.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

constexpr const char* kDetectFooter =
    R"(--volume and --mesh may be given several times. One row per pair: every pose of every mesh against every volume. Columns:
  pose,mesh,volume             number of the pose in its file from 0; the sources as they were given
  hit,count                    1 (yes) when at least one fragment survives; how many do; 2 (possible), with
                               conservative: nothing certain, but fragments that could not be decided
  exact                        1: the count is exact; 0: at least so many (query-any: zero or not zero is known)
  method,projection            what the count comes from
  triangles (--triangles)      how many triangles have survivors
  contacts,depth (--contacts)  how many contacts there are, and the deepest in mm
  labels (--labels)            survivors by label, most first: Frontal_Sup_L:12;Precentral_L:3
  min_x,...,max_z (--bounds)   world box of the survivors in mm
  area_lo,area_hi              (--area) bounds of the area of the surface that is opaque, mm^2
  clearance_lo,clearance_hi    (--clearance) bounds of the distance to what is opaque, mm; 0,0: it touches;
                               inf,inf: nothing is opaque; hi inf: beyond --max-clearance
  job (--jobs)                 number of the job, from 0
  gpu_ms,wall_ms (--timing)    device time, and time from the start of recording to the results in host memory, of
                               the row's submission divided by its pairs. Submissions overlap: the last line
                               '# pairs= wall_ms= pairs_per_s=' has the time of all. Reading files, uploads and making
                               pipelines are not included; there is no warm-up. With --batch 1 each pair is submitted
                               and waited for alone. With --count cpu gpu_ms is 0; it is empty where the device has
                               no timestamps, or they went backwards or did not move.
With --stats a line '# clusters= clusters_kept= ...' says what the passes of conservative did on the device; the manual's
page "The certified engine on a device" has what each number is.
Contacts (--contacts): pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label, in world mm, LPS; as points in PLY, in
VTP (VTK, ParaView) and in .mrk.json (3D Slicer); the last two have the boxes of --bounds, too.

Closest points (--closest): pose,mesh,volume,triangle,mesh_x,...,volume_z,label and per_x,...,per_rz, mm of clearance
for each mm of a move, and for each radian of a turn about the object's origin; as vertices and edges in PLY.

With --resume the run is done in chunks, whose files are in that folder: ended at any moment, the same command goes on
from there; many processes do it together, each one --shard, and voxtact merge writes the output: the manual's page "Many
machines". Without --resume rows come as they are known. Ctrl-C leaves whole rows on standard output, and files as they were; exit status 130.

Examples:
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --opacity "40:0,80:1" --format json
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --count atomic --timing --batch 1
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel --count cpu
  voxtact detect --volume head.nii.gz --mesh tool.stl --labels atlas.nii.gz --contacts contacts.ply
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses - --count cpu --answer yes-no --threads 2 < poses.txt
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --clearance --closest closest.csv
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --margin 2
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --pose-tolerance 1,2
  voxtact detect --jobs jobs.csv --output rows.csv
  voxtact detect --jobs jobs.csv --resume run --output rows.csv
  voxtact detect --jobs jobs.csv --resume run --shard 2/7)";

/// More only wait for each other.
constexpr std::uint32_t kMostThreads = 1024;

AutoLimits autoLimits(const DetectOptions& options) {
    // Who names a device, or wants Vulkan validated, wants it used.
    // What is counted for --stats is a device's work.
    const bool host = options.device.wanted.empty() && !options.device.validate && !options.stats;
    return {options.method.filter, options.view.size, host && options.method.filter != Filter::Hardware};
}

CertifiedAsk certifiedAsk(const DetectOptions& options, const DetectInputs& inputs) {
    return {.yesNo = options.yesNo(),
            .pairs = inputs.pairs(options.jobs),
            .threads = options.threads,
            .measure = !options.chunks.asked()};
}

/// Whether the host answers, and no device need be looked for.
bool isForHost(const DetectOptions& options, const DetectInputs& inputs) {
    return options.method.count ? rowOf(*options.method.count).host
                                : rowOf(*options.method.projection).certified && autoLimits(options).host &&
                                      certifiedAsk(options, inputs).isSmall();
}

Result<AutoChoice> choose(const DetectOptions& options, const DetectInputs& inputs, const device::Session& session,
                          const AutoLimits& limits) {
    if (options.method.count) {
        return AutoChoice{*options.method.count, {}};
    }
    if (rowOf(*options.method.projection).certified) {
        return certifiedMethod(session, limits, certifiedAsk(options, inputs), options.device);
    }
    return autoMethod(session, limits, options.device);
}

/// All files and folders that the options read.
std::vector<NamedPath> readPaths(const DetectOptions& options) {
    const ExtraOptions& extra = options.extra;
    std::vector<NamedPath> inputs = inputPaths(options.volumes, options.meshes, options.transferFunction, options.view);
    if (options.jobs.fromFile) {
        addInput(inputs, "--jobs", options.jobsPath);
        for (const std::vector<std::string>* sources : {&options.jobs.volumes, &options.jobs.meshes}) {
            for (const std::string& source : *sources) {
                addInput(inputs, "--jobs", source);
            }
        }
        for (const std::filesystem::path& poses : options.jobs.poses) {
            addInput(inputs, "--jobs", poses);
        }
    }
    if (!extra.labels.empty()) {
        inputs.push_back({"--labels", extra.labels});
        inputs.push_back({"--label-names", labelNamesPath(extra.labelNames, extra.labels)});
    }
    return inputs;
}

/// No output may be an input, or another output.
Result<void> checkDetectPaths(const DetectOptions& options) {
    std::vector<NamedPath> inputs = readPaths(options);
    addInput(inputs, "--resume", options.chunks.folder);
    std::vector<NamedPath> outputs{{"--output", options.output.path.empty() ? "-" : options.output.path}};
    for (const auto& [option, path] : sideFiles(options)) {
        outputs.push_back({option, path});
        if (option == "--triangles") { // in the order of --help
            outputs.push_back({"--contacts", options.extra.contacts});
        }
    }
    return checkOutputs(outputs, inputs);
}

/// By the device that the options name; by the host where they, or the want of a device, say so.
Result<void> withEngine(const DetectOptions& options, const DetectInputs& inputs, std::vector<std::string>& notes,
                        std::shared_ptr<const device::ValidationMessages>& messages, const UseEngine& answer) {
    if (isForHost(options, inputs)) {
        if (!options.device.wanted.empty()) {
            notes.push_back("--device " + options.device.wanted +
                            " is not used: the counting method cpu runs on the host");
        }
        return withHostEngine(options, inputs, answer);
    }
    const AutoLimits limits = autoLimits(options);
    {
        const Result<device::Session> session = openSession(options.device);
        if (session.ok()) {
            messages = session->instance.messages();
            const Result<AutoChoice> choice = choose(options, inputs, *session, limits);
            VOXTACT_TRY(choice);
            if (!choice->note.empty()) {
                notes.push_back(choice->note);
            }
            if (!rowOf(choice->method).host) {
                if (options.method.count && options.threads > 0) {
                    notes.push_back("--threads " + std::to_string(options.threads) +
                                    " is not used: the counting method " + toString(choice->method) +
                                    " runs on the device");
                }
                Result<void> answered = withDeviceEngine(options, inputs, *session, choice->method, answer);
                const device::VulkanDevice& device = session->device;
                if (options.timing && (!device.hasTimestamps() || device.missedTimestamps())) {
                    notes.emplace_back("--timing: gpu_ms is empty where the device has no timestamps, or they went "
                                       "backwards or did not move");
                }
                return answered;
            }
        } else if (options.method.count || !limits.host) {
            return session.error();
        } else {
            notes.push_back(noDeviceNote(session.error()));
        }
    }
    return withHostEngine(options, inputs, answer);
}

Outcome interruptedOutcome(const DetectOptions& options, DetectOutput& output) {
    VOXTACT_TRY(output.breakOff());
    const bool toFile = !options.output.path.empty();
    return interruptOutcome(toFile ? "'" + options.output.path.string() + "' is not written"
                                   : std::to_string(output.rows()) + " pairs are written");
}

/// What went wrong, or that the user wants no more; else the notes are said.
Outcome endOf(const Outcome& outcome, const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
        if (outcome.status == kExitDone) {
            printNote(note);
        }
    }
    return outcome;
}

/// `auto` is what a run began with, wherever it goes on. Returns whether it has begun.
bool goOnAlike(DetectOptions& options) {
    const std::optional<CountingMethod> begun = options.method.count ? std::nullopt : methodOfRun(options.chunks);
    if (!begun || (rowOf(*begun).host && !autoLimits(options).host)) {
        return false;
    }
    options.method.count = begun;
    return true;
}

Outcome runInChunks(const CLI::App& parser, DetectOptions options, DetectInputs& inputs) {
    const bool goesOn = goOnAlike(options);
    Result<RunFacts> facts = detectRunFacts(parser, options, readPaths(options));
    VOXTACT_TRY(facts);
    std::vector<std::string> notes;
    std::shared_ptr<const device::ValidationMessages> messages;
    Outcome outcome;
    const Result<void> done = withEngine(options, inputs, notes, messages, [&](PairEngine& engine) -> Result<void> {
        outcome = answerChunks(options, inputs, std::move(*facts), engine, notes);
        return {};
    });
    if (!done.ok() && goesOn) {
        return Error{done.error().code, done.error().vkResult,
                     done.error().text + "; the run in " + folderText(options.chunks.folder) + " was begun by " +
                         toString(*options.method.count)};
    }
    VOXTACT_TRY(done);
    return endOf(outcome, notes);
}

Outcome runDetect(const CLI::App& parser, DetectOptions options) {
    VOXTACT_TRY(resolveOptions(options));
    VOXTACT_TRY(checkDetectChunks(options));
    VOXTACT_TRY(checkDetectPaths(options));
    const InterruptGuard guard;
    Result<DetectInputs> inputs = readDetectInputs(options);
    if (!inputs.ok()) {
        return interrupted() ? interruptOutcome("nothing is written") : Outcome(inputs.error());
    }
    if (options.chunks.asked()) {
        return runInChunks(parser, options, *inputs);
    }
    Result<DetectOutput> output = DetectOutput::create(options, *inputs);
    VOXTACT_TRY(output);
    std::vector<std::string> notes; // to be said once all has gone well: an error is one line
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
    for (const std::string& note : {output->noteOfContacts(), output->clearanceEnds().note(), output->areaEnds().note(),
                                    output->labelAreaEnds().note()}) {
        if (!note.empty()) {
            notes.push_back(note);
        }
    }
    return endOf({}, notes);
}

void addDistanceOptions(CLI::App& parser, DistanceOptions& options) {
    parser.add_flag("--clearance", options.clearance,
                    "adds clearance_lo and clearance_hi: between them lies the least distance between the surface and "
                    "what is opaque, in mm; by the host, or by --count compute");
    addNumber(
        parser, "--tolerance", [&options](double mm) { options.tolerance = mm; },
        "mm, how near to each other these are brought", [](double mm) { return mm >= 1e-6; }, "at least 1e-6", "0.01");
    addNumber(
        parser, "--max-clearance", [&options](double mm) { options.maximum = mm; },
        "mm; what is farther away is not measured: clearance_hi is then inf, and much faster",
        [](double mm) { return mm > 0; }, "above 0", "none");
    addPath(parser, "--closest", options.closest,
            "a .csv or .ply file for the closest points of each pair, and how the clearance changes with the pose");
    addPath(parser, "--label-clearance", options.labels,
            "a CSV file for the clearance to each label of --labels: "
            "pose,mesh,volume,label,name,clearance_lo,clearance_hi");
    parser.add_flag("--area", options.area,
                    "adds area_lo and area_hi: between them lies how much of the surface is opaque, in mm^2; by the "
                    "host");
    addNumber(
        parser, "--area-tolerance", [&options](double mm2) { options.areaTolerance = mm2; },
        "mm^2, how near to each other these are brought", [](double mm2) { return mm2 >= 1e-9; }, "at least 1e-9",
        "0.1");
    addPath(parser, "--label-area", options.labelAreas,
            "a CSV file for the area in each label of --labels: pose,mesh,volume,label,name,area_lo,area_hi");
    addPath(parser, "--triangle-area", options.triangleAreas,
            "a CSV file for the area of each triangle: pose,mesh,volume,triangle,triangle_area,area_lo,area_hi");
    parser
        .add_option("--to", options.to,
                    "the labels that --label-clearance and --label-area are about, by number or name; default: all "
                    "but 0")
        ->delimiter(',')
        ->type_name("LABEL,...");
    parser.add_flag("--to-any-opacity", options.toAnyOpacity,
                    "--label-clearance is to all of a label, not to what is opaque of it");
    addNumber(
        parser, "--margin", [&options](double mm) { options.margin = mm; },
        "mm: hit says whether anything opaque is so near, as certified as a touch; 0 is the touch itself",
        [](double mm) { return mm >= 0; }, "at least 0", "none");
    addText(
        parser, "--pose-tolerance",
        [&options](const std::string& text) -> std::optional<std::string> {
            const std::size_t comma = text.find(',');
            const std::optional<double> mm = parseFinite(std::string_view(text).substr(0, comma));
            const std::optional<double> degrees =
                comma == std::string::npos ? std::nullopt : parseFinite(std::string_view(text).substr(comma + 1));
            if (!mm || !degrees || *mm < 0 || *degrees < 0 || *degrees > 180) {
                return "is not two numbers MM,DEG, at least 0, and the second at most 180";
            }
            options.poseTolerance = PoseTolerance{*mm, *degrees};
            return {};
        },
        "hit says whether anything opaque is touched at some pose that is off by no more: turned by up to DEG degrees "
        "about any axis through the object's origin, and moved by up to MM; as certified as a touch; by the host, or "
        "by --count compute",
        "MM,DEG");
}

} // namespace

Command addDetect(CLI::App& program) {
    auto options = std::make_shared<DetectOptions>();
    CLI::App* parser = program.add_subcommand("detect", "which pairs of mesh and volume touch, and how much");
    parser->footer(kDetectFooter);
    addVolumeOption(*parser, options->volumes);
    parser->get_option("--volume")->required(false);
    addMeshOptions(*parser, options->meshes, false);
    addPath(*parser, "--jobs", options->jobsPath,
            "a CSV file of mesh,volume,poses, one job per line, instead of --mesh, --volume and --poses");
    addTransferFunctionOptions(*parser, options->transferFunction);
    addViewOptions(*parser, options->view);
    addMethodOptions(*parser, options->method);
    addExtraOptions(*parser, options->extra);
    addDistanceOptions(*parser, options->distance);
    addName(*parser, "--answer", options->answer, {"count", "yes-no"},
            "count, or yes-no: stops at the first contact, which is much faster; count is then 0 or 1, and exact 0; "
            "default: count");
    addWholeNumber(
        *parser, "--batch", [options](std::uint32_t pairs) { options->batch = pairs; }, {.least = 1},
        "pairs per submission, at most; few at first unless this is given, so that rows come soon", kDefaultBatch);
    addWholeNumber(
        *parser, "--threads", [options](std::uint32_t threads) { options->threads = threads; },
        {.least = 0, .most = kMostThreads}, "of the counting method cpu; 0: one for each processor", 0);
    parser->add_flag("--timing", options->timing, "adds gpu_ms and wall_ms to each row, and a last line; see below");
    parser->add_flag("--stats", options->stats,
                     "adds a line with what the device did for the projection conservative; see below");
    addDeviceOptions(*parser, options->device);
    addChunkOptions(*parser, options->chunks);
    addOutputOptions(*parser, options->output);
    addProgressOption(*parser, options->progress);
    return {parser, [options, parser] { return runDetect(*parser, *options); }};
}

} // namespace voxtact::app

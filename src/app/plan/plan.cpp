// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/detect/detect_run.h"
#include "app/output/interrupt.h"
#include "app/output/progress.h"
#include "app/output/standard_streams.h"
#include "app/output/target_path.h"
#include "app/output/text_for_messages.h"
#include "app/plan/plan_picture.h"
#include "app/plan/plan_run.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"
#include "voxtact/io.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

namespace voxtact::app {

namespace {

constexpr const char* kPlanFooter =
    R"(An instrument goes straight from an entry to the target. There is a row for each of --entries directions from each
target along which there is an entry within the limits:
  entry,x,y,z                  number of the direction; the entry, world mm, LPS
  safe                         1 (safe): it certainly keeps more than --margin from all that is to be avoided, all the
                               way; 0 (unsafe): it certainly does not; 2 (possible): neither could be shown
  clearance_lo,clearance_hi    mm: how near it comes on its way is between them; 0 where it touches; hi is inf beyond
                               --max-clearance
  nearest,nearest_x,...        what it comes nearest to, a label's name or opaque; a point of that
  length,angle                 mm from entry to target; degrees between the path and the normal of the entries' surface
  crosses                      the labels that its axis goes through, from the entry on
  target                       the target's label, its name in --targets, or its number, from 1

Where the image ends within what is opaque, as at a neck, no path begins, unless --border-entries is given.

A builtin needle is round and solid. A mesh needs --tip and --axis, and counts by its surface. --summary and --report
say how many paths are safe, which is the best one, and for a needle the area of the patches all of whose paths certainly
are safe, not only those of the rows.

Examples:
  voxtact plan --volume head.nii.gz --labels atlas.nii.gz --target Thalamus_L --avoid Precentral_L,Insula_L
  voxtact plan --volume head.nii.gz --labels atlas.nii.gz --target -10,20,8 --avoid 1,29 --margin 2 --entries 100000 \
      --mesh builtin:needle:1.5:180 --max-length 90 --surface entries.ply --output paths.csv
  voxtact plan --volume head.nii.gz --labels atlas.nii.gz --target-label Thalamus_L,Thalamus_R --target 4,20,-8 \
      --avoid Precentral_L,Insula_L --by-target targets.csv --report paths.html --output paths.csv)";

Result<void> checkOptions(const PlanOptions& options) {
    if (options.volumes.size() > 1 || options.meshes.sources.size() > 1) {
        return badArgument(std::string(options.volumes.size() > 1 ? "--volume" : "--mesh") +
                           ": a plan is about one; leave out the others");
    }
    if (options.targets.empty() && options.targetLabels.empty() && options.targetFile.empty()) {
        return badArgument("--target, --target-label, --targets: one of them must say where the tip goes");
    }
    if (options.axis && std::hypot((*options.axis)[0], (*options.axis)[1], (*options.axis)[2]) == 0) {
        return badArgument("--axis: 0,0,0 points nowhere; it goes from the tip to where the instrument is held");
    }
    if (!options.surface.empty() && options.surface.extension() != ".ply") {
        return badArgument("--surface: the ending of '" + options.surface.string() + "' must be .ply");
    }
    if (!options.picture.empty() && options.picture.extension() != ".png") {
        return badArgument("--picture: the ending of '" + options.picture.string() + "' must be .png");
    }
    if (options.picture.empty() && (options.sizeGiven || !options.device.wanted.empty() || options.device.validate)) {
        return badArgument(std::string(options.sizeGiven         ? "--size"
                                       : options.device.validate ? "--validate"
                                                                 : "--device") +
                           ": it is about a picture; give --picture, or leave it out");
    }
    if (!options.report.empty() && options.report.extension() != ".html") {
        return badArgument("--report: the ending of '" + options.report.string() + "' must be .html");
    }
    return {};
}

/// Of all targets, one after the other.
Result<std::vector<TargetPlan>> planAll(const PlanOptions& options, const PlanInputs& inputs, cpu::Planner& planner) {
    Progress progress(options.progress, "voxtact plan: targets", inputs.targets.size());
    std::vector<TargetPlan> plans;
    for (std::size_t target = 0; target < inputs.targets.size() && !interrupted(); ++target) {
        Result<TargetPlan> plan = planFor(inputs, target, planner);
        VOXTACT_TRY(plan);
        plans.push_back(std::move(*plan));
        progress.update(plans.size());
    }
    return plans;
}

/// `png`: the content of the picture; empty: there is none.
Result<void> deliverPlans(const PlanOptions& options, const PlanInputs& inputs, const std::vector<TargetPlan>& plans,
                          const std::string& png) {
    std::vector<Delivery> deliveries;
    deliveries.push_back({options.output.path, [&](std::ostream& out) -> Result<void> {
                              writePlanTable(out, options.output.format(), inputs, plans, options.timing);
                              return {};
                          }});
    if (!options.byTarget.empty()) {
        deliveries.push_back({options.byTarget, [&](std::ostream& out) -> Result<void> {
                                  io::writeTable(out, io::Format::Csv, targetTable(inputs, plans));
                                  return {};
                              }});
    }
    for (const TargetFile& file : targetFiles(options, inputs)) {
        for (const TargetPlan& plan : plans) {
            deliveries.push_back({targetPath(file.path, plan.target.name),
                                  [write = file.write, &plan](std::ostream& out) { return write(out, plan); }});
        }
    }
    if (!options.picture.empty()) {
        deliveries.push_back({options.picture, [&](std::ostream& out) -> Result<void> {
                                  out << png;
                                  return {};
                              }});
    }
    if (!options.report.empty()) {
        deliveries.push_back({options.report, [&](std::ostream& out) -> Result<void> {
                                  writePlanReport(out, inputs, plans, options.maximum, png);
                                  return {};
                              }});
    }
    return deliverAll(std::move(deliveries));
}

/// The device of a picture, from before the work on: without one there is no need to begin.
class PictureDevice {
  public:
    [[nodiscard]] Result<void> open(const PlanOptions& options) {
        Result<device::Session> session = openSession(options.device);
        if (!session.ok()) {
            Error error = session.error();
            if (error.code != ErrorCode::InvalidArgument) {
                error.text = "--picture needs a Vulkan device: " + error.text;
            }
            return error;
        }
        messages_ = session->instance.messages();
        session_ = std::make_unique<device::Session>(std::move(*session));
        return checkViewport(options.half, session_->context.maxViewport(), "the device");
    }
    /// The picture's file.
    [[nodiscard]] Result<std::string> paint(const PlanOptions& options, const PlanInputs& inputs,
                                            std::span<const TargetPlan> plans) const {
        const Result<Picture> picture = planPicture(options, inputs, plans, *session_);
        VOXTACT_TRY(picture);
        TextStream png;
        VOXTACT_TRY(io::writePng(png, picture->width, picture->height, picture->rgba,
                                 [](std::uint32_t /*done*/, std::uint32_t /*rows*/) { return !interrupted(); }));
        return png.str();
    }
    /// What validation has said, which is complete once the device is closed.
    [[nodiscard]] Outcome close() {
        session_.reset();
        return messages_ ? validationOutcome(*messages_) : Outcome();
    }

  private:
    std::unique_ptr<device::Session> session_;
    std::shared_ptr<const device::ValidationMessages> messages_;
};

Outcome runPlan(const CLI::App& parser, PlanOptions options) {
    if (options.chunks.asked() && options.output.formatName.empty()) {
        options.output.formatName = "csv"; // whoever looks on: the chunks are the same
    }
    VOXTACT_TRY(checkOptions(options));
    VOXTACT_TRY(checkPlanChunks(options));
    VOXTACT_TRY(checkOutputs(planWrites(options), planReads(options)));
    const InterruptGuard guard;
    const Result<std::unique_ptr<PlanInputs>> read = readPlan(options);
    VOXTACT_TRY(read);
    PlanInputs& inputs = **read;
    VOXTACT_TRY(checkTargetFiles(options, inputs));
    PictureDevice device;
    if (!options.picture.empty()) {
        VOXTACT_TRY(device.open(options));
    }
    inputs.task.cancel = &interruptFlag();
    Result<cpu::Planner> planner =
        cpu::Planner::create({.threads = options.threads, .tolerance = options.tolerance, .maximum = options.maximum});
    VOXTACT_TRY(planner);
    if (options.chunks.asked()) {
        return runPlanChunks(parser, options, inputs, *planner);
    }
    const Result<std::vector<TargetPlan>> plans = planAll(options, inputs, *planner);
    if (interrupted()) {
        return interruptOutcome("nothing is written");
    }
    VOXTACT_TRY(plans);
    std::string png;
    if (!options.picture.empty()) {
        Result<std::string> painted = device.paint(options, inputs, *plans);
        if (interrupted()) {
            return interruptOutcome("nothing is written");
        }
        VOXTACT_TRY(painted);
        png = std::move(*painted);
        if (Outcome invalid = device.close(); invalid.status != kExitDone) {
            return invalid;
        }
    }
    VOXTACT_TRY(deliverPlans(options, inputs, *plans, png));
    std::vector<std::string> notes = inputs.notes;
    if (options.summary) {
        std::ranges::move(planNotes(inputs, *plans), std::back_inserter(notes));
    }
    for (const std::string& note : notes) {
        printNote(note);
    }
    return {};
}

} // namespace

std::vector<NamedPath> planReads(const PlanOptions& options) {
    std::vector<NamedPath> inputs = inputPaths(options.volumes, options.meshes, options.transferFunction, {});
    addInput(inputs, "--avoid-volume", options.avoidVolume);
    addInput(inputs, "--targets", options.targetFile);
    if (!options.labels.empty()) {
        inputs.push_back({"--labels", options.labels});
        inputs.push_back({"--label-names", labelNamesPath(options.labelNames, options.labels)});
    }
    return inputs;
}

std::vector<NamedPath> planWrites(const PlanOptions& options) {
    return {{"--output", options.output.path},
            {"--by-target", options.byTarget},
            {"--picture", options.picture},
            {"--report", options.report}};
}

Result<TargetPlan> planFor(const PlanInputs& inputs, std::size_t target, cpu::Planner& planner) {
    cpu::PlanTask task = inputs.task;
    task.target = inputs.targets[target].at;
    Result<PlanAnswer> answer = planner.plan(task);
    if (!answer.ok()) {
        Error error = answer.error();
        if (inputs.targets.size() > 1) {
            error.text = "target " + forMessage(inputs.targets[target].name) + ": " + error.text;
        }
        for (const std::string& note : inputs.notes) { // they may be why
            error.text += "; " + note;
        }
        return error;
    }
    return TargetPlan{inputs.targets[target], std::move(*answer)};
}

Command addPlan(CLI::App& program) {
    auto options = std::make_shared<PlanOptions>();
    options->meshes.sources = {"builtin:needle"};
    CLI::App* parser =
        program.add_subcommand("plan", "which straight paths to a target keep clear of what must not be touched");
    parser->footer(kPlanFooter);
    addPlanOptions(*parser, options);
    return {parser, [options, parser] { return runPlan(*parser, *options); }};
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/output/interrupt.h"
#include "cli/output/progress.h"
#include "cli/output/standard_streams.h"
#include "cli/output/target_path.h"
#include "cli/output/text_for_messages.h"
#include "cli/pairs/pair_run.h"
#include "cli/plan/plan_picture.h"
#include "cli/plan/plan_run.h"
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
    R"(Output: a row per straight path: entry,x,y,z,safe,lower,upper,nearest,...,target
  safe           0 unsafe, 1 safe: both proven; 2 undecided
  lower,upper    bounds of the distance to the obstacles, mm
  nearest,...    label of the nearest obstacle, or opaque; its nearest point
  length,angle   mm; degrees from the normal of the entry surface
  crosses        labels on the axis

Example:
  voxtact plan --volume head.nii.gz --labels aal.nii.gz --target Thalamus_L \
      --avoid Precentral_L,Insula_L --margin 2 --report paths.html)";

Result<void> checkOptions(const PlanOptions& options) {
    if (options.volumes.size() > 1 || options.meshes.sources.size() > 1) {
        return badArgument(std::string(options.volumes.size() > 1 ? "--volume" : "--mesh") +
                           ": a plan needs exactly one; leave out the others");
    }
    if (options.targets.empty() && options.targetLabels.empty() && options.targetFile.empty()) {
        return badArgument("no target; add --target, --target-label or --targets");
    }
    if (options.axis && std::hypot((*options.axis)[0], (*options.axis)[1], (*options.axis)[2]) == 0) {
        return badArgument("--axis: 0,0,0 has no direction; give the direction from the tip to the handle");
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
                           ": it applies to a picture; add --picture, or leave it out");
    }
    if (!options.report.empty() && options.report.extension() != ".html") {
        return badArgument("--report: the ending of '" + options.report.string() + "' must be .html");
    }
    return {};
}

/// Plans the targets of the shard, one after the other.
Result<std::vector<TargetPlan>> planAll(const PlanOptions& options, const PlanInputs& inputs, cpu::HostEngine& engine) {
    const auto [first, end] = options.shard.range(inputs.targets.size());
    Progress progress(options.progress, "voxtact plan: targets", end - first);
    std::vector<TargetPlan> plans;
    for (std::size_t target = first; target < end && !interrupted(); ++target) {
        Result<TargetPlan> plan = planFor(inputs, target, engine);
        VOXTACT_TRY(plan);
        plans.push_back(std::move(*plan));
        progress.update(plans.size());
    }
    return plans;
}

/// `png`: the picture; empty: none.
Result<void> deliverPlans(const PlanOptions& options, const PlanInputs& inputs, const std::vector<TargetPlan>& plans,
                          const std::string& png) {
    std::vector<Delivery> deliveries;
    deliveries.push_back({options.output.path, [&](std::ostream& out) -> Result<void> {
                              writePlanTable(out, options, inputs, plans);
                              return {};
                          }});
    if (!options.byTarget.empty()) {
        deliveries.push_back({options.byTarget, [&](std::ostream& out) -> Result<void> {
                                  writeTargetTable(out, options, inputs, plans);
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
                                  writePlanReport(out, inputs, plans, *options.maximum, png);
                                  return {};
                              }});
    }
    return deliverAll(std::move(deliveries));
}

/// The device of a picture. Opened before the work, so that a missing device fails early.
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
    /// Returns the picture as a PNG file.
    [[nodiscard]] Result<std::string> paint(const PlanOptions& options, const PlanInputs& inputs,
                                            std::span<const TargetPlan> plans) const {
        const Result<Picture> picture = planPicture(options, inputs, plans, *session_);
        VOXTACT_TRY(picture);
        TextStream png;
        VOXTACT_TRY(io::writePng(png, picture->width, picture->height, picture->rgba,
                                 [](std::uint32_t /*done*/, std::uint32_t /*rows*/) { return !interrupted(); }));
        return png.str();
    }
    /// Closes the device and returns its validation messages.
    [[nodiscard]] Outcome close() {
        session_.reset();
        return messages_ ? validationOutcome(*messages_) : Outcome();
    }

  private:
    std::unique_ptr<device::Session> session_;
    std::shared_ptr<const device::ValidationMessages> messages_;
};

Outcome runPlan(PlanOptions options) {
    VOXTACT_TRY(checkShard(options.shard, options.output,
                           {{options.timing, "--timing"},
                            {options.summary, "--summary"},
                            {!options.picture.empty(), "--picture"},
                            {!options.report.empty(), "--report"}}));
    VOXTACT_TRY(checkOptions(options));
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
    if (!options.maximum) {
        const Result<double> maximum = planMaximum(options, inputs);
        if (interrupted()) {
            return interruptOutcome("nothing is written");
        }
        VOXTACT_TRY(maximum);
        options.maximum = *maximum;
    }
    inputs.task.tolerance = options.tolerance;
    inputs.task.maximum = *options.maximum;
    Result<cpu::HostEngine> engine = cpu::HostEngine::create(options.threads);
    VOXTACT_TRY(engine);
    const Result<std::vector<TargetPlan>> plans = planAll(options, inputs, *engine);
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
    std::ranges::for_each(inputs.notes, printNote);
    if (options.summary) {
        std::ranges::for_each(planNotes(inputs, *plans), printSummary);
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

Result<double> planMaximum(const PlanOptions& options, const PlanInputs& inputs) {
    constexpr std::uint32_t kDirections = 642;
    constexpr std::size_t kTargets = 16;
    constexpr double kFar = 1000; // mm: larger than any body
    constexpr double kStep = 5;   // mm
    Result<cpu::HostEngine> engine = cpu::HostEngine::create(options.threads);
    VOXTACT_TRY(engine);
    cpu::Plan task = inputs.task;
    task.tolerance = 1;
    task.maximum = kFar;
    task.surface.entries = std::min(task.surface.entries, kDirections);
    task.triangleDistances = false;
    double max = 0;
    for (std::size_t i = 0; i < std::min(inputs.targets.size(), kTargets); ++i) {
        task.target = inputs.targets[i].at;
        const Result<PlanAnswer> answer = engine->ask(task);
        if (!answer.ok() && answer.error().code != ErrorCode::InvalidArgument) {
            return answer.error();
        }
        for (const PlannedPath& path : answer.ok() ? answer->paths : std::vector<PlannedPath>()) {
            max = std::max(max, path.clearance.upper < kFar ? path.clearance.lower : 0);
        }
    }
    return std::max(kDefaultPlanMaximum, std::ceil(2 * max / kStep) * kStep);
}

Result<TargetPlan> planFor(const PlanInputs& inputs, std::size_t target, cpu::HostEngine& engine) {
    cpu::Plan task = inputs.task;
    task.target = inputs.targets[target].at;
    Result<PlanAnswer> answer = engine.ask(task);
    if (!answer.ok()) {
        Error error = answer.error();
        if (inputs.targets.size() > 1) {
            error.text = "target " + forMessage(inputs.targets[target].name) + ": " + error.text;
        }
        for (const std::string& note : inputs.notes) { // they may explain the error
            error.text += "; " + note;
        }
        return error;
    }
    return TargetPlan{inputs.targets[target], std::move(*answer)};
}

Command addPlan(CLI::App& program) {
    auto options = std::make_shared<PlanOptions>();
    options->meshes.sources = {"builtin:needle"};
    CLI::App* parser = program.add_subcommand("plan", "find straight insertions to a target");
    parser->footer(kPlanFooter);
    addPlanOptions(*parser, options);
    return {parser, [options] { return runPlan(*options); }};
}

} // namespace voxtact::app

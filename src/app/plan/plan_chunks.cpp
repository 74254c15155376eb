// SPDX-License-Identifier: MIT
#include "app/chunks/run_chunks.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "app/plan/plan_run.h"
#include "core/base/try.h"

namespace voxtact::app {

namespace {

/// The files of a chunk, which may have a table of targets.
class ChunkTables {
  public:
    explicit ChunkTables(const PlanOptions& options) : options_(options) {}

    [[nodiscard]] Result<void> open(const ChunkFiles& files) {
        VOXTACT_TRY(add(files, "--output", options_.output.format()));
        return options_.byTarget.empty() ? Result<void>() : add(files, "--by-target", io::Format::Csv);
    }
    void write(const PlanInputs& inputs, const TargetPlan& plan) {
        const std::span<const TargetPlan> one(&plan, 1);
        parts_.front().writer.add(planTable(inputs, one, false));
        if (parts_.size() > 1) {
            parts_.back().writer.add(targetTable(inputs, one));
        }
    }
    [[nodiscard]] Result<void> commit() {
        for (Part& part : parts_) {
            VOXTACT_TRY(part.file.close());
        }
        for (Part& part : parts_) {
            VOXTACT_TRY(part.file.commit());
        }
        return {};
    }

  private:
    struct Part {
        ResultFile file;
        io::TableWriter writer;
    };
    [[nodiscard]] Result<void> add(const ChunkFiles& files, const char* option, io::Format format) {
        Result<ResultFile> file = files.create(option);
        VOXTACT_TRY(file);
        io::TableWriter writer(file->stream(), format);
        writer.omitHead();
        parts_.push_back({std::move(*file), std::move(writer)});
        return {};
    }

    const PlanOptions& options_;
    std::vector<Part> parts_;
};

std::vector<RunOutput> outputsOf(const PlanOptions& options, const PlanInputs& inputs) {
    std::vector<RunOutput> outputs{tableOutput(options.output.format(), planTable(inputs, {}, false))};
    if (!options.byTarget.empty()) {
        outputs.push_back(tableOutput(io::Format::Csv, targetTable(inputs, {})));
        outputs.back().option = "--by-target";
    }
    return outputs;
}

} // namespace

Result<void> checkPlanChunks(const PlanOptions& options) {
    constexpr const char* kAll = "it is about all of a plan at once";
    return checkChunkOptions(
        options.chunks, options.output,
        {{!options.surface.empty(), "--surface", kAll},
         {!options.heatMap.empty(), "--heat-map", kAll},
         {!options.picture.empty(), "--picture", kAll},
         {!options.report.empty(), "--report", kAll},
         {options.summary, "--summary", "no process need have all of the run; --by-target says the same"},
         {options.timing, "--timing", "its chunks are done at different times, perhaps by different machines"}});
}

Outcome runPlanChunks(const CLI::App& parser, const PlanOptions& options, const PlanInputs& inputs,
                      cpu::Planner& planner) {
    RunFacts facts = runFacts(parser, options.chunks, options.output, {"--by-target"});
    MergePaths paths{{"--output", options.output.path}};
    if (!options.byTarget.empty()) {
        // Where it goes makes no other run; that it is asked for does.
        facts.emplace_back("--by-target", "asked for");
        paths.emplace_back("--by-target", options.byTarget);
    }
    VOXTACT_TRY(addInputFacts(facts, planReads(options)));
    ChunkedRun run{"voxtact plan",
                   options.chunks,
                   {std::move(facts), outputsOf(options, inputs), 0},
                   ChunkCut({inputs.targets.size()}, options.chunks.chunk()),
                   false};
    const auto doTargets = [&](const ChunkRange& range, const ChunkFiles& files,
                               const std::function<void(std::uint64_t)>& /*rows*/) -> Result<void> {
        ChunkTables tables(options);
        VOXTACT_TRY(tables.open(files));
        for (std::uint64_t target = range.first; target < range.first + range.count; ++target) {
            const Result<TargetPlan> plan = planFor(inputs, target, planner);
            if (interrupted()) {
                return {};
            }
            VOXTACT_TRY(plan);
            tables.write(inputs, *plan);
        }
        return tables.commit();
    };
    std::vector<std::string> notes;
    Outcome outcome = doChunks(std::move(run), doTargets, paths, notes);
    for (const std::string& note : notes) {
        if (outcome.status == kExitDone) {
            printNote(note);
        }
    }
    return outcome;
}

} // namespace voxtact::app

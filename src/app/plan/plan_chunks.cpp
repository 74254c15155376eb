// SPDX-License-Identifier: MIT
#include "app/chunks/frames.h"
#include "app/chunks/run_chunks.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "app/plan/plan_run.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"

#include <optional>

namespace voxtact::app {

namespace {

/// The files of a chunk.
class ChunkParts {
  public:
    ChunkParts(const PlanOptions& options, const PlanInputs& inputs) : options_(options), inputs_(inputs) {}

    [[nodiscard]] Result<void> open(const ChunkFiles& files) {
        const io::Format format = options_.output.format();
        VOXTACT_TRY(addTable(files, "--output", "", format, rowsOf));
        if (format == io::Format::Json) {
            VOXTACT_TRY(addTable(files, "--output", kByTarget, format, targetTable));
        }
        if (!options_.byTarget.empty()) {
            VOXTACT_TRY(addTable(files, "--by-target", "", io::Format::Csv, targetTable));
        }
        for (TargetFile& file : targetFiles(options_, inputs_)) {
            VOXTACT_TRY(add(files, file.option, ""));
            parts_.back().write = std::move(file.write);
        }
        return {};
    }
    [[nodiscard]] Result<void> write(const TargetPlan& plan) {
        for (Part& part : parts_) {
            if (part.table) {
                part.writer->add(part.table(inputs_, {&plan, 1}));
                continue;
            }
            TextStream text;
            VOXTACT_TRY(part.write(text, plan));
            part.file.stream() << frameHead(text.view().size()) << text.view();
        }
        return {};
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
    using TableOf = io::Table (*)(const PlanInputs&, std::span<const TargetPlan>);
    /// A table, or a file for each target.
    struct Part {
        ResultFile file;
        std::optional<io::TableWriter> writer{};
        TableOf table = nullptr;
        decltype(TargetFile::write) write{};
    };
    static io::Table rowsOf(const PlanInputs& inputs, std::span<const TargetPlan> plans) {
        return planTable(inputs, plans, false);
    }
    [[nodiscard]] Result<void> add(const ChunkFiles& files, const std::string& option, const char* part) {
        Result<ResultFile> file = files.create(option, part);
        VOXTACT_TRY(file);
        parts_.push_back({std::move(*file)});
        return {};
    }
    [[nodiscard]] Result<void> addTable(const ChunkFiles& files, const char* option, const char* part,
                                        io::Format format, TableOf table) {
        VOXTACT_TRY(add(files, option, part));
        Part& added = parts_.back();
        added.table = table;
        added.writer.emplace(added.file.stream(), format).omitHead();
        return {};
    }

    const PlanOptions& options_;
    const PlanInputs& inputs_;
    std::vector<Part> parts_;
};

/// The rows, and behind them in JSON what is said of each target.
void addTables(const PlanOptions& options, const PlanInputs& inputs, std::vector<RunOutput>& outputs) {
    const io::Format format = options.output.format();
    outputs.push_back(tableOutput(format, planTable(inputs, {}, false)));
    if (format != io::Format::Json) {
        return;
    }
    TextStream head;
    io::TableWriter(head, format).beginArray(kByTarget);
    RunOutput& rows = outputs.back();
    RunOutput targets = rows;
    targets.head = head.str();
    targets.part = kByTarget;
    rows.tail.clear();
    outputs.push_back(std::move(targets));
}

std::vector<RunOutput> outputsOf(const PlanOptions& options, const PlanInputs& inputs) {
    std::vector<RunOutput> outputs;
    addTables(options, inputs, outputs);
    if (!options.byTarget.empty()) {
        outputs.push_back(tableOutput(io::Format::Csv, targetTable(inputs, {})));
        outputs.back().option = "--by-target";
    }
    for (const TargetFile& file : targetFiles(options, inputs)) {
        RunOutput output;
        output.option = file.option;
        output.ending = file.ending;
        output.targets = targetNames(inputs);
        outputs.push_back(std::move(output));
    }
    return outputs;
}

/// Where these go makes no other run; that they are asked for does, and in which format.
void addFiles(const PlanOptions& options, const PlanInputs& inputs, RunFacts& facts, MergePaths& paths) {
    if (!options.byTarget.empty()) {
        facts.emplace_back("--by-target", "asked for");
        paths.emplace_back("--by-target", options.byTarget);
    }
    for (const TargetFile& file : targetFiles(options, inputs)) {
        facts.emplace_back(file.option, "asked for as " + file.ending);
        paths.emplace_back(file.option, file.path);
    }
}

} // namespace

Result<void> checkPlanChunks(const PlanOptions& options) {
    constexpr const char* kAll = "it is about all of a plan at once";
    return checkChunkOptions(
        options.chunks, options.output,
        {{!options.picture.empty(), "--picture", kAll},
         {!options.report.empty(), "--report", kAll},
         {options.summary, "--summary", "no process need have all of the run; --by-target says the same"},
         {options.timing, "--timing", "its chunks are done at different times, perhaps by different machines"}});
}

Outcome runPlanChunks(const CLI::App& parser, const PlanOptions& options, const PlanInputs& inputs,
                      cpu::Planner& planner) {
    RunFacts facts = runFacts(parser, options.chunks, options.output, {"--by-target", "--surface", "--heat-map"});
    MergePaths paths{{"--output", options.output.path}};
    addFiles(options, inputs, facts, paths);
    VOXTACT_TRY(addInputFacts(facts, planReads(options)));
    ChunkedRun run{"voxtact plan",
                   options.chunks,
                   {std::move(facts), outputsOf(options, inputs), 0},
                   ChunkCut({inputs.targets.size()}, options.chunks.chunk()),
                   options.progress};
    const auto doTargets = [&](const ChunkRange& range, const ChunkFiles& files,
                               const std::function<void(std::uint64_t)>& progress) -> Result<void> {
        ChunkParts parts(options, inputs);
        VOXTACT_TRY(parts.open(files));
        for (std::uint64_t target = range.first; target < range.first + range.count; ++target) {
            const Result<TargetPlan> plan = planFor(inputs, target, planner);
            if (interrupted()) {
                return {};
            }
            VOXTACT_TRY(plan);
            VOXTACT_TRY(parts.write(*plan));
            progress(target - range.first + 1);
        }
        return parts.commit();
    };
    std::vector<std::string> notes = inputs.notes;
    Outcome outcome = doChunks(std::move(run), doTargets, paths, notes);
    for (const std::string& note : notes) {
        if (outcome.status == kExitDone) {
            printNote(note);
        }
    }
    return outcome;
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "app/detect/detect_chunks.h"

#include "app/chunks/run_chunks.h"
#include "app/detect/side_files.h"
#include "app/output/interrupt.h"
#include "core/base/try.h"
#include "core/method/method_table.h"

#include <algorithm>

namespace voxtact::app {

namespace {

std::uint64_t pairsOf(const PairRange& group, const DetectOptions& options, const DetectInputs& inputs) {
    std::uint64_t pairs = 0;
    for (std::uint32_t job = group.begin; job < group.end; ++job) {
        // Standard input, which would not say, is refused.
        pairs += inputs.poses[options.jobs.jobs[job].poses].count().value_or(0);
    }
    return pairs;
}

constexpr const char* kMethodFact = "method";

/// Who answers, as far as answers depend on that.
void addEngineFacts(RunFacts& facts, const PairEngine& engine) {
    const PairAnswer answer = engine.untouched();
    facts.emplace_back(kMethodFact, toString(answer.method));
    facts.emplace_back("projection", toString(answer.projection));
    if (!rowOf(answer.method).host) {
        facts.emplace_back("device", engine.device());
        facts.emplace_back("driver", engine.driver());
    }
}

} // namespace

Result<void> checkDetectChunks(const DetectOptions& options) {
    const bool standardInput =
        std::find(options.jobs.poses.begin(), options.jobs.poses.end(), "-") != options.jobs.poses.end();
    return checkChunkOptions(
        options.chunks, options.output,
        {{standardInput, "--poses -", "who goes on with the run reads the poses again; put them into a file"},
         {options.timing, "--timing", "its chunks are done at different times, perhaps by different machines"},
         {options.stats, "--stats", "it is about the work of one process"},
         {options.device.validate, "--validate", "its messages decide on a whole run; validate a short one without"},
         {!options.extra.contacts.empty(), "--contacts",
          "--most-contacts cuts the list of the whole run; ask for --triangles, or for contacts of the poses that "
          "touch"},
         {!options.distance.closest.empty() && options.distance.closest.extension() != ".csv", "--closest",
          "a .ply file says first how much it has; choose .csv"}});
}

Result<RunFacts> detectRunFacts(const CLI::App& parser, const DetectOptions& options,
                                const std::vector<NamedPath>& reads) {
    RunFacts asked;
    std::vector<std::string> without;
    for (const auto& [option, path] : sideFiles(options)) {
        // Where it goes makes no other run; that it is asked for does.
        without.push_back(option);
        if (!path.empty()) {
            asked.emplace_back(option, "asked for");
        }
    }
    RunFacts facts = runFacts(parser, options.chunks, options.output, std::move(without));
    facts.insert(facts.end(), asked.begin(), asked.end());
    VOXTACT_TRY(addInputFacts(facts, reads));
    return facts;
}

std::optional<CountingMethod> methodOfRun(const ChunkOptions& options) {
    const Result<RunFolder> folder = RunFolder::read(options.folder);
    if (!folder.ok()) {
        return std::nullopt; // it is new, or whoever opens it says what is wrong with it
    }
    const RunFacts& facts = folder->manifest().facts;
    const auto method = std::ranges::find(facts, kMethodFact, &RunFacts::value_type::first);
    return method == facts.end() ? std::nullopt : countingMethodFromName(method->second);
}

Outcome answerChunks(const DetectOptions& options, DetectInputs& inputs, RunFacts facts, PairEngine& engine,
                     std::vector<std::string>& notes) {
    addEngineFacts(facts, engine);
    const std::vector<PairRange> groups = volumeGroups(options.jobs);
    std::vector<std::uint64_t> rows;
    for (const PairRange& group : groups) {
        rows.push_back(pairsOf(group, options, inputs));
    }
    MergePaths paths{{"--output", options.output.path}};
    for (const auto& side : sideFiles(options)) {
        if (!side.second.empty()) {
            paths.push_back(side);
        }
    }
    PairAsker asker(options, inputs, engine);
    OpenBounds clearances; // of what this process does
    OpenBounds areas;
    OpenBounds labelAreas;
    const DoChunk doChunk = [&](const ChunkRange& range, const ChunkFiles& files,
                                const std::function<void(std::uint64_t)>& done) -> Result<void> {
        Result<DetectOutput> output = DetectOutput::createChunk(options, inputs, files);
        VOXTACT_TRY(output);
        PairRange pairs = groups[range.group];
        pairs.first = range.first;
        pairs.count = range.count;
        VOXTACT_TRY(asker.answer(pairs, *output, [&] { done(output->rows()); }));
        clearances.add(output->clearanceEnds());
        areas.add(output->areaEnds());
        labelAreas.add(output->labelAreaEnds());
        return interrupted() ? Result<void>() : output->finish(0);
    };
    ChunkedRun run{"voxtact detect",
                   options.chunks,
                   {std::move(facts), runOutputs(options, inputs, engine.device(), engine.driver()), 0},
                   ChunkCut(std::move(rows), options.chunks.chunk()),
                   options.progress};
    Outcome outcome = doChunks(std::move(run), doChunk, paths, notes);
    asker.addTo(notes);
    for (const OpenBounds& open : {clearances, areas, labelAreas}) {
        if (!open.note().empty()) {
            notes.push_back(open.note());
        }
    }
    return outcome;
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "app/chunks/run_chunks.h"
#include "app/commands.h"
#include "app/detect/side_files.h"
#include "app/output/target_path.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

constexpr const char* kMergeFooter =
    R"(DIR is the folder that detect, motion or plan filled with --resume, by one process or by all shards. What is written is
byte for byte what the same command writes without --resume. A file that is asked for in addition to the rows must be
one that the run was asked for. Chunks that are missing or damaged are said, and nothing is written; DIR stays as it is.

Examples:
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --resume run --shard 1/2
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --resume run --shard 2/2
  voxtact merge run --output rows.csv)";

/// A file in addition to the rows; an empty path: it is not asked for.
struct MergeFile {
    std::string option;
    std::string help;
    std::filesystem::path path;
};

/// All that the commands write in chunks in addition to the rows.
std::vector<MergeFile> filesOfRuns() {
    std::vector<MergeFile> files;
    for (const SideFileFacts& side : sideFileTable()) {
        const std::string ending = side.ending;
        files.push_back(
            {side.option,
             "a " + ending + (ending.empty() ? "" : " ") + "file for what detect " + side.option + " writes",
             {}});
    }
    files.push_back({"--by-target", "a file for what plan --by-target writes", {}});
    files.push_back(
        {"--surface", "a .ply file for what plan --surface writes; of several targets a path with {target}", {}});
    files.push_back({"--heat-map", "the same of plan --heat-map, with the ending it was asked for", {}});
    return files;
}

struct MergeOptions {
    std::filesystem::path folder;
    std::filesystem::path output;
    std::vector<MergeFile> files = filesOfRuns();
};

/// The files of an output: where each target has one, all of them.
std::vector<NamedPath> filesOf(const std::string& option, const std::filesystem::path& path, const RunOutput& output) {
    std::vector<NamedPath> files;
    if (output.targets.empty()) {
        files.push_back({option, path});
    }
    for (const std::string& target : output.targets) {
        files.push_back({option, targetPath(path, target)});
    }
    return files;
}

/// The paths that were given, for outputs that the run has.
Result<MergePaths> pathsOf(const MergeOptions& options, const RunFolder& folder) {
    MergePaths paths{{"--output", options.output}};
    std::vector<NamedPath> files{{"--output", options.output.empty() ? "-" : options.output}};
    for (const auto& [option, help, path] : options.files) {
        if (path.empty()) {
            continue;
        }
        const std::vector<const RunOutput*> found = folder.manifest().outputsOf(option);
        if (found.empty()) {
            return badArgument(option + ": the run in " + folderText(options.folder) +
                               " was not asked for it; leave it out");
        }
        const RunOutput& output = *found.front();
        if (!path.filename().string().ends_with(output.ending)) {
            return badArgument(option + ": the run has it as " + output.ending + ", which the ending of '" +
                               path.string() + "' must be");
        }
        VOXTACT_TRY(checkTargetPaths(option, path, output.targets));
        const std::vector<NamedPath> all = filesOf(option, path, output);
        files.insert(files.end(), all.begin(), all.end());
        paths.emplace_back(option, path);
    }
    // A folder with its files, none of which may be written over, nor what the run has read.
    std::vector<NamedPath> inputs = inputsOf(folder.manifest().facts);
    inputs.push_back({"DIR", options.folder});
    VOXTACT_TRY(checkOutputs(files, inputs));
    return paths;
}

Outcome runMerge(const MergeOptions& options) {
    const Result<RunFolder> folder = RunFolder::read(options.folder);
    VOXTACT_TRY(folder);
    const Result<MergePaths> paths = pathsOf(options, *folder);
    VOXTACT_TRY(paths);
    VOXTACT_TRY(mergeRun(*folder, *paths));
    return {};
}

} // namespace

Command addMerge(CLI::App& program) {
    auto options = std::make_shared<MergeOptions>();
    CLI::App* parser = program.add_subcommand("merge", "the output of a run that was done in chunks");
    parser->footer(kMergeFooter);
    parser->add_option("DIR", options->folder, "the folder of the run, as --resume named it")->required();
    addPath(*parser, "--output", options->output, "a file for the rows, or - for standard output, the default");
    for (MergeFile& file : options->files) {
        addPath(*parser, file.option.c_str(), file.path, file.help);
    }
    return {parser, [options] { return runMerge(*options); }};
}

} // namespace voxtact::app

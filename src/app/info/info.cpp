// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/info/info_table.h"
#include "app/options/inputs.h"
#include "app/options/output_paths.h"
#include "app/output/size_note.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

constexpr const char* kInfoFooter =
    R"(Volumes: size, spacing, the patient's sides towards which the index axes run (R or L, A or P, S or I), the world box
(mm, LPS), values with a histogram, and the share of the voxels whose opacity reaches the threshold. Meshes: triangles,
vertices, parts, the box, whether the surface is closed, and whether it looks as if it were in metres.

What a path holds is told by its ending; folders are DICOM series.

Examples:
  voxtact info head.nii.gz tool.stl
  voxtact info ct/ --opacity "300:0,400:1" --threshold 0.5
  voxtact info builtin:head:128 builtin:scalpel --format json)";

struct InfoOptions {
    std::vector<std::string> paths;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    OutputOptions output;
};

bool isMesh(const std::string& source) {
    std::string lowered = source;
    std::transform(lowered.begin(), lowered.end(), lowered.begin(),
                   [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    for (const char* builtin : {"builtin:scalpel", "builtin:ellipsoid", "builtin:needle"}) {
        if (lowered == builtin || lowered.starts_with(builtin + std::string(":"))) {
            return true;
        }
    }
    std::error_code ignored;
    const auto endings = {".stl", ".obj", ".ply", ".off", ".gltf", ".glb"};
    return !lowered.starts_with("builtin:") && !std::filesystem::is_directory(source, ignored) &&
           std::any_of(endings.begin(), endings.end(), [&](const char* ending) { return lowered.ends_with(ending); });
}

Result<PathInfo> meshAt(const InfoOptions& options, const std::string& source) {
    const Result<MeshData> mesh = loadMesh(source, options.meshes);
    VOXTACT_TRY(mesh);
    const Result<MeshFacts> facts = checkMesh(mesh->view());
    VOXTACT_TRY(facts);
    return PathInfo{source, {}, MeshInfo{*facts, closednessOf(mesh->view()), unitHint(facts->bounds)}};
}

Result<PathInfo> volumeAt(const InfoOptions& options, const std::vector<ControlPoint>& points,
                          const std::string& source) {
    const Result<VolumeData> volume = loadVolume(source);
    VOXTACT_TRY(volume);
    const Result<ValueRange> values = checkVolume(volume->view());
    VOXTACT_TRY(values);
    const TransferFunctionOptions& function = options.transferFunction;
    const ValueRange domain = tableDomain(function, volume->type, *values);
    const std::vector<ControlPoint> used = points.empty() ? defaultRamp(domain) : points;
    Result<VolumeInfo> info =
        volumeInfo(volume->view(), *values, {used, domain, function.tableSize}, function.threshold);
    VOXTACT_TRY(info);
    return PathInfo{source, std::move(*info), {}};
}

Result<void> checkPaths(const InfoOptions& options) {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    for (const std::string& path : options.paths) {
        if (path.empty()) {
            return badArgument("PATH: an empty value");
        }
        (isMesh(path) ? meshes.sources : volumes).push_back(path);
    }
    std::vector<NamedPath> inputs = inputPaths(volumes, meshes);
    for (NamedPath& input : inputs) {
        input.option = "PATH";
    }
    addInput(inputs, "--transfer-function", options.transferFunction.path);
    return checkOutputs({{"--output", options.output.path}}, inputs);
}

Outcome runInfo(const InfoOptions& options) {
    VOXTACT_TRY(checkPaths(options));
    const Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    std::vector<PathInfo> paths;
    for (const std::string& source : options.paths) {
        Result<PathInfo> info = isMesh(source) ? meshAt(options, source) : volumeAt(options, *points, source);
        VOXTACT_TRY(info);
        paths.push_back(std::move(*info));
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        if (options.output.format() == io::Format::Text) {
            writeInfoText(out, paths, options.transferFunction.threshold);
        } else {
            io::writeTable(out, options.output.format(), infoTable(paths));
        }
        return {};
    });
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace

Command addInfo(CLI::App& program) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* parser = program.add_subcommand("info", "what volume and mesh files hold");
    parser->footer(kInfoFooter);
    parser->add_option("PATH", options->paths, "volumes and meshes, as --volume and --mesh take them")
        ->type_name("...")
        ->required();
    addMeshOptions(*parser, options->meshes, false);
    parser->remove_option(parser->get_option("--mesh"));
    addTransferFunctionOptions(*parser, options->transferFunction);
    addOutputOptions(*parser, options->output);
    return {parser, [options] { return runInfo(*options); }};
}

} // namespace voxtact::app

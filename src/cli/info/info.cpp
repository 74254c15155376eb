// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/info/info_table.h"
#include "cli/options/inputs.h"
#include "cli/options/output_paths.h"
#include "cli/output/size_note.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iterator>

namespace voxtact::app {

namespace {

constexpr const char* kInfoFooter =
    R"(Volumes: size, spacing, orientation, world box (mm, LPS), values, histogram,
opaque share. Meshes: triangles, vertices, parts, box, closed or not, and a
suspicious unit. Each mesh against each volume: the share of its box inside, the
distance between the boxes, and an option that would move the mesh inside.
The file ending determines the kind; folders are DICOM series.

Examples:
  voxtact info head.nii.gz tool.stl
  voxtact info ct/ --opacity "300:0,400:1" --opacity-threshold 0.5
  voxtact info builtin:head:128 builtin:scalpel --format json)";

struct InfoOptions {
    std::vector<std::string> paths; ///< of volumes and meshes
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    OutputOptions output;
    bool resample = false;
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
    const auto endings = {".stl",  ".obj", ".ply",  ".off", ".vtk",  ".vtp",
                          ".gltf", ".glb", ".step", ".stp", ".iges", ".igs"};
    return !lowered.starts_with("builtin:") && !std::filesystem::is_directory(source, ignored) &&
           std::any_of(endings.begin(), endings.end(), [&](const char* ending) { return lowered.ends_with(ending); });
}

Result<PathInfo> meshAt(const InfoOptions& options, const std::string& source) {
    const Result<MeshData> mesh = loadMesh(source, options.meshes);
    VOXTACT_TRY(mesh);
    const Result<MeshFacts> facts = checkMesh(mesh->view());
    VOXTACT_TRY(facts);
    return PathInfo{source, {}, MeshInfo{*facts, closednessOf(mesh->view()), unitHint(facts->bounds)}, {}};
}

Result<PathInfo> volumeAt(const InfoOptions& options, const std::vector<ControlPoint>& points,
                          const std::string& source) {
    const Result<VolumeData> volume = loadVolume(source, {.resample = options.resample});
    VOXTACT_TRY(volume);
    const Result<ValueRange> values = checkVolume(volume->view());
    VOXTACT_TRY(values);
    const TransferFunctionOptions& function = options.transferFunction;
    const ValueRange domain = tableDomain(function, volume->type, *values);
    const std::vector<ControlPoint> used = points.empty() ? defaultRamp(domain) : points;
    VOXTACT_TRY(checkOpacity({used, domain}, *values, function.threshold));
    return PathInfo{
        source, volumeInfo(volume->view(), *values, used, function.threshold, io::wasResampled(*volume)), {}, {}};
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
    const std::vector<NamedPath> named = inputPaths(options.volumes, options.meshes);
    inputs.insert(inputs.end(), named.begin(), named.end());
    if (options.paths.empty() && options.volumes.empty() && options.meshes.sources.empty()) {
        return badArgument("PATH: name a volume or mesh; see voxtact info --help");
    }
    addInput(inputs, "--transfer-function", options.transferFunction.path);
    return checkOutputs({{"--output", options.output.path}}, inputs);
}

/// Returns the placement of each mesh relative to each volume.
std::vector<PathInfo> pairsOf(const InfoOptions& options, const std::vector<PathInfo>& paths) {
    const Mat4 pose = identity();
    std::vector<PathInfo> pairs;
    for (const PathInfo& mesh : paths) {
        for (const PathInfo& volume : paths) {
            if (mesh.mesh && volume.volume) {
                const ReadMesh read{mesh.path, options.meshes, mesh.mesh->facts.bounds, {&pose, 1}};
                const Grid& grid = volume.volume->grid;
                pairs.push_back(
                    {mesh.path, {}, {}, PairInfo{volume.path, placementOf(read, grid), otherReadings(read, grid)}});
            }
        }
    }
    return pairs;
}

Outcome runInfo(const InfoOptions& options) {
    VOXTACT_TRY(checkPaths(options));
    const Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    std::vector<PathInfo> paths;
    const auto add = [&](const std::string& source, bool mesh) -> Result<void> {
        Result<PathInfo> info = mesh ? meshAt(options, source) : volumeAt(options, *points, source);
        VOXTACT_TRY(info);
        paths.push_back(std::move(*info));
        return {};
    };
    for (const std::string& source : options.paths) {
        VOXTACT_TRY(add(source, isMesh(source)));
    }
    for (const std::string& source : options.volumes) {
        VOXTACT_TRY(add(source, false));
    }
    for (const std::string& source : options.meshes.sources) {
        VOXTACT_TRY(add(source, true));
    }
    std::ranges::move(pairsOf(options, paths), std::back_inserter(paths));
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
    CLI::App* parser = program.add_subcommand("info", "describe volume and mesh files");
    parser->footer(kInfoFooter);
    parser->add_option("PATH", options->paths, "volumes and meshes, as for --volume and --mesh")->type_name("...");
    addVolumeOption(*parser, options->volumes);
    addResampleOption(*parser, options->resample);
    parser->get_option("--volume")->required(false);
    addMeshOptions(*parser, options->meshes, false);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addTableOptions(*parser, options->transferFunction);
    addOutputOptions(*parser, options->output);
    return {parser, [options] { return runInfo(*options); }};
}

} // namespace voxtact::app

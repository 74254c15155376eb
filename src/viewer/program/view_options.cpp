// SPDX-License-Identifier: MIT
#include "viewer/program/view_options.h"

#include "cli/options/inputs.h"
#include "cli/options/output_paths.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "viewer/model/files/session_file.h"
#include "viewer/model/files/source_paths.h"
#include "voxtact/io.h"
#include "voxtact/looks.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

constexpr const char* kViewFooter =
    R"(Shows the volume, the meshes and three slices. Tests for touch after each
change. F1 shows keys and mouse. Default: the builtin head and scalpel.
Needs an X11 display and a Vulkan driver. --device cpu answers on the host.

Examples:
  voxtact view
  voxtact view --volume head.nii.gz --preset mr --mesh tool.stl
  voxtact view --session session.json)";

std::vector<const char*> curvePresetNames() {
    std::vector<const char*> names;
    for (const LookPreset& preset : lookPresets()) {
        names.push_back(preset.name);
    }
    return names;
}

/// Returns the requested method, or the host for --device cpu.
std::optional<view::MethodChoice> methodOf(const ViewerOptions& options) {
    const MethodOptions& method = options.method;
    if (options.device.wanted == "cpu") {
        return view::MethodChoice{CountingMethod::Cpu, method.projection.value_or(Projection::Certified)};
    }
    if (!method.count && !method.projection) {
        return std::nullopt;
    }
    const CountingMethod count = method.count.value_or(CountingMethod::Cpu);
    const Projection standard = rowOf(count).certified ? Projection::Certified : Projection::View;
    return view::MethodChoice{count, method.projection.value_or(standard)};
}

Result<view::Document> documentOf(const ViewerOptions& options, ScalarType type, const ValueRange& values) {
    view::Document document;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    document.domain = tableDomain(options.transferFunction, type, values);
    document.tableSize = options.transferFunction.tableSize.value_or(kDefaultTableSize);
    document.edit.threshold = options.transferFunction.threshold;
    Result<Look> look =
        options.preset.empty() ? Look{defaultRamp(document.domain), plainColours()} : lookNamed(options.preset, values);
    VOXTACT_TRY(look);
    document.edit.curve = points->empty() ? look->opacity : *points;
    document.edit.colours = look->colours;
    if (!options.transferFunction.path.empty()) {
        const Result<std::vector<ColourPoint>> colours = io::readColours(options.transferFunction.path);
        VOXTACT_TRY(colours);
        document.edit.colours = colours->empty() ? document.edit.colours : *colours;
    }
    if (!options.poses.empty()) {
        const Result<std::vector<Mat4>> poses = loadPoses({.poses = options.poses});
        VOXTACT_TRY(poses);
        document.poses = *poses;
        document.edit.pose() = poses->front();
    }
    document.method = methodOf(options);
    return document;
}

Result<void> checkSize(const VkExtent2D& size) {
    constexpr std::uint32_t kMost = 16384;
    const auto text = [](std::uint32_t width, std::uint32_t height) {
        return std::to_string(width) + "x" + std::to_string(height);
    };
    const view::Extent& least = view::kLeastWindow;
    if (size.width < least.width || size.height < least.height || size.width > kMost || size.height > kMost) {
        return badArgument("--size " + text(size.width, size.height) + ": a window needs " +
                           text(least.width, least.height) + " to " + text(kMost, kMost) + " points");
    }
    return {};
}

std::string nameOf(const std::string& source) {
    const std::string name = std::filesystem::path(source).filename().string();
    return name.empty() ? source : name;
}

/// The files of a document.
Result<void> load(const view::Sources& sources, Opened& opened, view::Progress& progress) {
    VOXTACT_TRY(progress.begin("reading " + nameOf(sources.volume)));
    const auto tell = [&progress](std::uint64_t done, std::uint64_t all) {
        return progress.tell(all == 0 ? 1 : static_cast<double>(done) / static_cast<double>(all));
    };
    Result<VolumeData> volume = loadVolume(sources.volume, {.progress = tell});
    VOXTACT_TRY(volume);
    const Result<ValueRange> values = checkVolume(volume->view());
    VOXTACT_TRY(values);
    for (const view::MeshSource& source : sources.meshes) {
        VOXTACT_TRY(progress.begin("reading " + nameOf(source.path)));
        const std::string space = source.space == "lps" ? "" : source.space; // or what the file says
        Result<MeshData> mesh = loadMesh(source.path, {.sources = {}, .space = space, .scale = source.scale});
        VOXTACT_TRY(mesh);
        opened.meshes.push_back(std::move(*mesh));
    }
    if (!sources.labels.empty()) {
        VOXTACT_TRY(progress.begin("reading " + nameOf(sources.labels)));
        Result<NamedLabels> named =
            loadNamedLabels(sources.labels, sources.labelNames, [&] { return Result<Grid>(volume->grid); });
        VOXTACT_TRY(named);
        opened.labels = view::Labels{std::move(named->labels), std::move(named->names)};
        opened.read.push_back(labelNamesPath(sources.labelNames, sources.labels).string());
    }
    opened.volume = std::move(*volume);
    opened.values = *values;
    return {};
}

/// Returns a session and its files; empty if it is unreadable.
void addSessionPaths(std::vector<NamedPath>& paths, const std::filesystem::path& session) {
    constexpr const char* kOption = "--session";
    addInput(paths, kOption, session);
    Result<view::Document> document = view::readSession(session);
    if (!document.ok()) {
        return;
    }
    view::Sources& sources = document->sources;
    for (const view::SourceMember& member : view::membersOf(sources)) {
        addInput(paths, kOption, *member.path);
    }
    if (!sources.labels.empty()) {
        addInput(paths, kOption, labelNamesPath(sources.labelNames, sources.labels));
    }
}

} // namespace

void addViewerOptions(CLI::App& parser, ViewerOptions& options) {
    parser.footer(kViewFooter);
    addVolumeOption(parser, options.volumes);
    parser.get_option("--volume")->required(false);
    addMeshOptions(parser, options.meshes, false);
    addPath(parser, "--poses", options.poses, "4x4 matrices, 16 numbers per line; default: identity");
    addTransferFunctionOptions(parser, options.transferFunction);
    addTableOptions(parser, options.transferFunction);
    addName(parser, "--preset", options.preset, curvePresetNames(),
            "colours and default opacity, as for voxtact render");
    addPath(parser, "--labels", options.labels, "label map, for the names of touched structures");
    addPath(parser, "--label-names", options.labelNames,
            "lines 'number name'; default: the label map's path with .txt");
    addMethodOptions(parser, options.method);
    for (const char* fixed : {"--samples-per-voxel", "--resolution", "--filter", "--boundary"}) {
        parser.remove_option(parser.get_option(fixed));
    }
    addDeviceOptions(parser, options.device);
    addPath(parser, "--session", options.session, "session file that the window saved");
    for (const char* other :
         {"--volume", "--mesh", "--mesh-space", "--mesh-scale", "--poses", "--transfer-function", "--opacity",
          "--tf-domain", "--tf-size", "--opacity-threshold", "--preset", "--labels", "--label-names"}) {
        parser.get_option("--session")->excludes(parser.get_option(other));
    }
    addPath(parser, "--report-state", options.reportState,
            "JSON file, rewritten after each answer: touch, count, method, projection, pose, labels, command");
    addWholeNumber(
        parser, "--frames", [&options](std::uint32_t frames) { options.frames = frames; }, {.least = 1},
        "exit after N frames; 0: never", 0);
    addWholeNumber(
        parser, "--volume-side", [&options](std::uint32_t side) { options.maxSide = side; }, {.least = 2},
        "maximum voxels along a side; larger volumes: offer a coarser copy; 0: the device's limit", 0);
    addSize(
        parser, [&options](const VkExtent2D& size) { options.size = size; }, "window size, points",
        std::to_string(options.size.width) + "x" + std::to_string(options.size.height));
    for (const char* rare : {"--label-names", "--report-state", "--frames", "--volume-side"}) {
        setRare(parser, rare);
    }
}

Result<void> checkViewerOptions(const ViewerOptions& options) {
    if (options.volumes.size() > 1) {
        return badArgument("--volume: the window shows only one; leave out the others");
    }
    if (options.device.wanted == "cpu" && options.method.count.value_or(CountingMethod::Cpu) != CountingMethod::Cpu) {
        return badArgument(std::string("--method ") + toString(*options.method.count) +
                           ": --device cpu answers by the method cpu; leave out one of the two");
    }
    const view::MethodChoice method = methodOf(options).value_or(view::MethodChoice{});
    if (rowOf(method.projection).certified && !rowOf(method.count).certified) {
        return badArgument(std::string("--method ") + toString(method.count) +
                           ": only compute and cpu support the projection certified; choose another "
                           "--projection");
    }
    VOXTACT_TRY(checkSize(options.size));
    if (options.labels.empty() && !options.labelNames.empty()) {
        return badArgument("--label-names: it needs a label map; add --labels");
    }
    ViewOptions inputs;
    inputs.poses = options.poses;
    auto paths = inputPaths(options.volumes, options.meshes, options.transferFunction, inputs);
    if (!options.labels.empty()) {
        paths.push_back({"--labels", options.labels});
        paths.push_back({"--label-names", labelNamesPath(options.labelNames, options.labels)});
    }
    if (options.reportState == "-") {
        return badArgument("--report-state: '-' is not a file that can be rewritten; give a path");
    }
    if (!options.session.empty() && !options.reportState.empty()) {
        addSessionPaths(paths, options.session);
    }
    return checkOutputs({{"--report-state", options.reportState}}, paths);
}

Result<void> checkWindowOutput(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
    std::vector<NamedPath> read;
    for (const std::string& input : inputs) {
        addInput(read, "the window", input);
    }
    return checkOutputs({{"Save", output}}, read);
}

Result<view::Document> sessionOf(const ViewerOptions& options) {
    Result<view::Document> document = view::readSession(options.session);
    VOXTACT_TRY(document);
    if (options.method.count || options.method.projection || options.device.wanted == "cpu") {
        document->method = methodOf(options);
    }
    return document;
}

Result<Opened> openDocument(const ViewerOptions& options, view::Progress& progress) {
    Opened opened;
    if (!options.session.empty()) {
        Result<view::Document> document = sessionOf(options);
        VOXTACT_TRY(document);
        opened.document = std::move(*document);
        VOXTACT_TRY(load(opened.document.sources, opened, progress));
        return opened;
    }
    view::Sources sources;
    sources.volume = options.volumes.empty() ? "builtin:head" : options.volumes.front();
    const std::string space = options.meshes.space.empty() ? "lps" : options.meshes.space;
    for (const std::string& mesh : options.meshes.sources) {
        sources.meshes.push_back({mesh, space, options.meshes.scale});
    }
    if (sources.meshes.empty()) {
        sources.meshes.push_back({"builtin:scalpel", space, options.meshes.scale});
    }
    sources.labels = options.labels.string();
    sources.labelNames = options.labelNames.string();
    VOXTACT_TRY(load(sources, opened, progress));
    Result<view::Document> document = documentOf(options, opened.volume.type, opened.values);
    VOXTACT_TRY(document);
    opened.document = std::move(*document);
    opened.document.sources = sources;
    opened.read.push_back(options.poses.string());
    opened.read.push_back(options.transferFunction.path.string());
    for (std::size_t mesh = 1; mesh < sources.meshes.size(); ++mesh) {
        opened.document.edit.instruments.push_back({mesh, opened.document.edit.pose(), true});
    }
    return opened;
}

Result<Opened> openWanted(const view::Wanted& wanted, view::Progress& progress) {
    Opened opened;
    opened.document = wanted.document;
    view::Sources& sources = opened.document.sources;
    if (sources.meshes.empty()) { // a volume was opened without other contents
        sources.meshes.push_back({"builtin:scalpel", "lps", 1});
    }
    VOXTACT_TRY(load(sources, opened, progress));
    if (wanted.kind == view::FileKind::Volume) {
        opened.document.domain = tableDomain({}, opened.volume.type, opened.values);
        opened.document.edit.curve = defaultRamp(opened.document.domain);
        opened.document.edit.colours = plainColours();
    }
    return opened;
}

} // namespace voxtact::app

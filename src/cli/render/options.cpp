// SPDX-License-Identifier: MIT
#include "cli/render/options.h"

#include "cli/options/output_paths.h"
#include "cli/render/annotation.h"
#include "core/base/try.h"
#include "voxtact/looks.h"

#include <CLI/CLI.hpp>

#include <charconv>

namespace voxtact::app {

namespace {

constexpr const char* kRenderFooter =
    R"(Opacities apply to 1 mm of material. --show uses the picture's opacity. It tests
contacts and discarded per pixel; triangles are certified.

Examples:
  voxtact render --volume head.nii.gz --preset mr -o head.png
  voxtact render --volume head.nii.gz --preset mr --mesh tool.stl \
      --show contacts --azimuth 40 -o contacts.png
  voxtact render --volume head.nii.gz --mesh tool.stl --slice axial -o axial.png)";

std::optional<std::uint32_t> wholeNumber(std::string_view text) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// Parses "3", "0,2,5-9" or "all".
std::optional<PoseChoice> parsePoses(std::string_view text) {
    PoseChoice choice;
    if (text == "all") {
        choice.all = true;
        return choice;
    }
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view part = text.substr(0, comma);
        const std::size_t dash = part.find('-');
        const auto first = wholeNumber(part.substr(0, dash));
        const auto last = dash == std::string_view::npos ? first : wholeNumber(part.substr(dash + 1));
        if (!first || !last || *first > *last) {
            return std::nullopt;
        }
        choice.ranges.emplace_back(*first, *last);
        if (comma == std::string_view::npos) {
            return choice;
        }
        text.remove_prefix(comma + 1);
    }
}

void addPoseOption(CLI::App& parser, RenderOptions& options) {
    addText(
        parser, "--pose",
        [&options](const std::string& text) -> std::optional<std::string> {
            options.poses = parsePoses(text);
            return options.poses ? std::nullopt : std::optional<std::string>("is neither all nor a list like 0,3,5-9");
        },
        "indices in --poses, like 0,3,5-9, or all; default: 0", "LIST");
}

std::vector<const char*> presetNames() {
    std::vector<const char*> names;
    for (const LookPreset& preset : lookPresets()) {
        names.push_back(preset.name);
    }
    return names;
}

void addLookOptions(CLI::App& parser, RenderOptions& options) {
    addName(parser, "--preset", options.preset, presetNames(),
            "colours and default opacity: mr, mr-skin, mr-brain, ct, ct-bone, ct-soft, ct-vessels, ct-lung");
    addName(parser, "--lighting", options.lighting, {"soft", "eye", "none"}, "soft, eye or none; default: soft");
    addColour(parser, "--background", options.background, "background colour; default: 000000");
    addTexts(
        parser, "--mesh-colour",
        [&options](const std::string& text) -> std::optional<std::string> {
            const auto colour = parseColour(text);
            if (!colour) {
                return "is not a colour RRGGBB, six hexadecimal digits";
            }
            options.meshColours.push_back(*colour);
            return std::nullopt;
        },
        "colour of a mesh; repeatable, in the order of --mesh", "RRGGBB");
}

void addCutOptions(CLI::App& parser, RenderOptions& options) {
    addTexts(
        parser, "--clip",
        [&options](const std::string& text) {
            ClipOption clip;
            std::optional<std::string> wrong = parseClip(text, clip);
            options.clips.push_back(std::move(clip));
            return wrong;
        },
        "cut the volume: left, right, front, back, top, bottom (MM in LPS), near, or NX,NY,NZ,D; up to 6 times",
        "SIDE[:MM]");
    parser.add_flag("--clip-mesh", options.clipMesh, "apply --clip to meshes, too");
    parser.get_option("--clip-mesh")->needs("--clip");
    addText(
        parser, "--slice", [&options](const std::string& text) { return parseSlice(text, options.slice.emplace()); },
        "gray slice instead of the volume: axial, coronal, sagittal or view, at MM; default: through the mesh",
        "NAME[:MM]");
    addText(
        parser, "--window",
        [&options](const std::string& text) -> std::optional<std::string> {
            options.window = parseRange(text);
            return options.window ? std::nullopt
                                  : std::optional<std::string>("is not LO:HI, two numbers with LO below HI");
        },
        "values of black and white in a slice", "LO:HI");
    parser.get_option("--window")->needs("--slice");
    for (const char* other : {"--clip", "--camera", "--lighting", "--through"}) {
        parser.get_option("--slice")->excludes(parser.get_option(other));
    }
}

void addAnnotationOptions(CLI::App& parser, RenderOptions& options) {
    parser.add_flag_callback(
        "--annotate", [&options] { options.annotate = true; },
        "add title, sides, scale and legend; default: if at least 320x320");
    parser.add_flag_callback(
        "--no-annotate", [&options] { options.annotate = false; }, "omit title, sides, scale and legend");
    parser.get_option("--no-annotate")->excludes("--annotate");
    parser.add_option("--title", options.title, "title; default: the volume and the view")
        ->type_name("TEXT")
        ->excludes("--no-annotate");
}

Result<void> checkViewpoint(const RenderOptions& options) {
    const bool turned = options.azimuth || options.elevation;
    if (!options.view.camera.empty() && (turned || !options.viewName.empty())) {
        return badArgument("--camera sets the eye; leave out --view, --azimuth and --elevation");
    }
    if (turned && !options.viewName.empty()) {
        return badArgument("--view sets the eye; leave out --azimuth and --elevation");
    }
    if (options.slice && options.slice->name != "view" && (turned || !options.viewName.empty())) {
        return badArgument("--slice " + options.slice->text +
                           " sets the eye; leave out --view, --azimuth and --elevation, or use --slice view");
    }
    return {};
}

} // namespace

void addRenderOptions(CLI::App& parser, RenderOptions& options) {
    parser.footer(kRenderFooter);
    addVolumeOption(parser, options.volumes);
    addResampleOption(parser, options.resample);
    addMeshOptions(parser, options.meshes, false);
    addTransferFunctionOptions(parser, options.transferFunction);
    addTableOptions(parser, options.transferFunction);
    addPosesOptions(parser, options.view);
    addCameraOptions(parser, options.view);
    addPoseOption(parser, options);
    addName(parser, "--view", options.viewName, {"front", "back", "left", "right", "top", "bottom"},
            "front, back, left, right, top, bottom; default: front");
    addDegrees(parser, "--azimuth", options.azimuth, "azimuth of the eye: 0 front, 90 left, 180 back");
    addDegrees(parser, "--elevation", options.elevation, "elevation of the eye: 90 top, -90 bottom");
    addLookOptions(parser, options);
    addShowOptions(parser, options.show);
    addCutOptions(parser, options);
    addAnnotationOptions(parser, options);
    addDeviceOptions(parser, options.device);
    addProgressOption(parser, options.progress);
    addPath(parser, "-o,--output", options.output, "PNG file");
    parser.get_option("--output")->required();
    for (const char* rare : {"--camera", "--lighting", "--background", "--through", "--clip-mesh", "--window",
                             "--annotate", "--no-annotate", "--title", "--mesh-colour"}) {
        setRare(parser, rare);
    }
}

Result<void> checkRenderOptions(const RenderOptions& options) {
    if (options.volumes.size() != 1) {
        return badArgument("--volume: a picture needs exactly one; leave out the others");
    }
    if (options.output.extension() != ".png" && options.output.extension() != ".PNG") {
        return badArgument("--output: the ending of '" + options.output.string() + "' must be .png");
    }
    VOXTACT_TRY(checkViewpoint(options));
    VOXTACT_TRY(checkShowOptions(options.show));
    if (options.meshes.sources.empty() && (!options.view.poses.empty() || options.poses)) {
        return badArgument("--poses and --pose need a mesh; add --mesh");
    }
    if (options.meshes.sources.empty() && !options.meshColours.empty()) {
        return badArgument("--mesh-colour needs a mesh; add --mesh");
    }
    if (options.slice && options.device.validate) {
        return badArgument("--validate: a slice uses no Vulkan; leave out --validate");
    }
    if (options.meshColours.size() > std::max<std::size_t>(options.meshes.sources.size(), 1)) {
        return badArgument("--mesh-colour is given " + std::to_string(options.meshColours.size()) + " times, --mesh " +
                           std::to_string(options.meshes.sources.size()) + " times");
    }
    if (options.clips.size() > kMaxClipPlanes) {
        return badArgument("--clip is given " + std::to_string(options.clips.size()) + " times; the maximum is " +
                           std::to_string(kMaxClipPlanes));
    }
    return checkOutputs({{"--output", options.output}},
                        inputPaths(options.volumes, options.meshes, options.transferFunction, options.view));
}

std::vector<std::string> unusedNotes(const RenderOptions& options, bool annotated) {
    std::vector<std::string> notes;
    if (options.slice && !options.device.wanted.empty()) {
        notes.emplace_back("--device is not used: a slice needs no device");
    }
    const TransferFunctionOptions& function = options.transferFunction;
    if (options.slice && options.show.what.empty() && (function.opacity || !function.path.empty() || function.domain)) {
        notes.emplace_back("--opacity, --transfer-function and --tf-domain are not used: a slice without --show "
                           "shows gray values");
    }
    if (!options.title.empty() && !annotated) {
        notes.emplace_back("--title is not used: pictures below 320x320 have no text; add --annotate");
    }
    return notes;
}

Result<std::vector<std::uint32_t>> chosenPoses(const std::optional<PoseChoice>& choice, std::size_t poses) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges{{0, 0}};
    if (choice && choice->all) {
        ranges = {{0, static_cast<std::uint32_t>(poses - 1)}};
    } else if (choice) {
        ranges = choice->ranges;
    }
    std::vector<std::uint32_t> numbers;
    for (const auto& [first, last] : ranges) {
        if (last >= poses) {
            return badArgument("--pose " + std::to_string(last) + ": the poses are numbered from 0 to " +
                               std::to_string(poses - 1));
        }
        for (std::uint32_t pose = first; pose <= last; ++pose) {
            numbers.push_back(pose);
        }
    }
    return numbers;
}

bool isAnnotated(const RenderOptions& options) {
    const VkExtent2D& size = options.view.size;
    return options.annotate.value_or(size.width >= kAnnotatedFrom && size.height >= kAnnotatedFrom);
}

ViewDirection directionOf(const RenderOptions& options) {
    const ViewDirection asked{options.azimuth.value_or(0), options.elevation.value_or(0)};
    return directionNamed(options.viewName).value_or(asked);
}

} // namespace voxtact::app

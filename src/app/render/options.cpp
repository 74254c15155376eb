// SPDX-License-Identifier: MIT
#include "app/render/options.h"

#include "app/options/output_paths.h"
#include "app/render/annotation.h"
#include "core/base/try.h"
#include "voxtact/looks.h"

#include <CLI/CLI.hpp>

#include <charconv>

namespace voxtact::app {

namespace {

constexpr const char* kRenderFooter =
    R"(A PNG of the volume by ray casting, and of the mesh, solid, at its depth in it. Opacities are for a millimetre of
material: 0.5 lets half of the light through a millimetre.

The eye, where no --camera is given: --view front (before the face), back, left (beside the left ear), right, top,
bottom; or --azimuth (0 front, 90 left, 180 back) and --elevation (90 top). The picture frames the volume.

--clip takes a side of the volume away; --slice shows a gray plane of it instead, and where it cuts the mesh. Axial
slices are seen from the feet, coronal ones from the face, sagittal ones from the left.

--show paints on the mesh what is decided with the picture's transfer function and --threshold, as voxtact detect does:
contacts and discarded pixel by pixel, by the projection view with this camera and size; triangles by the projection
conservative. What is painted shines through the tissue before it: --through.

From 320x320 pixels on a picture says what it shows: title, letters of the patient's sides (L left, R right, A anterior,
P posterior, S superior, I inferior) and a cube of them, a bar of millimetres, and what the colours mean.

Examples:
  voxtact render --volume head.nii.gz --preset mr --output head.png
  voxtact render --volume head.nii.gz --preset mr --mesh tool.stl --poses poses.txt --pose 3 --view left --output hit.png
  voxtact render --volume head.nii.gz --preset mr --mesh tool.stl --show contacts --azimuth 40 --output contacts.png
  voxtact render --volume head.nii.gz --preset mr-brain --clip left:10 --view left --output cut.png
  voxtact render --volume head.nii.gz --mesh tool.stl --slice axial --show contacts --output axial.png
  voxtact render --volume builtin:ct:128 --preset ct --azimuth 30 --elevation 20 --size 1024x1024 --output ct.png)";

std::optional<std::uint32_t> wholeNumber(std::string_view text) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// "3", "0,2,5-9" or "all".
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
            return options.poses ? std::nullopt
                                 : std::optional<std::string>("is not all, nor numbers and ranges like 0,3,5-9");
        },
        "which of --poses, from 0: a number, several like 0,3,5-9, or all; default: 0", "LIST");
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
            "colours, and the opacity where none is given: mr, mr-skin, mr-brain (fractions of the image's range), ct, "
            "ct-bone, ct-soft, ct-vessels, ct-lung (Hounsfield units)");
    addName(parser, "--lighting", options.lighting, {"soft", "eye", "none"},
            "soft (from the eye and from above its left, darker where it is shut in; default), eye, none (the colours "
            "as they are)");
    addColour(parser, "--background", options.background, "default: 000000");
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
        "of the first mesh, again for the second and so on; default: bfc7d1 and others", "RRGGBB");
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
        "takes a side of the volume away: left, right, front, back, top or bottom of a plane at MM of the world's x, y "
        "or z (LPS; default: the middle), near (what is nearer to the eye than MM before the middle), or NX,NY,NZ,D "
        "(where NX x + NY y + NZ z > D); up to 6 times",
        "SIDE[:MM]");
    parser.add_flag("--clip-mesh", options.clipMesh, "--clip takes the same of meshes away");
    parser.get_option("--clip-mesh")->needs("--clip");
    addText(
        parser, "--slice", [&options](const std::string& text) { return parseSlice(text, options.slice.emplace()); },
        "a gray plane instead of the volume: axial at MM of the world's z, coronal at y, sagittal at x, or view (at "
        "right angles to the view, MM before the volume's middle); default: through the mesh, else the middle",
        "NAME[:MM]");
    addText(
        parser, "--window",
        [&options](const std::string& text) -> std::optional<std::string> {
            options.window = parseRange(text);
            return options.window ? std::nullopt
                                  : std::optional<std::string>("is not LO:HI, two numbers with LO below HI");
        },
        "of a slice: the values that are black and white; default: that of the preset, else of nearly all voxels",
        "LO:HI");
    parser.get_option("--window")->needs("--slice");
    for (const char* other : {"--clip", "--camera", "--lighting", "--through"}) {
        parser.get_option("--slice")->excludes(parser.get_option(other));
    }
}

void addAnnotationOptions(CLI::App& parser, RenderOptions& options) {
    parser.add_flag_callback(
        "--annotate", [&options] { options.annotate = true; },
        "title, sides, bar and legend also on a small picture, as far as there is room; default: from 320x320 on");
    parser.add_flag_callback(
        "--no-annotate", [&options] { options.annotate = false; }, "nothing is written on the picture");
    parser.get_option("--no-annotate")->excludes("--annotate");
    parser.add_option("--title", options.title, "what the picture is called; default: the volume and the view")
        ->type_name("TEXT")
        ->excludes("--no-annotate");
}

Result<void> checkViewpoint(const RenderOptions& options) {
    const bool turned = options.azimuth || options.elevation;
    if (!options.view.camera.empty() && (turned || !options.viewName.empty())) {
        return badArgument("--camera says where the eye is; leave out --view, --azimuth and --elevation");
    }
    if (turned && !options.viewName.empty()) {
        return badArgument("--view says where the eye is; leave out --azimuth and --elevation");
    }
    if (options.slice && options.slice->name != "view" && (turned || !options.viewName.empty())) {
        return badArgument("--slice " + options.slice->text +
                           " says where the eye is; leave out --view, --azimuth and --elevation, or ask for view");
    }
    return {};
}

} // namespace

void addRenderOptions(CLI::App& parser, RenderOptions& options) {
    parser.footer(kRenderFooter);
    addVolumeOption(parser, options.volumes);
    addMeshOptions(parser, options.meshes, false);
    addTransferFunctionOptions(parser, options.transferFunction, true);
    addViewOptions(parser, options.view);
    addPoseOption(parser, options);
    addName(parser, "--view", options.viewName, {"front", "back", "left", "right", "top", "bottom"},
            "from where the eye looks: front, back, left, right, top, bottom; default: front");
    addDegrees(parser, "--azimuth", options.azimuth, "the eye's way round the volume: 0 front, 90 left, 180 back");
    addDegrees(parser, "--elevation", options.elevation, "the eye's height: 90 top, -90 bottom");
    addLookOptions(parser, options);
    addShowOptions(parser, options.show);
    addCutOptions(parser, options);
    addAnnotationOptions(parser, options);
    addDeviceOptions(parser, options.device);
    addProgressOption(parser, options.progress);
    addPath(parser, "--output", options.output, "the PNG file to write");
    parser.get_option("--output")->required();
}

Result<void> checkRenderOptions(const RenderOptions& options) {
    if (options.volumes.size() != 1) {
        return badArgument("one --volume is needed, not several");
    }
    if (options.output.extension() != ".png" && options.output.extension() != ".PNG") {
        return badArgument("--output " + options.output.string() + ": the ending of a picture is .png");
    }
    VOXTACT_TRY(checkViewpoint(options));
    VOXTACT_TRY(checkShowOptions(options.show));
    if (options.meshes.sources.empty() && (!options.view.poses.empty() || options.poses)) {
        return badArgument("--poses and --pose are for a mesh; --mesh is missing");
    }
    if (options.meshes.sources.empty() && !options.meshColours.empty()) {
        return badArgument("--mesh-colour is for a mesh; --mesh is missing");
    }
    if (options.slice && options.device.validate) {
        return badArgument("--validate: a slice is drawn without Vulkan, there is nothing to validate; leave it out");
    }
    if (options.meshColours.size() > std::max<std::size_t>(options.meshes.sources.size(), 1)) {
        return badArgument("--mesh-colour is given " + std::to_string(options.meshColours.size()) + " times, --mesh " +
                           std::to_string(options.meshes.sources.size()) + " times");
    }
    if (options.clips.size() > kMostClipPlanes) {
        return badArgument("--clip is given " + std::to_string(options.clips.size()) + " times, the most is " +
                           std::to_string(kMostClipPlanes));
    }
    return checkOutputs({{"--output", options.output}},
                        inputPaths(options.volumes, options.meshes, options.transferFunction, options.view));
}

std::vector<std::string> unusedNotes(const RenderOptions& options, bool annotated) {
    std::vector<std::string> notes;
    if (options.slice && !options.device.wanted.empty()) {
        notes.emplace_back("--device: a slice is drawn without one");
    }
    const TransferFunctionOptions& function = options.transferFunction;
    if (options.slice && options.show.what.empty() && (function.opacity || !function.path.empty() || function.domain)) {
        notes.emplace_back("--opacity, --transfer-function, --tf-domain: a slice without --show has gray values, "
                           "whatever is opaque; they are not used");
    }
    if (!options.title.empty() && !annotated) {
        notes.emplace_back("--title: it is written from 320x320 on, or with --annotate");
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

// SPDX-License-Identifier: MIT
#include "voxtact/render.h"
#include "app/commands.h"
#include "app/detect/detect_run.h"
#include "app/options/inputs.h"
#include "app/options/open_session.h"
#include "app/options/output_paths.h"
#include "app/output/standard_streams.h"
#include "app/render/colours.h"
#include "app/render/show.h"
#include "app/render/view.h"
#include "core/text.h"
#include "voxtact/io.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

constexpr const char* kFooter =
    R"(A PNG of the volume by ray casting, and of the mesh, solid, at its depth in it. Opacities are for a millimetre of
material: 0.5 lets half of the light through a millimetre. Light comes from the eye.

The eye, where no --camera is given: --view front (before the face), back, left (beside the left ear), right, top,
bottom; or --azimuth (0 front, 90 left, 180 back) and --elevation (90 top). The picture frames the volume.

--show paints on the mesh what is decided with the picture's transfer function and --threshold, as voxtact detect does:
contacts and discarded pixel by pixel, by the projection view with this camera and size; triangles by the projection
conservative. What is painted shines through the tissue before it: --through.

Examples:
  voxtact render --volume head.nii.gz --preset mr --output head.png
  voxtact render --volume head.nii.gz --preset mr --mesh tool.stl --poses poses.txt --pose 3 --view left --output hit.png
  voxtact render --volume head.nii.gz --preset mr --mesh tool.stl --show contacts --azimuth 40 --output contacts.png
  voxtact render --volume builtin:ct:128 --preset ct --azimuth 30 --elevation 20 --size 1024x1024 --output ct.png)";

struct RenderOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    DeviceChoice device;
    std::filesystem::path output;
    std::string viewName;
    std::optional<double> azimuth;
    std::optional<double> elevation;
    std::string preset;
    ShowOptions show;
    std::uint32_t pose = 0;
    Colour background{0, 0, 0};
    Colour meshColour = Scene{}.meshColour;
};

/// What is read before there is a device.
struct RenderInputs {
    VolumeData volume;
    ValueRange values;
    std::optional<MeshData> mesh;
    Mat4 world_from_object = identity();
    Mat4 clip_from_world{};
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours;
    ValueRange domain;
};

Result<void> checkOptions(const RenderOptions& options) {
    if (options.volumes.size() != 1 || options.meshes.sources.size() > 1) {
        return badArgument("one --volume and at most one --mesh are needed, not several");
    }
    if (options.output.extension() != ".png" && options.output.extension() != ".PNG") {
        return badArgument("--output " + options.output.string() + ": the ending of a picture is .png");
    }
    const bool turned = options.azimuth || options.elevation;
    if (!options.view.camera.empty() && (turned || !options.viewName.empty())) {
        return badArgument("--camera says where the eye is; leave out --view, --azimuth and --elevation");
    }
    if (turned && !options.viewName.empty()) {
        return badArgument("--view says where the eye is; leave out --azimuth and --elevation");
    }
    if (options.meshes.sources.empty() && (!options.view.poses.empty() || options.pose > 0)) {
        return badArgument("--poses and --pose are for a mesh; --mesh is missing");
    }
    return checkOutputs({{"--output", options.output}},
                        inputPaths(options.volumes, options.meshes, options.transferFunction, options.view));
}

Result<void> readMeshAtPose(const RenderOptions& options, RenderInputs& inputs) {
    if (options.meshes.sources.empty()) {
        return {};
    }
    const Result<std::vector<Mat4>> poses = loadPoses(options.view.poses);
    if (!poses.ok()) {
        return poses.error();
    }
    if (options.pose >= poses->size()) {
        return badArgument("--pose " + std::to_string(options.pose) + ": the poses are numbered from 0 to " +
                           std::to_string(poses->size() - 1));
    }
    inputs.world_from_object = (*poses)[options.pose];
    const Result<MeshData> mesh = loadMesh(options.meshes.sources.front(), options.meshes);
    if (!mesh.ok()) {
        return mesh.error();
    }
    Result<MeshData> creased = splitAtCreases(mesh->view());
    if (!creased.ok()) {
        return creased.error();
    }
    inputs.mesh = std::move(*creased);
    return {};
}

Result<void> setCamera(const RenderOptions& options, RenderInputs& inputs) {
    if (!options.view.camera.empty()) {
        const Result<Mat4> camera = io::readCamera(options.view.camera);
        if (!camera.ok()) {
            return camera.error();
        }
        inputs.clip_from_world = *camera;
        return {};
    }
    std::optional<Box> mesh;
    if (inputs.mesh) {
        const Result<MeshFacts> facts = checkMesh(inputs.mesh->view());
        if (!facts.ok()) {
            return facts.error();
        }
        mesh = worldBox(facts->bounds, inputs.world_from_object);
    }
    const Direction asked{options.azimuth.value_or(0), options.elevation.value_or(0)};
    inputs.clip_from_world = viewFrom(directionNamed(options.viewName).value_or(asked), inputs.volume.grid, mesh,
                                      options.view.size.width, options.view.size.height);
    return {};
}

Result<void> setLook(const RenderOptions& options, RenderInputs& inputs) {
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    if (!points.ok()) {
        return points.error();
    }
    inputs.domain = tableDomain(options.transferFunction, inputs.volume.type, inputs.values);
    inputs.opacity = std::move(*points);
    if (!options.transferFunction.path.empty()) {
        Result<std::vector<ColourPoint>> colours = io::readColours(options.transferFunction.path);
        if (!colours.ok()) {
            return colours.error();
        }
        inputs.colours = std::move(*colours);
    }
    Look look = options.preset.empty() ? Look{defaultRamp(inputs.domain), plainColours()}
                                       : lookNamed(options.preset, inputs.values);
    inputs.colours = inputs.colours.empty() ? std::move(look.colours) : inputs.colours;
    inputs.opacity = inputs.opacity.empty() ? std::move(look.opacity) : inputs.opacity;
    return {};
}

Result<RenderInputs> readInputs(const RenderOptions& options) {
    RenderInputs inputs;
    if (Result<void> mesh = readMeshAtPose(options, inputs); !mesh.ok()) {
        return mesh.error();
    }
    Result<VolumeData> volume = loadVolume(options.volumes.front());
    if (!volume.ok()) {
        return volume.error();
    }
    inputs.volume = std::move(*volume);
    const Result<ValueRange> values = checkVolume(inputs.volume.view());
    if (!values.ok()) {
        return values.error();
    }
    inputs.values = *values;
    for (const auto set : {setCamera, setLook}) {
        if (Result<void> done = set(options, inputs); !done.ok()) {
            return done.error();
        }
    }
    return inputs;
}

/// Everything on the device, in the order in which it must end.
struct RenderObjects {
    BlockingRenderer renderer;
    Volume volume;
    RenderBricks bricks;
    RenderTransferFunction function;
    std::optional<Mesh> mesh{};
    std::optional<MeshNormals> normals{};
    ShowObjects show{};
};

Result<RenderObjects> uploadObjects(const RenderOptions& options, const RenderInputs& inputs, const Session& session) {
    const QueueAccess queue = session.device.queueAccess();
    Result<BlockingRenderer> renderer = BlockingRenderer::create(session.context, queue);
    if (!renderer.ok()) {
        return renderer.error();
    }
    RenderTransferFunctionDesc desc;
    desc.opacity = {inputs.opacity, inputs.domain, options.transferFunction.tableSize};
    desc.colours = inputs.colours;
    desc.step = *std::ranges::min_element(inputs.volume.grid.spacing) / 2;
    Result<RenderTransferFunction> function = RenderTransferFunction::upload(renderer->renderer(), queue, desc);
    if (!function.ok()) {
        return function.error();
    }
    Result<Volume> volume = Volume::upload(session.context, queue, inputs.volume.view(), {.bricks = true});
    if (!volume.ok()) {
        return volume.error();
    }
    Result<RenderBricks> bricks = RenderBricks::create(renderer->renderer(), *volume);
    if (!bricks.ok()) {
        return bricks.error();
    }
    RenderObjects objects{std::move(*renderer), std::move(*volume), std::move(*bricks), std::move(*function)};
    if (inputs.mesh) {
        Result<Mesh> mesh = Mesh::upload(session.context, queue, inputs.mesh->view());
        if (!mesh.ok()) {
            return mesh.error();
        }
        objects.mesh = std::move(*mesh);
        Result<MeshNormals> normals = MeshNormals::upload(objects.renderer.renderer(), queue, inputs.mesh->view());
        if (!normals.ok()) {
            return normals.error();
        }
        objects.normals = std::move(*normals);
        const ShownPair pair{inputs.volume, *inputs.mesh, desc.opacity, options.transferFunction.threshold,
                             inputs.world_from_object};
        Result<ShowObjects> show = makeShowObjects(options.show, pair, session, objects.renderer.renderer());
        if (!show.ok()) {
            return show.error();
        }
        objects.show = std::move(*show);
    }
    return objects;
}

Result<Picture> renderOn(const RenderOptions& options, const RenderInputs& inputs, const Session& session) {
    if (Result<void> viewport = checkViewport(options.view.size, session.context.maxViewport(), "the device");
        !viewport.ok()) {
        return viewport.error();
    }
    Result<RenderObjects> objects = uploadObjects(options, inputs, session);
    if (!objects.ok()) {
        return objects.error();
    }
    if (!objects->function.visible()) {
        printNote("the transfer function has no opacity above 0: the volume is not to be seen");
    }
    Scene scene;
    scene.volume = &objects->volume;
    scene.transferFunction = &objects->function;
    scene.bricks = &objects->bricks;
    if (objects->mesh) {
        scene.mesh = &*objects->mesh;
        scene.normals = &*objects->normals;
        scene.paint = paintOf(options.show, objects->show, options.transferFunction.threshold);
    }
    scene.world_from_object = inputs.world_from_object;
    scene.meshColour = options.meshColour;
    scene.clip_from_world = inputs.clip_from_world;
    scene.background = options.background;
    return objects->renderer.render(scene, options.view.size);
}

Outcome runRender(const RenderOptions& options) {
    if (const Result<void> usable = checkOptions(options); !usable.ok()) {
        return usable.error();
    }
    const Result<RenderInputs> inputs = readInputs(options);
    if (!inputs.ok()) {
        return inputs.error();
    }
    std::shared_ptr<const ValidationMessages> messages;
    Result<Picture> picture = [&]() -> Result<Picture> {
        const Result<Session> session = openSession(options.device);
        if (!session.ok()) {
            return session.error();
        }
        messages = session->instance.messages();
        return renderOn(options, *inputs, *session);
    }();
    if (!picture.ok()) {
        return picture.error();
    }
    if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
        return invalid;
    }
    const Result<void> written = io::writePng(options.output, picture->width, picture->height, picture->rgba);
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace

Command addRender(CLI::App& program) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* parser = program.add_subcommand("render", "a picture of a volume, and of a mesh in it");
    parser->footer(kFooter);
    addVolumeOption(*parser, options->volumes);
    addMeshOptions(*parser, options->meshes, false);
    addTransferFunctionOptions(*parser, options->transferFunction, true);
    addName(*parser, "--preset", options->preset, {"mr", "ct"},
            "colours, and the opacity where none is given, for heads: mr (for any units), ct (Hounsfield units)");
    addViewOptions(*parser, options->view);
    addWholeNumber(*parser, "--pose", options->pose, 0, "which pose of --poses, from 0");
    addName(*parser, "--view", options->viewName, {"front", "back", "left", "right", "top", "bottom"},
            "from where the eye looks: front, back, left, right, top, bottom; default: front");
    addDegrees(*parser, "--azimuth", options->azimuth, "the eye's way round the volume: 0 front, 90 left, 180 back");
    addDegrees(*parser, "--elevation", options->elevation, "the eye's height: 90 top, -90 bottom");
    addColour(*parser, "--background", options->background, "default: 000000");
    addColour(*parser, "--mesh-colour", options->meshColour, "default: bfc7d1");
    addShowOptions(*parser, options->show);
    addDeviceOptions(*parser, options->device);
    addPath(*parser, "--output", options->output, "the PNG file to write");
    parser->get_option("--output")->required();
    return {parser, [options] { return runRender(*options); }};
}

} // namespace voxtact::app

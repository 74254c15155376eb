// SPDX-License-Identifier: MIT
// Pictures, recorded or in host memory.
#include "c/convert_vulkan.h"
#include "c/handles.h"
#include "c/pictures/handles.h"

using namespace voxtact;
using namespace voxtact::c;

struct vxt_picture {
    Picture object;
};

namespace {

static_assert(VXT_PAINT_PLAIN == static_cast<int>(Paint::Plain));
static_assert(VXT_PAINT_CONTACTS == static_cast<int>(Paint::Contacts));
static_assert(VXT_PAINT_DISCARDED == static_cast<int>(Paint::Discarded));
static_assert(VXT_PAINT_TRIANGLES == static_cast<int>(Paint::Triangles));
static_assert(VXT_PAINT_VERTICES == static_cast<int>(Paint::Vertices));

// The comments of voxtact_vulkan.h repeat these numbers.
static_assert(Lighting{}.ambient == 0.25 && Lighting{}.diffuse == 0.75 && Lighting{}.specular == 0.2);
static_assert(Lighting{}.shininess == 30 && Lighting{}.sideFrom == Vec3{-0.55, 0.6, 0.6} && Lighting{}.reach == 8);
static_assert(MeshPaint{}.contactColour == Colour{1, 0.23, 0.08});
static_assert(MeshPaint{}.discardedColour == Colour{0.16, 0.36, 0.88});

SceneMesh toSceneMesh(const vxt_scene_mesh& given) {
    SceneMesh out;
    out.mesh = &need(objectOf(given.mesh), "mesh: mesh");
    out.normals = objectOf(given.normals);
    out.world_from_object = numbersOr(given.world_from_object, out.world_from_object);
    out.meshColour = numbersOr(given.colour, out.meshColour);
    out.paint = {.what = number<Paint>(given.paint),
                 .transferFunction = objectOf(given.transfer_function),
                 .threshold = thresholdOf(given.threshold),
                 .triangles = objectOf(given.triangles),
                 .vertices = objectOf(given.vertices),
                 .contactColour = numbersOr(given.contact_colour, out.paint.contactColour),
                 .discardedColour = numbersOr(given.discarded_colour, out.paint.discardedColour),
                 .through = given.through};
    out.clipped = given.clipped != 0;
    return out;
}

Lighting toLighting(const vxt_lighting* given) {
    const vxt_lighting from = readOptions(given, zero<vxt_lighting>(), "lighting");
    Lighting out;
    out.volume = from.plain_volume == 0;
    out.mesh = from.plain_mesh == 0;
    out.ambient = numberOr(from.ambient, out.ambient);
    out.diffuse = numberOr(from.diffuse, out.diffuse);
    out.specular = numberOr(from.specular, out.specular);
    out.shininess = numberOr(from.shininess, out.shininess);
    out.side = from.side;
    out.sideFrom = numbersOr(from.side_from, out.sideFrom);
    out.occlusion = from.occlusion;
    out.reach = orDefault(from.reach, out.reach);
    out.faces = from.gradient_faces == 0;
    return out;
}

/// A caller's scene in the renderer's form, with the data that it references.
class SceneOf {
  public:
    explicit SceneOf(const vxt_picture_scene* given) : given_(readStruct(given, zero<vxt_picture_scene>(), "scene")) {
        for (const vxt_scene_mesh& mesh :
             readStructs(given_.meshes, given_.mesh_count, zero<vxt_scene_mesh>(), "mesh")) {
            meshes_.push_back(toSceneMesh(mesh));
        }
        const std::span<const vxt_clip_plane> planes =
            toSpan(given_.clip_planes, given_.clip_plane_count, "clip_planes");
        if (planes.size() > kMaxClipPlanes) { // before they are read
            refuse(ErrorCode::InvalidArgument, "the scene has " + std::to_string(planes.size()) +
                                                   " clip planes, the most is " + std::to_string(kMaxClipPlanes));
        }
        for (const vxt_clip_plane& plane : planes) {
            planes_.push_back({toVec3(plane.normal, "normal"), plane.offset});
        }
    }

    /// Valid as long as this is.
    [[nodiscard]] Scene scene() const {
        Scene out;
        out.volume = &need(objectOf(given_.volume), "scene: volume");
        out.transferFunction = &need(objectOf(given_.function), "scene: function");
        out.bricks = objectOf(given_.bricks);
        out.others = meshes_;
        out.clipPlanes = planes_;
        out.clip_from_world = toMat4(given_.clip_from_world, "clip_from_world");
        out.background = toColour(given_.background);
        out.lighting = toLighting(given_.lighting);
        out.jitter = given_.no_jitter == 0;
        return out;
    }
    /// May be null.
    [[nodiscard]] const std::atomic<bool>* cancel() const { return objectOf(given_.cancel); }

  private:
    vxt_picture_scene given_;
    std::vector<SceneMesh> meshes_;
    std::vector<ClipPlane> planes_;
};

Target toTarget(const vxt_picture_target* given) {
    const vxt_picture_target from = readStruct(given, zero<vxt_picture_target>(), "target");
    Target out;
    out.view = from.view;
    out.extent = from.extent;
    out.layout = orDefault(from.layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    out.targets = from.targets == nullptr ? nullptr : &from.targets->object;
    out.area = from.area;
    out.timestamps = from.timestamps;
    out.firstTimestamp = from.first_timestamp;
    return out;
}

} // namespace

vxt_result vxt_renderer_cmd_render(const vxt_renderer* renderer, VkCommandBuffer commands,
                                   const vxt_picture_scene* scene, const vxt_picture_target* target) {
    return call(renderer, [&] {
        const Renderer& by = need(renderer, "renderer").object.get();
        const SceneOf of(scene);
        take(by.cmdRender(commands, of.scene(), toTarget(target)));
    });
}

vxt_result vxt_picture_create(vxt_picture** picture) {
    return create(picture, [] { return Picture(); });
}

vxt_result vxt_picture_get(const vxt_picture* picture, vxt_picture_view* view) {
    return call([&] {
        const Picture& from = need(picture, "picture").object;
        vxt_picture_view out = zero<vxt_picture_view>();
        out.rgba = handOut<std::uint8_t>(from.rgba, &out.bytes);
        out.width = from.width;
        out.height = from.height;
        writeStruct(view, out, "view");
    });
}

void vxt_picture_destroy(vxt_picture* picture) {
    delete picture;
}

vxt_result vxt_blocking_renderer_create(const vxt_context* context, const vxt_queue* queue,
                                        vxt_blocking_renderer** renderer) {
    return create(context, "context", renderer, [&](const Context& on) {
        BlockingRenderer blocking = take(BlockingRenderer::create(on, toQueue(queue)));
        const Renderer& lent = blocking.renderer();
        return BlockingAndRenderer{std::move(blocking), {{std::nullopt, &lent}, context->errors}};
    });
}

const vxt_renderer* vxt_blocking_renderer_renderer(const vxt_blocking_renderer* renderer) {
    return renderer == nullptr ? nullptr : &renderer->object.renderer;
}

vxt_result vxt_blocking_renderer_render(vxt_blocking_renderer* renderer, const vxt_picture_scene* scene, uint32_t width,
                                        uint32_t height, vxt_picture_progress progress, void* user,
                                        vxt_picture* picture) {
    return call(renderer, [&] {
        BlockingRenderer& by = need(renderer, "renderer").object.blocking;
        Picture& to = need(picture, "picture").object;
        const SceneOf of(scene);
        const VkExtent2D extent{width, height};
        const std::atomic<bool>* cancel = of.cancel();
        if (progress == nullptr && cancel == nullptr) {
            to = take(by.render(of.scene(), extent));
            return;
        }
        to = take(by.render(of.scene(), extent, [=](std::uint32_t done, std::uint32_t rows) {
            if (progress != nullptr) {
                progress(user, done, rows);
            }
            return cancel == nullptr || !*cancel;
        }));
    });
}

void vxt_blocking_renderer_destroy(vxt_blocking_renderer* renderer) {
    delete renderer;
}

/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_RENDER_H
#define VOXTACT_VOXTACT_RENDER_H

#include "voxtact/voxtact_engine.h"
#include "voxtact/voxtact_vulkan.h"

/// @file
/// Pictures on a Vulkan device, in C: voxtact::render. A library that was built without it refuses them all,
/// UNSUPPORTED. What holds for voxtact_vulkan.h holds here; what each `..._cmd_...()` expects and leaves stands above
/// its namesake in render.h. Lengths are in mm; colours are red, green and blue, 0..1, in the space of the picture.

#ifdef __cplusplus
extern "C" {
#endif

// How a picture looks, without a device

/// Opacity and colours of a kind of image: voxtact::Look.
typedef struct vxt_look vxt_look;
/// The name of a preset, as `mr-brain`; it lives for ever; null beyond the last.
VXT_API const char* vxt_look_name(size_t index);
/// That of a preset, in the image's own units. `values`: the image's smallest and largest voxel.
VXT_CHECKED vxt_result vxt_look_create(const char* name, const vxt_range* values, vxt_look** look);
/// Its opacity, ascending; valid as long as the object. Null and 0 of null.
VXT_API const vxt_control_point* vxt_look_opacity(const vxt_look* look, size_t* count);
/// Its colours, ascending; the same.
VXT_API const vxt_colour_point* vxt_look_colours(const vxt_look* look, size_t* count);
/// Ends it.
VXT_API void vxt_look_destroy(vxt_look* look);

/// From where the eye looks, in degrees: voxtact::ViewDirection. 0, 0 is before the patient's face.
typedef struct vxt_view_direction {
    double azimuth;   ///< 90 beside the left ear, 180 behind the head
    double elevation; ///< 90 above
} vxt_view_direction;
/// That of `front`, `back`, `left`, `right`, `top` or `bottom`.
VXT_CHECKED vxt_result vxt_direction_named(const char* name, vxt_view_direction* direction);
/// An orthographic view that frames the volume's box in the whole picture: voxtact::viewFrom(). `also`, a box in world
/// space, is between its near and far plane too; it may be null.
VXT_CHECKED vxt_result vxt_view_from(const vxt_view_direction* direction, const vxt_grid* grid, const vxt_box* also,
                                     uint32_t width, uint32_t height, vxt_view* view);

/// The same triangles, with vertices of their own at edges of more than `degrees` (0..180; 40 is a good one):
/// voxtact::splitAtCreases().
VXT_CHECKED vxt_result vxt_split_at_creases(const vxt_mesh_view* mesh, double degrees, vxt_mesh_data** data);

// What pictures are made of

/// Makes pictures in one colour format: voxtact::Renderer.
typedef struct vxt_renderer vxt_renderer;
/// UNSUPPORTED where the device cannot render to the format, or its pixels are integers (R8G8B8A8_UNORM is a good one).
VXT_CHECKED vxt_result vxt_renderer_create(const vxt_context* context, VkFormat color_format, vxt_renderer** renderer);
/// Ends it. What was made with it lives on. That of a vxt_blocking_renderer is its own, and refused by doing nothing.
VXT_API void vxt_renderer_destroy(vxt_renderer* renderer);

/// Value -> opacity and colour: voxtact::RenderTransferFunctionDesc.
typedef struct vxt_render_function_desc {
    size_t struct_size;              ///< sizeof
    const vxt_control_point* points; ///< of opacity, as for a detector
    size_t point_count;              ///< at least 1
    const vxt_colour_point* colours; ///< ascending values; constant outside; none: white
    size_t colour_count;             ///< of `colours`
    vxt_range domain;                ///< of the table; lo < hi; default {0, 0}: what the points span
    double opacity_unit;             ///< the length of material that opacity is for; default 1
    double step;                     ///< from one sample of a ray to the next; half a voxel is a good one; default 0.5
    uint32_t table_size;             ///< entries; 2 to 1024; default 256
} vxt_render_function_desc;

/// The domain that the points span, 256 entries, steps of half a millimetre.
static inline vxt_render_function_desc vxt_render_function_desc_init(void) {
    vxt_render_function_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.opacity_unit = 1;
    desc.step = 0.5;
    desc.table_size = 256;
    return desc;
}

/// Value -> opacity and colour, on the device: voxtact::RenderTransferFunction.
typedef struct vxt_render_function vxt_render_function;
/// Makes it; vxt_render_function_cmd_upload() comes next.
VXT_CHECKED vxt_result vxt_render_function_create(const vxt_renderer* renderer, const vxt_render_function_desc* desc,
                                                  vxt_render_function** function);
/// Makes and uploads it in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_render_function_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                  const vxt_render_function_desc* desc, vxt_render_function** function);
/// Makes the table.
VXT_CHECKED vxt_result vxt_render_function_cmd_upload(vxt_render_function* function, VkCommandBuffer commands);
/// The same for a new function with as many entries.
VXT_CHECKED vxt_result vxt_render_function_cmd_update(vxt_render_function* function, VkCommandBuffer commands,
                                                      const vxt_render_function_desc* desc);
/// Whether some entry has an opacity above 0; 0 of null.
VXT_API uint32_t vxt_render_function_visible(const vxt_render_function* function);
/// Ends it.
VXT_API void vxt_render_function_destroy(vxt_render_function* function);

/// The normals of a mesh's vertices: voxtact::MeshNormals. Without, each triangle is flat.
typedef struct vxt_mesh_normals vxt_mesh_normals;
/// Makes them and fills a staging buffer.
VXT_CHECKED vxt_result vxt_mesh_normals_create(const vxt_renderer* renderer, const vxt_mesh_view* mesh,
                                               vxt_mesh_normals** normals);
/// Makes and uploads them in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_mesh_normals_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                               const vxt_mesh_view* mesh, vxt_mesh_normals** normals);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_mesh_normals_cmd_upload(vxt_mesh_normals* normals, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_mesh_normals_release_staging(vxt_mesh_normals* normals);
/// Records the normals of another shape of the mesh, of as many vertices; takes effect in command-buffer order.
VXT_CHECKED vxt_result vxt_mesh_normals_cmd_update(vxt_mesh_normals* normals, VkCommandBuffer commands,
                                                   const vxt_mesh_view* mesh);
/// Ends them.
VXT_API void vxt_mesh_normals_destroy(vxt_mesh_normals* normals);

/// Lets pictures skip what is transparent: voxtact::RenderBricks.
typedef struct vxt_render_bricks vxt_render_bricks;
/// Of a volume with bricks, which must outlive it. Nothing is copied.
VXT_CHECKED vxt_result vxt_render_bricks_create(const vxt_renderer* renderer, const vxt_volume* volume,
                                                vxt_render_bricks** bricks);
/// Ends it.
VXT_API void vxt_render_bricks_destroy(vxt_render_bricks* bricks);

/// Which triangles VXT_PAINT_TRIANGLES paints: voxtact::PaintedTriangles.
typedef struct vxt_painted_triangles vxt_painted_triangles;
/// By their numbers, in any order, of a mesh that has `mesh_triangles`. Makes a staging buffer.
VXT_CHECKED vxt_result vxt_painted_triangles_create(const vxt_renderer* renderer, uint32_t mesh_triangles,
                                                    const uint32_t* triangles, size_t triangle_count,
                                                    vxt_painted_triangles** painted);
/// Makes and uploads them in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_painted_triangles_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                    uint32_t mesh_triangles, const uint32_t* triangles,
                                                    size_t triangle_count, vxt_painted_triangles** painted);
/// Bits that are on the device already: VXT_DEVICE_TRIANGLE_MASK of a batch of one pair. The buffer must outlive this.
VXT_CHECKED vxt_result vxt_painted_triangles_wrap(const vxt_renderer* renderer, const vxt_buffer_range* mask,
                                                  vxt_painted_triangles** painted);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_painted_triangles_cmd_upload(vxt_painted_triangles* painted, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_painted_triangles_release_staging(vxt_painted_triangles* painted);
/// Ends them.
VXT_API void vxt_painted_triangles_destroy(vxt_painted_triangles* painted);

/// The colours of a mesh's vertices that VXT_PAINT_VERTICES paints: voxtact::PaintedVertices.
typedef struct vxt_painted_vertices vxt_painted_vertices;
/// `colours`: red, green and blue of each vertex, 0..1; at least one vertex. Makes a staging buffer.
VXT_CHECKED vxt_result vxt_painted_vertices_create(const vxt_renderer* renderer, const double* colours,
                                                   size_t vertex_count, vxt_painted_vertices** painted);
/// Makes and uploads them in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_painted_vertices_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                   const double* colours, size_t vertex_count,
                                                   vxt_painted_vertices** painted);
/// Colours that are on the device already: a uint for each vertex, red in its lowest 8 bits, then green and blue. The
/// buffer must outlive this.
VXT_CHECKED vxt_result vxt_painted_vertices_wrap(const vxt_renderer* renderer, const vxt_buffer_range* colours,
                                                 vxt_painted_vertices** painted);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_painted_vertices_cmd_upload(vxt_painted_vertices* painted, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_painted_vertices_release_staging(vxt_painted_vertices* painted);
/// Ends them.
VXT_API void vxt_painted_vertices_destroy(vxt_painted_vertices* painted);

/// What a mesh shows of what is decided about it: voxtact::Paint.
typedef enum vxt_paint {
    VXT_PAINT_PLAIN = 0,       ///< nothing
    VXT_PAINT_CONTACTS = 1,    ///< its survivors, as the projection VIEW counts them
    VXT_PAINT_DISCARDED = 2,   ///< its discarded fragments, and its survivors by their opacity
    VXT_PAINT_TRIANGLES = 3,   ///< chosen triangles
    VXT_PAINT_VERTICES = 4,    ///< a colour of its own for each vertex
    VXT_PAINT_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_paint;

/// A mesh at a pose, and how it looks: voxtact::SceneMesh and voxtact::MeshPaint.
typedef struct vxt_scene_mesh {
    size_t struct_size;                             ///< sizeof
    const vxt_mesh* mesh;                           ///< must be given
    const vxt_mesh_normals* normals;                ///< of `mesh`: smooth; null: each triangle is flat
    const vxt_transfer_function* transfer_function; ///< the detector's: for CONTACTS and DISCARDED
    const vxt_painted_triangles* triangles;         ///< for TRIANGLES
    double world_from_object[16];                   ///< affine, not singular; default the identity
    double colour[3];                               ///< where nothing is painted; default 0.75 0.78 0.82
    double contact_colour[3];                       ///< of survivors and chosen triangles; default 1 0.23 0.08
    double discarded_colour[3];                     ///< DISCARDED: of what does not survive; default 0.16 0.36 0.88
    double threshold;                               ///< of CONTACTS and DISCARDED; above 0, to 1; 0: 0.1
    double through;                       ///< 0..1: how much of what is painted is seen through the volume; default 0
    vxt_paint paint;                      ///< default PLAIN
    uint32_t clipped;                     ///< by the clipping planes, as the volume is; default 0
    const vxt_painted_vertices* vertices; ///< for VERTICES
} vxt_scene_mesh;

/// What a clipping plane takes away: points p of world space with dot(normal, p) > offset.
typedef struct vxt_clip_plane {
    double normal[3]; ///< of any length; it scales `offset`
    double offset;    ///< along the normal, where that is of length 1
} vxt_clip_plane;

/// How light falls: voxtact::Lighting. ambient, diffuse, specular, shininess and side are from 0 to 1e6.
typedef struct vxt_lighting {
    size_t struct_size;  ///< sizeof
    double ambient;      ///< light from everywhere; default 0.25
    double diffuse;      ///< of the light at the eye; default 0.75
    double specular;     ///< how bright glints are; default 0.2
    double shininess;    ///< how small they are; default 30
    double side;         ///< what a second light adds; default 0
    double side_from[3]; ///< where it is: to the picture's right, up, towards the eye; default -0.55 0.6 0.6
    double occlusion;    ///< 0..1: how dark a place of the volume is that is shut in; default 0
    double reach;        ///< how far off what shuts it in may be, mm; above 0; default 8
    uint32_t volume;     ///< on the volume, by its gradient; default 1
    uint32_t mesh;       ///< on meshes; default 1
    uint32_t faces;      ///< on faces of cuts as on planes; default 1
} vxt_lighting;

/// The light of a name, `soft`, `eye` or `none`, in this volume: voxtact::lightingNamed(). `lighting` comes from
/// vxt_lighting_init().
VXT_CHECKED vxt_result vxt_lighting_named(const char* name, const vxt_grid* grid, vxt_lighting* lighting);
/// What takes a side of a volume away, as `left` or `near`: voxtact::clipSide(). `at`: mm; null: at the middle.
/// `direction`: from where the eye looks, for `near` alone; else it may be null.
VXT_CHECKED vxt_result vxt_clip_side(const char* side, const double* at, const vxt_grid* grid,
                                     const vxt_view_direction* direction, vxt_clip_plane* plane);
/// A colour for each of several meshes, by its number: voxtact::meshColour(). Null is allowed.
VXT_API void vxt_mesh_colour(size_t number, double colour[3]);
/// The colour of a volume that has no look, a warm white: voxtact::plainColours(). Null is allowed.
VXT_API void vxt_plain_colour(double colour[3]);
/// How much of what is painted shines through, so that it is seen: voxtact::throughFor(); 0 for no paint.
VXT_API double vxt_paint_through(vxt_paint paint);

/// What is to be seen: voxtact::Scene.
typedef struct vxt_picture_scene {
    size_t struct_size;                  ///< sizeof
    const vxt_volume* volume;            ///< must be given
    const vxt_render_function* function; ///< must be given
    const vxt_render_bricks* bricks;     ///< of `volume`: what is transparent is skipped; may be null
    const vxt_scene_mesh* meshes;        ///< in it, at the right depth; any number
    size_t mesh_count;                   ///< of `meshes`
    const vxt_clip_plane* clip_planes;   ///< what any of them takes away is away
    size_t clip_plane_count;             ///< at most 6
    const vxt_lighting* lighting;        ///< null: the defaults
    double clip_from_world[16];          ///< orthographic or perspective; not singular
    double background[3];                ///< behind everything; default black
    uint32_t jitter;                     ///< noise instead of bands; default 1
    const vxt_cancel* cancel;            ///< ends vxt_blocking_renderer_render() early; may be null, the default
} vxt_picture_scene;

/// A mesh that is nowhere yet, in its own colours.
static inline vxt_scene_mesh vxt_scene_mesh_init(void) {
    vxt_scene_mesh mesh;
    memset(&mesh, 0, sizeof mesh);
    mesh.struct_size = sizeof mesh;
    mesh.world_from_object[0] = mesh.world_from_object[5] = 1;
    mesh.world_from_object[10] = mesh.world_from_object[15] = 1;
    mesh.colour[0] = 0.75;
    mesh.colour[1] = 0.78;
    mesh.colour[2] = 0.82;
    mesh.contact_colour[0] = 1;
    mesh.contact_colour[1] = 0.23;
    mesh.contact_colour[2] = 0.08;
    mesh.discarded_colour[0] = 0.16;
    mesh.discarded_colour[1] = 0.36;
    mesh.discarded_colour[2] = 0.88;
    mesh.threshold = 0.1;
    return mesh;
}

/// From the eye, with some gloss.
static inline vxt_lighting vxt_lighting_init(void) {
    vxt_lighting lighting;
    memset(&lighting, 0, sizeof lighting);
    lighting.struct_size = sizeof lighting;
    lighting.ambient = 0.25;
    lighting.diffuse = 0.75;
    lighting.specular = 0.2;
    lighting.shininess = 30;
    lighting.side_from[0] = -0.55;
    lighting.side_from[1] = lighting.side_from[2] = 0.6;
    lighting.reach = 8;
    lighting.volume = lighting.mesh = lighting.faces = 1;
    return lighting;
}

/// Nothing before black.
static inline vxt_picture_scene vxt_picture_scene_init(void) {
    vxt_picture_scene scene;
    memset(&scene, 0, sizeof scene);
    scene.struct_size = sizeof scene;
    scene.jitter = 1;
    return scene;
}

// Pictures

/// The images between the passes of one picture in flight: voxtact::RenderTargets.
typedef struct vxt_render_targets vxt_render_targets;
/// Of pictures of that size at most.
VXT_CHECKED vxt_result vxt_render_targets_create(const vxt_renderer* renderer, uint32_t width, uint32_t height,
                                                 vxt_render_targets** targets);
/// Ends it.
VXT_API void vxt_render_targets_destroy(vxt_render_targets* targets);

/// Where a recorded picture goes: voxtact::Target.
typedef struct vxt_picture_target {
    size_t struct_size;          ///< sizeof
    vxt_render_targets* targets; ///< must be given
    VkImageView view;            ///< of the renderer's format, one sample, usage COLOR_ATTACHMENT
    VkExtent2D extent;           ///< of the picture, from the image's corner
    VkRect2D area;               ///< the part that is made; without an extent, the default, all of it
    VkQueryPool timestamps;      ///< three are written; null, the default: none
    VkImageLayout layout;        ///< COLOR_ATTACHMENT_OPTIMAL, the default, or GENERAL
    uint32_t first_timestamp;    ///< number of the first query
} vxt_picture_target;

/// Nowhere yet.
static inline vxt_picture_target vxt_picture_target_init(void) {
    vxt_picture_target target;
    memset(&target, 0, sizeof target);
    target.struct_size = sizeof target;
    target.layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    return target;
}

/// Records a picture: voxtact::Renderer::cmdRender(). No allocation of device memory, no submission, no wait.
VXT_CHECKED vxt_result vxt_renderer_cmd_render(const vxt_renderer* renderer, VkCommandBuffer commands,
                                               const vxt_picture_scene* scene, const vxt_picture_target* target);

/// The pixels of a picture, where they are.
typedef struct vxt_picture_view {
    size_t struct_size;  ///< sizeof
    const uint8_t* rgba; ///< four bytes per pixel, row by row without padding, the uppermost first; alpha is 255
    size_t bytes;        ///< of `rgba`: 4 * width * height
    uint32_t width;      ///< pixels
    uint32_t height;     ///< pixels
} vxt_picture_view;

/// Nothing.
static inline vxt_picture_view vxt_picture_view_init(void) {
    vxt_picture_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// A picture in host memory: voxtact::Picture. vxt_write_png() writes it.
typedef struct vxt_picture vxt_picture;
/// An empty one.
VXT_CHECKED vxt_result vxt_picture_create(vxt_picture** picture);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_picture_get(const vxt_picture* picture, vxt_picture_view* view);
/// Ends it.
VXT_API void vxt_picture_destroy(vxt_picture* picture);

/// How far a picture is: rows that are done, and all. Called on the thread that asked for it.
typedef void (*vxt_picture_progress)(void* user, uint32_t done, uint32_t rows);

/// Renders into an image of its own, submits on the caller's queue, waits and reads: voxtact::BlockingRenderer.
typedef struct vxt_blocking_renderer vxt_blocking_renderer;
/// `queue` needs graphics.
VXT_CHECKED vxt_result vxt_blocking_renderer_create(const vxt_context* context, const vxt_queue* queue,
                                                    vxt_blocking_renderer** renderer);
/// The renderer that records, to make the parts of a scene with; it lives as long as this object. Null of null.
VXT_API const vxt_renderer* vxt_blocking_renderer_renderer(const vxt_blocking_renderer* renderer);
/// Makes a picture; one at a time. With `progress` or the scene's `cancel`, in bands of rows of about a fifth of a
/// second; CANCELLED after a band where `cancel` is set. After a failure `picture` holds what it held.
VXT_CHECKED vxt_result vxt_blocking_renderer_render(vxt_blocking_renderer* renderer, const vxt_picture_scene* scene,
                                                    uint32_t width, uint32_t height, vxt_picture_progress progress,
                                                    void* user, vxt_picture* picture);
/// Ends it.
VXT_API void vxt_blocking_renderer_destroy(vxt_blocking_renderer* renderer);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_RENDER_H
#define VOXTACT_VOXTACT_RENDER_H

#include "voxtact/voxtact_engine.h"
#include "voxtact/voxtact_vulkan.h"

/// @file
/// Pictures on a Vulkan device, in C: voxtact::render. A library that was built without it returns UNSUPPORTED. The
/// conventions of voxtact_vulkan.h apply; render.h documents the required and resulting states of each `..._cmd_...()`
/// function. Lengths are in mm; colours are red, green and blue, 0..1, in the space of the picture.

#ifdef __cplusplus
extern "C" {
#endif

// Appearance, without a device

/// Opacity and colours of a kind of image: voxtact::Look.
typedef struct vxt_look vxt_look;
/// Returns the name of a preset, such as `mr-brain`, with static lifetime; null beyond the last one.
VXT_API const char* vxt_look_name(size_t index);
/// Creates the look of a preset, in the image's own units. `values`: the image's smallest and largest voxel.
VXT_CHECKED vxt_result vxt_look_create(const char* name, const vxt_range* values, vxt_look** look);
/// Returns the opacity, ascending; valid as long as the object. For null: null and count 0.
VXT_API const vxt_control_point* vxt_look_opacity(const vxt_look* look, size_t* count);
/// Returns the colours, ascending; valid as long as the object.
VXT_API const vxt_colour_point* vxt_look_colours(const vxt_look* look, size_t* count);
/// Destroys the object.
VXT_API void vxt_look_destroy(vxt_look* look);

/// Position of the eye, in degrees: voxtact::ViewDirection. 0, 0 is in front of the patient's face.
typedef struct vxt_view_direction {
    double azimuth;   ///< 90: left ear, 180: back of the head
    double elevation; ///< 90: above
} vxt_view_direction;
/// Returns the direction of `front`, `back`, `left`, `right`, `top` or `bottom`.
VXT_CHECKED vxt_result vxt_direction_named(const char* name, vxt_view_direction* direction);
/// Returns an orthographic view that frames the volume's box in the whole picture: voxtact::viewFrom(). `also`: a box
/// in world space that is also between the near and far planes; may be null.
VXT_CHECKED vxt_result vxt_view_from(const vxt_view_direction* direction, const vxt_grid* grid, const vxt_box* also,
                                     uint32_t width, uint32_t height, vxt_view* view);

/// Returns the same triangles, with separate vertices at edges of more than `degrees` (0..180; recommended: 40):
/// voxtact::splitAtCreases().
VXT_CHECKED vxt_result vxt_split_at_creases(const vxt_mesh_view* mesh, double degrees, vxt_mesh_data** data);

// Parts of pictures

/// Renders pictures in one colour format: voxtact::Renderer.
typedef struct vxt_renderer vxt_renderer;
/// Returns UNSUPPORTED if the device cannot render to the format, or its pixels are integers. Recommended:
/// R8G8B8A8_UNORM.
VXT_CHECKED vxt_result vxt_renderer_create(const vxt_context* context, VkFormat color_format, vxt_renderer** renderer);
/// Destroys the object; objects created with it remain valid. Ignores the renderer of a vxt_blocking_renderer.
VXT_API void vxt_renderer_destroy(vxt_renderer* renderer);

/// Value -> opacity and colour: voxtact::RenderTransferFunctionDesc.
typedef struct vxt_render_function_desc {
    size_t struct_size;              ///< sizeof this struct
    const vxt_control_point* points; ///< opacity, as for a detector
    size_t point_count;              ///< at least 1
    const vxt_colour_point* colours; ///< ascending values; constant outside; none: white
    size_t colour_count;             ///< length of `colours`
    vxt_range domain;                ///< domain of the table; lo < hi; default {0, 0}: the range of the points
    double opacity_unit;             ///< path length over which opacity absorbs; default 1
    double step;                     ///< distance between samples of a ray; recommended: half a voxel; default 0.5
    uint32_t table_size;             ///< entries; 2 to 1024; default 256
} vxt_render_function_desc;

/// Returns the defaults: the domain of the points, 256 entries, steps of half a millimetre.
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
/// Creates the function; call vxt_render_function_cmd_upload() next.
VXT_CHECKED vxt_result vxt_render_function_create(const vxt_renderer* renderer, const vxt_render_function_desc* desc,
                                                  vxt_render_function** function);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_render_function_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                  const vxt_render_function_desc* desc, vxt_render_function** function);
/// Records the computation of the table.
VXT_CHECKED vxt_result vxt_render_function_cmd_upload(vxt_render_function* function, VkCommandBuffer commands);
/// Like vxt_render_function_cmd_upload(), for a new function with as many entries.
VXT_CHECKED vxt_result vxt_render_function_cmd_update(vxt_render_function* function, VkCommandBuffer commands,
                                                      const vxt_render_function_desc* desc);
/// Returns 1 if some entry has an opacity above 0; 0 for null.
VXT_API uint32_t vxt_render_function_visible(const vxt_render_function* function);
/// Destroys the object.
VXT_API void vxt_render_function_destroy(vxt_render_function* function);

/// The normals of a mesh's vertices: voxtact::MeshNormals. Without them, each triangle is flat.
typedef struct vxt_mesh_normals vxt_mesh_normals;
/// Creates the object and fills a staging buffer.
VXT_CHECKED vxt_result vxt_mesh_normals_create(const vxt_renderer* renderer, const vxt_mesh_view* mesh,
                                               vxt_mesh_normals** normals);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_mesh_normals_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                               const vxt_mesh_view* mesh, vxt_mesh_normals** normals);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_mesh_normals_cmd_upload(vxt_mesh_normals* normals, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_mesh_normals_release_staging(vxt_mesh_normals* normals);
/// Records the normals of another shape of the mesh, with as many vertices; takes effect in command-buffer order.
VXT_CHECKED vxt_result vxt_mesh_normals_cmd_update(vxt_mesh_normals* normals, VkCommandBuffer commands,
                                                   const vxt_mesh_view* mesh);
/// Destroys the object.
VXT_API void vxt_mesh_normals_destroy(vxt_mesh_normals* normals);

/// Lets pictures skip transparent bricks: voxtact::RenderBricks.
typedef struct vxt_render_bricks vxt_render_bricks;
/// Uses the bricks of a volume, which must outlive it. Copies nothing.
VXT_CHECKED vxt_result vxt_render_bricks_create(const vxt_renderer* renderer, const vxt_volume* volume,
                                                vxt_render_bricks** bricks);
/// Destroys the object.
VXT_API void vxt_render_bricks_destroy(vxt_render_bricks* bricks);

/// The triangles that VXT_PAINT_TRIANGLES paints: voxtact::PaintedTriangles.
typedef struct vxt_painted_triangles vxt_painted_triangles;
/// Selects triangles by index, in any order, of a mesh with `mesh_triangles` triangles. Fills a staging buffer.
VXT_CHECKED vxt_result vxt_painted_triangles_create(const vxt_renderer* renderer, uint32_t mesh_triangles,
                                                    const uint32_t* triangles, size_t triangle_count,
                                                    vxt_painted_triangles** painted);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_painted_triangles_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                    uint32_t mesh_triangles, const uint32_t* triangles,
                                                    size_t triangle_count, vxt_painted_triangles** painted);
/// Wraps a device buffer of bits: VXT_DEVICE_TRIANGLE_MASK of a batch of one pair. The buffer must outlive this.
VXT_CHECKED vxt_result vxt_painted_triangles_wrap(const vxt_renderer* renderer, const vxt_buffer_range* mask,
                                                  vxt_painted_triangles** painted);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_painted_triangles_cmd_upload(vxt_painted_triangles* painted, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_painted_triangles_release_staging(vxt_painted_triangles* painted);
/// Destroys the object.
VXT_API void vxt_painted_triangles_destroy(vxt_painted_triangles* painted);

/// The colours of a mesh's vertices that VXT_PAINT_VERTICES paints: voxtact::PaintedVertices.
typedef struct vxt_painted_vertices vxt_painted_vertices;
/// Sets `colours`: red, green and blue of each vertex, 0..1; at least one vertex. Fills a staging buffer.
VXT_CHECKED vxt_result vxt_painted_vertices_create(const vxt_renderer* renderer, const double* colours,
                                                   size_t vertex_count, vxt_painted_vertices** painted);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_painted_vertices_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                   const double* colours, size_t vertex_count,
                                                   vxt_painted_vertices** painted);
/// Wraps a device buffer: one uint per vertex, red in its lowest 8 bits, then green and blue. The buffer must outlive
/// this.
VXT_CHECKED vxt_result vxt_painted_vertices_wrap(const vxt_renderer* renderer, const vxt_buffer_range* colours,
                                                 vxt_painted_vertices** painted);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_painted_vertices_cmd_upload(vxt_painted_vertices* painted, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_painted_vertices_release_staging(vxt_painted_vertices* painted);
/// Destroys the object.
VXT_API void vxt_painted_vertices_destroy(vxt_painted_vertices* painted);

/// What is painted on a mesh: voxtact::Paint.
typedef enum vxt_paint {
    VXT_PAINT_PLAIN = 0,       ///< nothing
    VXT_PAINT_CONTACTS = 1,    ///< passing fragments, as the projection VIEW counts them
    VXT_PAINT_DISCARDED = 2,   ///< discarded fragments, and passing fragments by opacity
    VXT_PAINT_TRIANGLES = 3,   ///< chosen triangles
    VXT_PAINT_VERTICES = 4,    ///< a colour for each vertex
    VXT_PAINT_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_paint;

/// A mesh at a pose, with its appearance: voxtact::SceneMesh and voxtact::MeshPaint.
typedef struct vxt_scene_mesh {
    size_t struct_size;                             ///< sizeof this struct
    const vxt_mesh* mesh;                           ///< required
    const vxt_mesh_normals* normals;                ///< of `mesh`: smooth shading; null: each triangle is flat
    const vxt_transfer_function* transfer_function; ///< that of the detector; for CONTACTS and DISCARDED
    const vxt_painted_triangles* triangles;         ///< for TRIANGLES
    double world_from_object[16];                   ///< affine, not singular; default the identity
    double colour[3];                               ///< colour without paint; default 0.75 0.78 0.82
    double contact_colour[3];                       ///< passing fragments and chosen triangles; default 1 0.23 0.08
    double discarded_colour[3];                     ///< DISCARDED: discarded fragments; default 0.16 0.36 0.88
    double threshold;                               ///< for CONTACTS and DISCARDED; above 0, up to 1; 0: 0.1
    double through;                                 ///< 0..1: visibility of the paint through the volume; default 0
    vxt_paint paint;                                ///< default PLAIN
    uint32_t clipped;                               ///< cut by the clipping planes, like the volume; default 0
    const vxt_painted_vertices* vertices;           ///< for VERTICES
} vxt_scene_mesh;

/// Removes the points p of world space with dot(normal, p) > offset.
typedef struct vxt_clip_plane {
    double normal[3]; ///< any length; it scales `offset`
    double offset;    ///< along the normal, if that has length 1
} vxt_clip_plane;

/// Light: voxtact::Lighting. ambient, diffuse, specular, shininess and side are from 0 to 1e6.
typedef struct vxt_lighting {
    size_t struct_size;  ///< sizeof this struct
    double ambient;      ///< ambient light; default 0.25
    double diffuse;      ///< diffuse light from the eye; default 0.75
    double specular;     ///< strength of highlights; default 0.2
    double shininess;    ///< exponent of highlights; default 30
    double side;         ///< strength of the side light; default 0
    double side_from[3]; ///< its direction: to the picture's right, up, towards the eye; default -0.55 0.6 0.6
    double occlusion;    ///< 0..1: darkening of enclosed points of the volume; default 0
    double reach;        ///< range of occluders, mm; above 0; default 8
    uint32_t volume;     ///< 1: shades the volume by its gradient; default 1
    uint32_t mesh;       ///< 1: shades meshes; default 1
    uint32_t faces;      ///< 1: shades cut faces by the normal of the plane; default 1
} vxt_lighting;

/// Sets the preset `soft`, `eye` or `none` for a volume: voxtact::lightingNamed(). Initialise `lighting` by
/// vxt_lighting_init().
VXT_CHECKED vxt_result vxt_lighting_named(const char* name, const vxt_grid* grid, vxt_lighting* lighting);
/// Returns a plane that removes a side of a volume, such as `left` or `near`: voxtact::clipSide(). `at`: mm; null: the
/// middle. `direction`: of the eye, only for `near`; else may be null.
VXT_CHECKED vxt_result vxt_clip_side(const char* side, const double* at, const vxt_grid* grid,
                                     const vxt_view_direction* direction, vxt_clip_plane* plane);
/// Returns a colour for each of several meshes, by index: voxtact::meshColour(). Null is allowed.
VXT_API void vxt_mesh_colour(size_t number, double colour[3]);
/// Returns the colour of a volume without a look, a warm white: voxtact::plainColours(). Null is allowed.
VXT_API void vxt_plain_colour(double colour[3]);
/// Returns a value of vxt_scene_mesh::through that makes the paint visible: voxtact::throughFor(); 0 without paint.
VXT_API double vxt_paint_through(vxt_paint paint);

/// Visible objects: voxtact::Scene.
typedef struct vxt_picture_scene {
    size_t struct_size;                  ///< sizeof this struct
    const vxt_volume* volume;            ///< required
    const vxt_render_function* function; ///< required
    const vxt_render_bricks* bricks;     ///< of `volume`: skips its transparent parts; may be null
    const vxt_scene_mesh* meshes;        ///< meshes at the right depth; any number
    size_t mesh_count;                   ///< length of `meshes`
    const vxt_clip_plane* clip_planes;   ///< a point that any of them removes is invisible
    size_t clip_plane_count;             ///< at most 6
    const vxt_lighting* lighting;        ///< null: the defaults
    double clip_from_world[16];          ///< orthographic or perspective; not singular
    double background[3];                ///< behind all objects; default black
    uint32_t jitter;                     ///< noise instead of bands; default 1
    const vxt_cancel* cancel;            ///< cancels vxt_blocking_renderer_render(); null, the default: never
} vxt_picture_scene;

/// Returns a scene mesh with default colours and without a mesh.
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

/// Returns the defaults: light from the eye, with highlights.
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

/// Returns an empty scene with a black background.
static inline vxt_picture_scene vxt_picture_scene_init(void) {
    vxt_picture_scene scene;
    memset(&scene, 0, sizeof scene);
    scene.struct_size = sizeof scene;
    scene.jitter = 1;
    return scene;
}

// Pictures

/// Intermediate images of one picture in flight: voxtact::RenderTargets.
typedef struct vxt_render_targets vxt_render_targets;
/// Creates targets for pictures up to that size.
VXT_CHECKED vxt_result vxt_render_targets_create(const vxt_renderer* renderer, uint32_t width, uint32_t height,
                                                 vxt_render_targets** targets);
/// Destroys the object.
VXT_API void vxt_render_targets_destroy(vxt_render_targets* targets);

/// Destination of a recorded picture: voxtact::Target.
typedef struct vxt_picture_target {
    size_t struct_size;          ///< sizeof this struct
    vxt_render_targets* targets; ///< required
    VkImageView view;            ///< of the renderer's format, one sample, usage COLOR_ATTACHMENT
    VkExtent2D extent;           ///< size of the picture, from the image's corner
    VkRect2D area;               ///< part to render; without an extent, the default, the whole picture
    VkQueryPool timestamps;      ///< three are written; null, the default: none
    VkImageLayout layout;        ///< COLOR_ATTACHMENT_OPTIMAL, the default, or GENERAL
    uint32_t first_timestamp;    ///< index of the first query
} vxt_picture_target;

/// Returns an empty target.
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

/// A view of a picture's pixels.
typedef struct vxt_picture_view {
    size_t struct_size;  ///< sizeof this struct
    const uint8_t* rgba; ///< four bytes per pixel, row by row without padding, the uppermost first; alpha is 255
    size_t bytes;        ///< size of `rgba`: 4 * width * height
    uint32_t width;      ///< pixels
    uint32_t height;     ///< pixels
} vxt_picture_view;

/// Returns an empty view.
static inline vxt_picture_view vxt_picture_view_init(void) {
    vxt_picture_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// A picture in host memory: voxtact::Picture. vxt_write_png() writes it.
typedef struct vxt_picture vxt_picture;
/// Creates an empty picture.
VXT_CHECKED vxt_result vxt_picture_create(vxt_picture** picture);
/// Returns a view of the pixels, valid until the next picture is written, or the object's end.
VXT_CHECKED vxt_result vxt_picture_get(const vxt_picture* picture, vxt_picture_view* view);
/// Destroys the object.
VXT_API void vxt_picture_destroy(vxt_picture* picture);

/// Receives the progress: rows done and in total. Called on the rendering thread.
typedef void (*vxt_picture_progress)(void* user, uint32_t done, uint32_t rows);

/// Renders into its own image, submits on the caller's queue, waits and reads: voxtact::BlockingRenderer.
typedef struct vxt_blocking_renderer vxt_blocking_renderer;
/// Creates a renderer. `queue` needs graphics.
VXT_CHECKED vxt_result vxt_blocking_renderer_create(const vxt_context* context, const vxt_queue* queue,
                                                    vxt_blocking_renderer** renderer);
/// Returns the recording renderer, for creating the parts of a scene; valid as long as this object. Null for null.
VXT_API const vxt_renderer* vxt_blocking_renderer_renderer(const vxt_blocking_renderer* renderer);
/// Renders a picture; one at a time. With `progress` or the scene's `cancel`, renders bands of rows of about a fifth of
/// a second each, and returns CANCELLED after a band if `cancel` is set. After a failure `picture` is unchanged.
VXT_CHECKED vxt_result vxt_blocking_renderer_render(vxt_blocking_renderer* renderer, const vxt_picture_scene* scene,
                                                    uint32_t width, uint32_t height, vxt_picture_progress progress,
                                                    void* user, vxt_picture* picture);
/// Destroys the object.
VXT_API void vxt_blocking_renderer_destroy(vxt_blocking_renderer* renderer);

#ifdef __cplusplus
}
#endif

#endif

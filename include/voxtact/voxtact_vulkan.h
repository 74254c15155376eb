/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_H
#define VOXTACT_VOXTACT_VULKAN_H

#include "voxtact/voxtact.h"

#include <vulkan/vulkan_core.h>

/// @file
/// voxtact on a Vulkan device, in C. What holds for voxtact.h holds here. What each `..._cmd_...()` expects and leaves,
/// and which bound state it loses, stands above its namesake in context.h, scene.h and detector.h. Vulkan handles are
/// the caller's: nothing here frees, writes or transitions them. Objects keep what they need of the context, so the
/// order in which they end does not matter; all of them end before the device.

#ifdef __cplusplus
extern "C" {
#endif

/// `text` is valid during the call only. May be called from any thread that calls voxtact.
typedef void (*vxt_log_callback)(void* user, const char* text);

/// The caller's device: voxtact::ContextDesc. The handles, the loader's pointer, the allocator and the log callback are
/// kept and must outlive the context.
typedef struct vxt_context_desc {
    size_t struct_size;                                ///< sizeof
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;  ///< the caller's loader
    VkInstance instance;                               ///< the caller's
    VkPhysicalDevice physical_device;                  ///< that the device was made of
    VkDevice device;                                   ///< the caller's; outlives all that is made with it
    const VkPhysicalDeviceFeatures2* enabled_features; ///< the chain that vkCreateDevice was given
    const char* const* enabled_instance_extensions;    ///< only VK_EXT_debug_utils is looked for
    size_t enabled_instance_extension_count;           ///< of these
    const char* const* enabled_device_extensions;      ///< those of vxt_optional_device_extensions() are looked for
    size_t enabled_device_extension_count;             ///< of these
    VkPipelineCache pipeline_cache;                    ///< optional
    const VkAllocationCallbacks* allocator;            ///< optional
    vxt_log_callback log;                              ///< optional; warnings, a line each
    void* log_user;                                    ///< the first argument of every call of `log`
    uint32_t api_version;                              ///< of the instance; at least VK_API_VERSION_1_3
    uint32_t reserved;                                 ///< 0
    const uint32_t* queue_families;                    ///< of the queues that use what is made; two or more share it
    size_t queue_family_count;                         ///< of these: voxtact::ContextDesc::queueFamilies
    uint64_t fragments_at_once;                        ///< that a draw tests: voxtact::ContextDesc::fragmentsAtOnce
} vxt_context_desc;

/// Nothing is given: vxt_check() then names everything that is missing.
static inline vxt_context_desc vxt_context_desc_init(void) {
    vxt_context_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    return desc;
}

/// A feature that voxtact uses: voxtact::Requirement. Its texts live for ever.
typedef struct vxt_requirement {
    const char* feature;   ///< member of `structure`, as Vulkan spells it
    const char* structure; ///< e.g. "VkPhysicalDeviceVulkan13Features"
    const char* without;   ///< what is lost without it
    uint32_t required;     ///< 0: recommended
    uint32_t reserved;     ///< 0
} vxt_requirement;

/// How many there are.
VXT_API size_t vxt_requirement_count(void);
/// One of them, in the order in which vxt_check() reports them.
VXT_CHECKED vxt_result vxt_requirement_get(size_t index, vxt_requirement* requirement);
/// Device extensions that voxtact can use, and that no method needs. They live for ever.
VXT_API const char* const* vxt_optional_device_extensions(size_t* count);

/// A feature chain for vkCreateDevice: voxtact::FeatureRequest.
typedef struct vxt_features vxt_features;
/// Every one of the requirements that `supported` (what vkGetPhysicalDeviceFeatures2 filled in) offers, and nothing
/// else. Null: the required ones only.
VXT_CHECKED vxt_result vxt_features_create(const VkPhysicalDeviceFeatures2* supported, vxt_features** features);
/// The chain, valid as long as the object: VkPhysicalDeviceFeatures2, Vulkan12Features, Vulkan13Features. Add your own
/// features to the members of these, and your own structs behind the last one.
VXT_API VkPhysicalDeviceFeatures2* vxt_features_chain(vxt_features* features);
/// Ends it.
VXT_API void vxt_features_destroy(vxt_features* features);

/// A queue of the caller's for what blocks: voxtact::QueueAccess.
typedef struct vxt_queue {
    size_t struct_size;         ///< sizeof
    VkQueue queue;              ///< of the context's device
    void (*lock)(void* user);   ///< called before each submission; may be null
    void (*unlock)(void* user); ///< called after it; may be null
    void* user;                 ///< the argument of both
    uint32_t family;            ///< of the queue; with graphics or, for uploads, compute
    uint32_t reserved;          ///< 0
} vxt_queue;

/// No queue.
static inline vxt_queue vxt_queue_init(void) {
    vxt_queue queue;
    memset(&queue, 0, sizeof queue);
    queue.struct_size = sizeof queue;
    return queue;
}

/// voxtact on one device: voxtact::Context. Any number of them live in one process.
VXT_CHECKED vxt_result vxt_context_create(const vxt_context_desc* desc, vxt_context** context);
/// Whether a counting method can be had in a projection on this device.
VXT_API uint32_t vxt_context_supports(const vxt_context* context, vxt_method method, vxt_projection projection);
/// The exact method that needs least: query, else atomic, else query-any.
VXT_API vxt_method vxt_context_default_method(const vxt_context* context);
/// Largest viewport.
VXT_API VkExtent2D vxt_context_max_viewport(const vxt_context* context);
/// Whether any call has seen VK_ERROR_DEVICE_LOST; every later one fails with VXT_ERROR_DEVICE_LOST.
VXT_API uint32_t vxt_context_device_lost(const vxt_context* context);
/// Ends it. What was made with it lives on.
VXT_API void vxt_context_destroy(vxt_context* context);

/// What is known of a counting method on a device.
typedef struct vxt_method_report {
    const char* text;        ///< why it is not available or not trusted, or what was counted; may be empty
    double pairs_per_second; ///< vxt_measure_methods(): wall clock, median; 0 where it was not measured
    vxt_method method;       ///< which
    uint32_t available;      ///< whether a detector can be made for it
    uint32_t trusted;        ///< vxt_self_test(): every count was as it must be
    uint32_t reserved;       ///< 0
} vxt_method_report;

/// What vxt_check(), vxt_self_test() or vxt_measure_methods() found.
typedef struct vxt_report_view {
    size_t struct_size;               ///< sizeof
    const char* const* missing;       ///< vxt_check(): a line for each thing: what, and what it costs
    size_t missing_count;             ///< of these
    const vxt_method_report* methods; ///< every counting method of a device
    size_t method_count;              ///< of these
    uint32_t usable;                  ///< a context can be made
    uint32_t reserved;                ///< 0
} vxt_report_view;

/// Nothing.
static inline vxt_report_view vxt_report_view_init(void) {
    vxt_report_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// A report.
typedef struct vxt_report vxt_report;
/// What is in it; valid as long as the object.
VXT_CHECKED vxt_result vxt_report_get(const vxt_report* report, vxt_report_view* view);
/// Ends it.
VXT_API void vxt_report_destroy(vxt_report* report);
/// Looks at a description without making anything. What is wrong with the device is in the report, not in the result.
VXT_CHECKED vxt_result vxt_check(const vxt_context_desc* desc, vxt_report** report);
/// Counts a known number of fragments by each method: voxtact::selfTest(). Blocks.
VXT_CHECKED vxt_result vxt_self_test(const vxt_context* context, const vxt_queue* queue, vxt_report** report);
/// The self-test, and then a small scene by each trusted method: voxtact::measureMethods(). Blocks.
VXT_CHECKED vxt_result vxt_measure_methods(const vxt_context* context, const vxt_queue* queue, vxt_report** report);

// The scene

/// How a volume is made: voxtact::VolumeOptions.
typedef struct vxt_volume_options {
    size_t struct_size; ///< sizeof
    const char* name;   ///< appears on the Vulkan objects; may be null
    uint32_t bricks;    ///< keeps the range of values of every brick of 8^3 cells, for passes that skip; default 0
    uint32_t editable;  ///< allows edits; default 0
} vxt_volume_options;

/// No name, no bricks, no edits.
static inline vxt_volume_options vxt_volume_options_init(void) {
    vxt_volume_options options;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    return options;
}

/// An image of the caller's: voxtact::WrappedVolume.
typedef struct vxt_wrapped_volume {
    size_t struct_size;    ///< sizeof
    VkImageView view;      ///< 3D, one mip level, component r sampled
    VkFormat format;       ///< R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT or R32_SFLOAT
    VkImageLayout layout;  ///< SHADER_READ_ONLY_OPTIMAL, the default, or GENERAL; while commands execute
    vxt_grid grid;         ///< where its voxels are
    double slope;          ///< value = slope * stored + intercept; default 1
    double intercept;      ///< in the image's units; default 0
    vxt_range boundary;    ///< with has_boundary: all values of the voxels on the image's faces
    uint32_t has_boundary; ///< lets VXT_BOUNDARY_AUTO clamp; default 0
    uint32_t bricks;       ///< as in vxt_volume_options; default 0
} vxt_wrapped_volume;

/// Slope 1.
static inline vxt_wrapped_volume vxt_wrapped_volume_init(void) {
    vxt_wrapped_volume wrapped;
    memset(&wrapped, 0, sizeof wrapped);
    wrapped.struct_size = sizeof wrapped;
    wrapped.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    wrapped.grid = vxt_grid_init();
    wrapped.slope = 1;
    return wrapped;
}

/// What is known of a volume on the device.
typedef struct vxt_volume_info {
    size_t struct_size; ///< sizeof
    VkImageView view;   ///< 3D, in SHADER_READ_ONLY_OPTIMAL, or as it was wrapped
    vxt_grid grid;      ///< where the voxels are
    vxt_range range;    ///< with has_range: holds all voxels
    VkFormat format;    ///< of the image
    uint32_t has_range; ///< 0 for a wrapped volume, and after vxt_volume_cmd_copy()
} vxt_volume_info;

/// Nothing.
static inline vxt_volume_info vxt_volume_info_init(void) {
    vxt_volume_info info;
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    return info;
}

/// A 3D image on the device: voxtact::Volume.
typedef struct vxt_volume vxt_volume;
/// Makes it and fills a staging buffer; vxt_volume_cmd_upload() comes next. Null options are the defaults.
VXT_CHECKED vxt_result vxt_volume_create(const vxt_context* context, const vxt_volume_view* view,
                                         const vxt_volume_options* options, vxt_volume** volume);
/// Uses an image of the caller's, which must outlive it.
VXT_CHECKED vxt_result vxt_volume_wrap(const vxt_context* context, const vxt_wrapped_volume* wrapped,
                                       vxt_volume** volume);
/// Makes and uploads it in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_volume_upload(const vxt_context* context, const vxt_queue* queue,
                                         const vxt_volume_view* view, const vxt_volume_options* options,
                                         vxt_volume** volume);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_volume_cmd_upload(vxt_volume* volume, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of vxt_volume_cmd_upload() must be complete.
VXT_API void vxt_volume_release_staging(vxt_volume* volume);
/// Brings the bricks up to date after the caller changed voxels of a wrapped image.
VXT_CHECKED vxt_result vxt_volume_cmd_update_bricks(vxt_volume* volume, VkCommandBuffer commands,
                                                    const vxt_voxel_box* changed);
/// Gives the voxels of a box a value in the image's own units; takes effect in command-buffer order.
VXT_CHECKED vxt_result vxt_volume_cmd_set_box(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                              double value);
/// The same for the voxels whose centre is at most `radius` mm from a point of the world.
VXT_CHECKED vxt_result vxt_volume_cmd_set_ball(vxt_volume* volume, VkCommandBuffer commands, const double centre[3],
                                               double radius, double value);
/// Writes the voxels of a box: scalars of the volume's type, x fastest. They are kept in the command buffer.
VXT_CHECKED vxt_result vxt_volume_cmd_write(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                            const void* voxels, size_t bytes);
/// Copies the voxels of a box from a buffer of the caller's: voxtact::Volume::cmdCopy().
VXT_CHECKED vxt_result vxt_volume_cmd_copy(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                           VkBuffer source, VkDeviceSize offset);
/// What is known of it.
VXT_CHECKED vxt_result vxt_volume_get_info(const vxt_volume* volume, vxt_volume_info* info);
/// Ends it.
VXT_API void vxt_volume_destroy(vxt_volume* volume);

/// A table of the caller's: voxtact::WrappedTransferFunction.
typedef struct vxt_wrapped_transfer_function {
    size_t struct_size;   ///< sizeof
    VkImageView view;     ///< 1D, opacity in component r
    vxt_range domain;     ///< the values that the table covers; default 0..255
    const float* table;   ///< the same table on the host, where the caller has it; else null
    size_t table_size;    ///< entries of `table`
    VkImageLayout layout; ///< while commands execute; default SHADER_READ_ONLY_OPTIMAL
    uint32_t reserved;    ///< 0
} vxt_wrapped_transfer_function;

/// The domain 0..255.
static inline vxt_wrapped_transfer_function vxt_wrapped_transfer_function_init(void) {
    vxt_wrapped_transfer_function wrapped;
    memset(&wrapped, 0, sizeof wrapped);
    wrapped.struct_size = sizeof wrapped;
    wrapped.domain.hi = 255;
    wrapped.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return wrapped;
}

/// Value -> opacity, on the device: voxtact::TransferFunction.
typedef struct vxt_transfer_function vxt_transfer_function;
/// Makes it and fills a staging buffer. `name` appears on the Vulkan objects and may be null.
VXT_CHECKED vxt_result vxt_transfer_function_create(const vxt_context* context, const vxt_transfer_function_desc* desc,
                                                    const char* name, vxt_transfer_function** function);
/// Uses a table of the caller's, which must outlive it.
VXT_CHECKED vxt_result vxt_transfer_function_wrap(const vxt_context* context,
                                                  const vxt_wrapped_transfer_function* wrapped,
                                                  vxt_transfer_function** function);
/// Makes and uploads it in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_transfer_function_upload(const vxt_context* context, const vxt_queue* queue,
                                                    const vxt_transfer_function_desc* desc, const char* name,
                                                    vxt_transfer_function** function);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_transfer_function_cmd_upload(vxt_transfer_function* function, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_transfer_function_release_staging(vxt_transfer_function* function);
/// Records a new table of the same size; takes effect in command-buffer order.
VXT_CHECKED vxt_result vxt_transfer_function_cmd_update(vxt_transfer_function* function, VkCommandBuffer commands,
                                                        const vxt_transfer_function_desc* desc);
/// The values that the table covers, as recorded last.
VXT_CHECKED vxt_result vxt_transfer_function_domain(const vxt_transfer_function* function, vxt_range* domain);
/// Ends it.
VXT_API void vxt_transfer_function_destroy(vxt_transfer_function* function);

/// How a mesh is made: voxtact::MeshOptions.
typedef struct vxt_mesh_options {
    size_t struct_size; ///< sizeof
    const char* name;   ///< appears on the Vulkan objects; may be null
    uint32_t clusters;  ///< keeps clusters of triangles, for the projection CONSERVATIVE to skip; default 0
    uint32_t editable;  ///< allows vxt_mesh_cmd_update() and vxt_mesh_cmd_copy(); default 0
    /// Bytes from one vertex to the next on the device; at least 12, the default; a multiple of 4.
    uint32_t vertex_stride;
    uint32_t reserved; ///< 0
} vxt_mesh_options;

/// No name, no clusters, not editable, a stride of 12 bytes.
static inline vxt_mesh_options vxt_mesh_options_init(void) {
    vxt_mesh_options options;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.vertex_stride = 12;
    return options;
}

/// Buffers of the caller's: voxtact::WrappedMesh. Vertices are three floats at the start of a stride.
typedef struct vxt_wrapped_mesh {
    size_t struct_size;         ///< sizeof
    VkBuffer vertices;          ///< usage VERTEX_BUFFER
    VkDeviceSize vertex_offset; ///< bytes, of the first position; a multiple of 4
    VkBuffer indices;           ///< usage INDEX_BUFFER; null: every three vertices are a triangle
    VkDeviceSize index_offset;  ///< bytes
    uint32_t vertex_stride;     ///< bytes; at least 12, the default; a multiple of 4
    uint32_t vertex_count;      ///< vertices in the buffer
    VkIndexType index_type;     ///< UINT16 or UINT32, the default
    uint32_t triangle_count;    ///< triangles that are drawn
    uint32_t storage;           ///< the buffers also have usage STORAGE_BUFFER; default 0
    /// As in vxt_mesh_options; not to be used before vxt_mesh_cmd_upload(), and vxt_mesh_cmd_refit() after changes.
    uint32_t clusters;
    /// With clusters: the same triangles on the host, read by vxt_mesh_wrap() alone; null: they are clusters in their
    /// order.
    const vxt_mesh_view* shape;
} vxt_wrapped_mesh;

/// A stride of 12 bytes and 32-bit indices.
static inline vxt_wrapped_mesh vxt_wrapped_mesh_init(void) {
    vxt_wrapped_mesh wrapped;
    memset(&wrapped, 0, sizeof wrapped);
    wrapped.struct_size = sizeof wrapped;
    wrapped.vertex_stride = 12;
    wrapped.index_type = VK_INDEX_TYPE_UINT32;
    return wrapped;
}

/// A triangle mesh on the device: voxtact::Mesh.
typedef struct vxt_mesh vxt_mesh;
/// Makes it and fills a staging buffer. Null options are the defaults.
VXT_CHECKED vxt_result vxt_mesh_create(const vxt_context* context, const vxt_mesh_view* view,
                                       const vxt_mesh_options* options, vxt_mesh** mesh);
/// Uses buffers of the caller's, which must outlive it.
VXT_CHECKED vxt_result vxt_mesh_wrap(const vxt_context* context, const vxt_wrapped_mesh* wrapped, vxt_mesh** mesh);
/// Makes and uploads it in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_mesh_upload(const vxt_context* context, const vxt_queue* queue, const vxt_mesh_view* view,
                                       const vxt_mesh_options* options, vxt_mesh** mesh);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_mesh_cmd_upload(vxt_mesh* mesh, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_mesh_release_staging(vxt_mesh* mesh);
/// Bends an editable mesh: `vertex_count` vertices of three coordinates, as many as it has, come elsewhere, in
/// command-buffer order: voxtact::Mesh::cmdUpdate(). Refused, it is as it was.
VXT_CHECKED vxt_result vxt_mesh_cmd_update(vxt_mesh* mesh, VkCommandBuffer commands, const float* positions,
                                           size_t vertex_count);
/// The same from a buffer with usage TRANSFER_SRC, whose vertices are as far apart as those of the mesh; `offset` is in
/// bytes, a multiple of 4: voxtact::Mesh::cmdCopy().
VXT_CHECKED vxt_result vxt_mesh_cmd_copy(vxt_mesh* mesh, VkCommandBuffer commands, VkBuffer source,
                                         VkDeviceSize offset);
/// Fits the clusters of a wrapped mesh to what its buffers hold: voxtact::Mesh::cmdRefit().
VXT_CHECKED vxt_result vxt_mesh_cmd_refit(vxt_mesh* mesh, VkCommandBuffer commands);
/// How many triangles it has; 0 of null.
VXT_API uint32_t vxt_mesh_triangles(const vxt_mesh* mesh);
/// What was found out about it, of the vertices as they were recorded last; NOT_READY for a wrapped one, and after
/// vxt_mesh_cmd_copy().
VXT_CHECKED vxt_result vxt_mesh_get_facts(const vxt_mesh* mesh, vxt_mesh_facts* facts);
/// Ends it.
VXT_API void vxt_mesh_destroy(vxt_mesh* mesh);

/// A label map on the device: voxtact::LabelMap.
typedef struct vxt_label_map vxt_label_map;
/// Makes it and fills a staging buffer. `name` appears on the Vulkan objects and may be null.
VXT_CHECKED vxt_result vxt_label_map_create(const vxt_context* context, const vxt_labels* labels, const char* name,
                                            vxt_label_map** map);
/// Makes and uploads it in one: submits on `queue` and waits. Blocks.
VXT_CHECKED vxt_result vxt_label_map_upload(const vxt_context* context, const vxt_queue* queue,
                                            const vxt_labels* labels, const char* name, vxt_label_map** map);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_label_map_cmd_upload(vxt_label_map* map, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_label_map_release_staging(vxt_label_map* map);
/// The labels, by their numbers; valid as long as the object.
VXT_API const int32_t* vxt_label_map_values(const vxt_label_map* map, size_t* count);
/// Ends it.
VXT_API void vxt_label_map_destroy(vxt_label_map* map);

// Detection

/// What a detector is made for: voxtact::DetectorDesc.
typedef struct vxt_detector_desc {
    size_t struct_size;         ///< sizeof
    vxt_method method;          ///< default QUERY; CPU is refused
    vxt_projection projection;  ///< default VIEW
    vxt_filter filter;          ///< default HARDWARE
    vxt_boundary boundary;      ///< default AUTO
    double max_depth;           ///< mm, how far a contact's penetration is followed; default 10
    double resolution;          ///< CONSERVATIVE, voxels; 2^-12 to 1; default 1/64
    uint32_t outputs;           ///< bits of vxt_output; default none; the results need room for them
    uint32_t samples_per_voxel; ///< DOMINANT_AXIS: along a voxel's side; 1 to 16; default 1
    uint32_t stop_at_first;     ///< CONSERVATIVE: the count is then 0 or 1, a lower bound; default 0
    uint32_t overestimate;      ///< DOMINANT_AXIS: every pixel that a triangle touches gives a fragment; default 0
    uint32_t counters;          ///< CONSERVATIVE: what the passes do is counted, for vxt_answer_counters(); default 0
    uint32_t device_poses;      ///< items may have vxt_item::poses; the queue then needs compute, too; default 0
} vxt_detector_desc;

/// A view by precise queries.
static inline vxt_detector_desc vxt_detector_desc_init(void) {
    vxt_detector_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.max_depth = 10;
    desc.resolution = 1.0 / 64;
    desc.samples_per_voxel = 1;
    return desc;
}

/// Poses in a buffer of the caller's: voxtact::WrappedPoses. 16 floats each, column-major, which is a mat4 of std430.
typedef struct vxt_wrapped_poses {
    size_t struct_size;  ///< sizeof
    VkBuffer buffer;     ///< usage STORAGE_BUFFER
    VkDeviceSize offset; ///< bytes, of the first one; a multiple of 4
    VkDeviceSize stride; ///< bytes from one to the next; at least 64, the default; a multiple of 4
    double most_scale;   ///< no pose makes anything more than so many times as long; default 1. No answer depends on it
    uint32_t count;      ///< poses in the buffer; at least 1
    uint32_t reserved;   ///< 0
} vxt_wrapped_poses;

/// Rigid poses, one after the other.
static inline vxt_wrapped_poses vxt_wrapped_poses_init(void) {
    vxt_wrapped_poses wrapped;
    memset(&wrapped, 0, sizeof wrapped);
    wrapped.struct_size = sizeof wrapped;
    wrapped.stride = 64;
    wrapped.most_scale = 1;
    return wrapped;
}

/// Poses on the device, which are read when commands execute: voxtact::PoseBuffer.
typedef struct vxt_pose_buffer vxt_pose_buffer;
/// Uses a buffer of the caller's, which must outlive it. `name` may be null.
VXT_CHECKED vxt_result vxt_pose_buffer_wrap(const vxt_context* context, const vxt_wrapped_poses* wrapped,
                                            const char* name, vxt_pose_buffer** poses);
/// How many there are; 0 for null.
VXT_API uint32_t vxt_pose_buffer_count(const vxt_pose_buffer* poses);
/// Ends it.
VXT_API void vxt_pose_buffer_destroy(vxt_pose_buffer* poses);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_item {
    size_t struct_size;                             ///< sizeof
    const vxt_mesh* mesh;                           ///< outlives the command buffer, as the others do
    const vxt_volume* volume;                       ///< what is touched
    const vxt_transfer_function* transfer_function; ///< what of it is opaque
    const double* world_from_object;                ///< 16 doubles a pose; affine; read while recording only
    size_t pose_count;                              ///< poses: a pair each
    const vxt_label_map* labels;                    ///< for the outputs CONTACTS (optional) and LABELS; else null
    const vxt_pose_buffer* poses; ///< on the device: the first pose_count of them, world_from_object being null; for
                                  ///< detectors with device_poses. A pose that cannot be used is EXACTNESS_REFUSED
} vxt_item;

/// The pairs of one submission: the items in order, each with its poses in order.
typedef struct vxt_batch {
    size_t struct_size;    ///< sizeof
    const vxt_item* items; ///< any number; answers are in their order
    size_t item_count;     ///< of `items`
    const vxt_view* view;  ///< may be null for projections without a camera
    double threshold;      ///< 0..1: opacity from which a sample is opaque; default 0.1
} vxt_batch;

/// Nothing is given.
static inline vxt_item vxt_item_init(void) {
    vxt_item item;
    memset(&item, 0, sizeof item);
    item.struct_size = sizeof item;
    return item;
}

/// No items, and the threshold 0.1.
static inline vxt_batch vxt_batch_init(void) {
    vxt_batch batch;
    memset(&batch, 0, sizeof batch);
    batch.struct_size = sizeof batch;
    batch.threshold = 0.1;
    return batch;
}

/// How large results are, and what they keep: voxtact::ResultsDesc.
typedef struct vxt_results_desc {
    size_t struct_size;     ///< sizeof
    uint64_t triangle_room; ///< with outputs: the sum over the pairs of the triangles of their meshes; default 0
    uint64_t label_room;    ///< with outputs: the sum over the pairs of the labels of their label maps; default 0
    uint32_t contact_room;  ///< with outputs: a longer list is cut; default 2^16
    uint32_t outputs;       ///< not 0: there is room for outputs; default 0
    uint32_t max_pairs;     ///< pairs of the largest batch; default 1
    uint32_t read_back;     ///< a host copy is kept, for vxt_results_read(); default 1
    uint32_t timestamps;    ///< the device time is measured; default 0
    uint32_t queue_family;  ///< with timestamps: of the queue that will execute; default 0
    /// CONSERVATIVE: clusters that a dispatch looks at, at most, 16 to 16384: voxtact::ResultsDesc::clustersAtOnce.
    /// Default 0: by max_pairs. VXT_NO_CLUSTERS: none, for results that are for other projections.
    uint32_t clusters_at_once;
    uint32_t reserved; ///< 0
} vxt_results_desc;

/// For vxt_results_desc::clusters_at_once.
#define VXT_NO_CLUSTERS UINT32_C(0xffffffff)

/// One pair, read back, no outputs.
static inline vxt_results_desc vxt_results_desc_init(void) {
    vxt_results_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.contact_room = UINT32_C(1) << 16;
    desc.max_pairs = 1;
    desc.read_back = 1;
    return desc;
}

/// A part of a device buffer. The offset is a multiple of 256; the buffer is null where there is nothing.
typedef struct vxt_buffer_range {
    VkBuffer buffer;     ///< usage STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST
    VkDeviceSize offset; ///< bytes
    VkDeviceSize size;   ///< bytes
} vxt_buffer_range;

/// The answers of a batch on the device, for the next pass; as voxtact::Results has them, and device_results.h.
typedef enum vxt_device_part {
    VXT_DEVICE_PAIRS = 0,           ///< a PairResult for each pair
    VXT_DEVICE_TRIANGLE_COUNTS = 1, ///< a uint for each triangle of each pair
    VXT_DEVICE_TRIANGLE_MASK = 2,   ///< a bit for each triangle of each pair; each pair begins with a uint of its own
    VXT_DEVICE_CONTACTS = 3,        ///< four uints: found, low and high word; the room; 0. Then the ContactResults
    VXT_DEVICE_BOUNDS = 4,          ///< six uints for each pair
    VXT_DEVICE_LABEL_COUNTS = 5,    ///< a uint for each label of each pair
    VXT_DEVICE_MAX = 0x7fffffff     ///< makes the type 32 bits wide
} vxt_device_part;

/// Where the answers of one batch in flight go: voxtact::Results.
typedef struct vxt_results vxt_results;
/// Allocates the buffers.
VXT_CHECKED vxt_result vxt_results_create(const vxt_context* context, const vxt_results_desc* desc,
                                          vxt_results** results);
/// Where a part of the answers is on the device; nothing where there is no room for it.
VXT_CHECKED vxt_result vxt_results_on_device(const vxt_results* results, vxt_device_part part, vxt_buffer_range* range);
/// Records a copy of the results to host memory; after vxt_detector_cmd_detect().
VXT_CHECKED vxt_result vxt_results_cmd_read_back(vxt_results* results, VkCommandBuffer commands);
/// The host copy, of a submission that the caller knows to be complete; NOT_READY where it can be seen not to be. With
/// timestamps gpu_milliseconds is that of the batch.
VXT_CHECKED vxt_result vxt_results_read(vxt_results* results, vxt_answer* answer);
/// Ends it. Those of a ring are the ring's, and refused by doing nothing.
VXT_API void vxt_results_destroy(vxt_results* results);

/// What the passes of the projection CONSERVATIVE did for a batch: voxtact::CertifiedCounters, whose comments say of
/// what each is. Peaks are of the round that had most.
typedef struct vxt_certified_counters {
    size_t struct_size;       ///< sizeof
    uint64_t clusters;        ///< looked at, once for each pair
    uint64_t clusters_kept;   ///< of these, may touch
    uint64_t runs_kept;       ///< of 16 triangles, may touch
    uint64_t large_parts;     ///< shares of triangles with more than 27 cells
    uint64_t bricks_seen;     ///< of these triangles, looked at
    uint64_t cells_seen;      ///< looked at
    uint64_t cells_listed;    ///< of these, need a decision
    uint64_t cells_decided;   ///< by a lane each
    uint64_t lanes;           ///< dispatched for them
    uint64_t cells_open;      ///< left undecided by single precision
    uint64_t left;            ///< shares of work groups that a queue had no room for
    uint64_t bricks_left;     ///< looked at for these
    uint64_t cells_left;      ///< looked at for these
    uint32_t rounds;          ///< dispatches of each pass
    uint32_t room;            ///< clusters that a round can have
    uint32_t most_clusters;   ///< peak of clusters_kept
    uint32_t most_runs;       ///< peak of runs_kept
    uint32_t most_parts;      ///< peak of large_parts
    uint32_t most_cells;      ///< peak of cells_listed
    uint32_t most_open;       ///< peak of cells_open
    uint32_t most_left;       ///< peak of left
    uint32_t most_looks;      ///< peak of bricks_seen and cells_seen together
    uint32_t most_looks_left; ///< peak of bricks_left and cells_left together
} vxt_certified_counters;

/// Nothing.
static inline vxt_certified_counters vxt_certified_counters_init(void) {
    vxt_certified_counters counters;
    memset(&counters, 0, sizeof counters);
    counters.struct_size = sizeof counters;
    return counters;
}

/// Of an answer that a detector with vxt_detector_desc::counters gave; NOT_READY of any other.
VXT_CHECKED vxt_result vxt_answer_counters(const vxt_answer* answer, vxt_certified_counters* counters);

/// Results for frames in flight: voxtact::ResultRing.
typedef struct vxt_result_ring vxt_result_ring;
/// `frames`: how many may be in flight.
VXT_CHECKED vxt_result vxt_result_ring_create(const vxt_context* context, uint32_t frames, const vxt_results_desc* desc,
                                              vxt_result_ring** ring);
/// The slot of a frame, for recording; the ring's own, valid until its next vxt_result_ring_begin(). The caller knows
/// that the frame that had the slot before has completed.
VXT_CHECKED vxt_result vxt_result_ring_begin(vxt_result_ring* ring, uint64_t frame, vxt_results** results);
/// The results of a completed frame; NOT_READY when its slot was never used, or has been taken by a later frame.
VXT_CHECKED vxt_result vxt_result_ring_read(vxt_result_ring* ring, uint64_t frame, vxt_answer* answer);
/// Ends it and its results.
VXT_API void vxt_result_ring_destroy(vxt_result_ring* ring);

/// Decides which pairs touch: voxtact::Detector.
typedef struct vxt_detector vxt_detector;
/// UNSUPPORTED, with the missing feature or limit named, when the device cannot do it.
VXT_CHECKED vxt_result vxt_detector_create(const vxt_context* context, const vxt_detector_desc* desc,
                                           vxt_detector** detector);
/// Records the detection of a batch: no allocation of device memory, no submission, no wait, no map. On error nothing
/// useful was recorded, and the command buffer must not be submitted.
VXT_CHECKED vxt_result vxt_detector_cmd_detect(const vxt_detector* detector, VkCommandBuffer commands,
                                               const vxt_batch* batch, vxt_results* results);
/// Which variant VXT_BOUNDARY_AUTO takes for an item at a threshold.
VXT_CHECKED vxt_result vxt_detector_boundary_for(const vxt_detector* detector, const vxt_item* item, double threshold,
                                                 vxt_boundary* boundary);
/// Ends it.
VXT_API void vxt_detector_destroy(vxt_detector* detector);

/// Records, submits on the caller's queue, waits and reads: voxtact::BlockingDetector.
typedef struct vxt_blocking_detector vxt_blocking_detector;
/// A list of contacts is cut beyond `most_contacts`; 0 is 2^16.
VXT_CHECKED vxt_result vxt_blocking_detector_create(const vxt_context* context, const vxt_detector_desc* desc,
                                                    const vxt_queue* queue, uint32_t most_contacts,
                                                    vxt_blocking_detector** detector);
/// Answers for every pair. Blocks. After a failure `answer` holds what it held.
VXT_CHECKED vxt_result vxt_blocking_detector_detect(vxt_blocking_detector* detector, const vxt_batch* batch,
                                                    vxt_answer* answer);
/// Ends it.
VXT_API void vxt_blocking_detector_destroy(vxt_blocking_detector* detector);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_H
#define VOXTACT_VOXTACT_VULKAN_H

#include "voxtact/device_memory.h"
#include "voxtact/voxtact.h"

#include <vulkan/vulkan_core.h>

/// @file
/// voxtact on a Vulkan device, in C: context, scene, detectors, pictures. The conventions of voxtact.h apply.
///
/// Recording: context.h, scene.h, detector.h and render.h document the required and resulting states of each
/// `..._cmd_...()` function, and the bound state it loses. Recorded edits take effect in command-buffer order.
///
/// Uploads: `vxt_x_create()` fills a staging buffer, `vxt_x_cmd_upload()` records the copy to the device, and
/// `vxt_x_release_staging()` frees the staging buffer, once the submission is complete. `vxt_x_upload()` does all
/// three: it submits on `queue` and waits.
///
/// Handles: Vulkan handles are the caller's: no function frees, writes or transitions them. A wrapped handle must
/// outlive its wrapper. `name` appears on the Vulkan objects and may be null. Objects keep the parts of the context
/// that they need, so they can be destroyed in any order, before the device.

#ifdef __cplusplus
extern "C" {
#endif

// ======== Context on the device of the caller ========

/// Receives a log line. `text` is valid during the call only. Called from any thread that calls voxtact.
typedef void (*vxt_log_callback)(void* user, const char* text);

/// The caller's device: voxtact::ContextDesc. Handles, loader, allocator and callbacks must outlive all objects that
/// are created with the context.
typedef struct vxt_context_desc {
    size_t struct_size;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;  ///< the caller's loader
    VkInstance instance;                               ///< the caller's instance
    VkPhysicalDevice physical_device;                  ///< physical device of `device`
    VkDevice device;                                   ///< the caller's device
    const VkPhysicalDeviceFeatures2* enabled_features; ///< the feature chain passed to vkCreateDevice
    const char* const* enabled_instance_extensions;    ///< only VK_EXT_debug_utils matters
    size_t enabled_instance_extension_count;           ///< length of enabled_instance_extensions
    const char* const* enabled_device_extensions;      ///< only vxt_optional_device_extensions() matter
    size_t enabled_device_extension_count;             ///< length of enabled_device_extensions
    VkPipelineCache pipeline_cache;                    ///< optional
    const VkAllocationCallbacks* allocator;            ///< optional
    vxt_log_callback log;                              ///< optional; receives warnings, one line each
    void* log_user;                                    ///< first argument of `log`
    uint32_t api_version;                              ///< of the instance; at least VK_API_VERSION_1_3
    const uint32_t* queue_families;                    ///< families of all queues that use the objects
    size_t queue_family_count;                         ///< length of queue_families
    uint64_t fragments_at_once;                        ///< per draw: voxtact::ContextDesc::fragmentsAtOnce
    vxt_memory_callbacks memory;                       ///< optional: the caller's allocator of device memory
} vxt_context_desc;

/// A feature that voxtact uses: voxtact::Requirement. Its texts have static lifetime.
typedef struct vxt_requirement {
    const char* feature;   ///< member of `structure`, as Vulkan spells it
    const char* structure; ///< e.g. "VkPhysicalDeviceVulkan13Features"
    const char* without;   ///< loss without the feature
    uint32_t required;     ///< 1: required; 0: recommended
} vxt_requirement;

/// Returns the number of requirements.
VXT_API size_t vxt_requirement_count(void);
/// Returns a requirement by index, in the order of vxt_check().
VXT_CHECKED vxt_result vxt_requirement_get(size_t index, vxt_requirement* requirement);
/// Returns the device extensions that voxtact can use; no method needs them.
VXT_API const char* const* vxt_optional_device_extensions(size_t* count);

/// A feature chain for vkCreateDevice: voxtact::FeatureRequest.
typedef struct vxt_features vxt_features;
/// Creates a chain of the requirements that `supported` (vkGetPhysicalDeviceFeatures2) offers; null: required ones.
VXT_CHECKED vxt_result vxt_features_create(const VkPhysicalDeviceFeatures2* supported, vxt_features** features);
/// Returns the chain: VkPhysicalDeviceFeatures2, Vulkan12Features, Vulkan13Features. Set your own features
/// in their members, and append your own structs.
VXT_API VkPhysicalDeviceFeatures2* vxt_features_chain(vxt_features* features);
VXT_API void vxt_features_destroy(vxt_features* features);

/// A queue of the caller for blocking calls: voxtact::QueueAccess.
typedef struct vxt_queue {
    size_t struct_size;
    VkQueue queue;              ///< a queue of the context's device
    void (*lock)(void* user);   ///< called before each submission; may be null
    void (*unlock)(void* user); ///< called after each submission; may be null
    void* user;                 ///< the argument of both
    uint32_t family;            ///< family of the queue; with graphics or, for uploads, compute
} vxt_queue;

/// Creates a context, voxtact on one device: voxtact::Context. A process may have any number of contexts.
VXT_CHECKED vxt_result vxt_context_create(const vxt_context_desc* desc, vxt_context** context);
/// Returns 1 if the device supports a counting method in a projection.
VXT_API uint32_t vxt_context_supports(const vxt_context* context, vxt_method method, vxt_projection projection);
/// Returns the method with the fewest requirements: query, else atomic, else query-any.
VXT_API vxt_method vxt_context_default_method(const vxt_context* context);
/// Returns the largest viewport.
VXT_API VkExtent2D vxt_context_max_viewport(const vxt_context* context);
/// Returns 1 if any call has seen VK_ERROR_DEVICE_LOST; every later call fails with VXT_ERROR_DEVICE_LOST.
VXT_API uint32_t vxt_context_device_lost(const vxt_context* context);
/// Destroys the object; objects created with it remain valid.
VXT_API void vxt_context_destroy(vxt_context* context);

/// A Vulkan device that the library owns: an instance, a device with one queue, and a context. Opening it loads the
/// Vulkan loader. A child process cannot use a device that was opened before fork().
typedef struct vxt_device vxt_device;
/// Facts of a device of the machine.
typedef struct vxt_device_facts {
    size_t struct_size;
    char name[256];       ///< name of the driver's device
    char driver[520];     ///< name and version of the driver
    const char* type;     ///< "discrete", "integrated", "virtual", "cpu" or "other"
    uint32_t index;       ///< index of the device
    uint32_t api_version; ///< as VK_MAKE_API_VERSION packs it
} vxt_device_facts;
/// Returns the number of devices. UNSUPPORTED without a loader or a device.
VXT_CHECKED vxt_result vxt_device_count(uint32_t* count);
/// Returns the facts of a device by index.
VXT_CHECKED vxt_result vxt_device_describe(uint32_t index, vxt_device_facts* facts);
/// Opens a device: `wanted` is its index, a part of its name, or "" for the best. Refuses a name that fits no device or
/// several; the error lists the devices. UNSUPPORTED without a loader, a device or Vulkan 1.3.
VXT_CHECKED vxt_result vxt_device_open(const char* wanted, vxt_device** device);
/// Returns the facts of the device.
VXT_CHECKED vxt_result vxt_device_get_facts(const vxt_device* device, vxt_device_facts* facts);
/// Returns the device's context; null for null.
VXT_API const vxt_context* vxt_device_context(const vxt_device* device);
/// Returns the device's queue for blocking calls.
VXT_CHECKED vxt_result vxt_device_queue(const vxt_device* device, vxt_queue* queue);
/// Begins recording commands. One thread at a time, until vxt_device_submit().
VXT_CHECKED vxt_result vxt_device_begin(vxt_device* device, VkCommandBuffer* commands);
/// Submits the recorded commands, and waits.
VXT_CHECKED vxt_result vxt_device_submit(vxt_device* device);
/// Destroys the object. All objects created with it must have been destroyed.
VXT_API void vxt_device_destroy(vxt_device* device);

/// State of a counting method on a device.
typedef struct vxt_method_report {
    const char* text;   ///< reason if not available or not trusted, or the counts; may be empty
    vxt_method method;  ///< the method
    uint32_t available; ///< 1: a detector can use it
    uint32_t trusted;   ///< 1: vxt_self_test() found every count correct
} vxt_method_report;

/// Contents of a report of vxt_check() or vxt_self_test().
typedef struct vxt_report_view {
    size_t struct_size;
    const char* const* missing;       ///< vxt_check(): one line each: the missing requirement, and the loss
    size_t missing_count;             ///< length of `missing`
    const vxt_method_report* methods; ///< every counting method of a device
    size_t method_count;              ///< length of `methods`
    uint32_t usable;                  ///< 1: a context can be created
} vxt_report_view;

/// A report on a device.
typedef struct vxt_report vxt_report;
/// Returns the contents.
VXT_CHECKED vxt_result vxt_report_get(const vxt_report* report, vxt_report_view* view);
VXT_API void vxt_report_destroy(vxt_report* report);
/// Reports the methods that a detector can use on this device, and the reasons against the others.
VXT_CHECKED vxt_result vxt_context_methods(const vxt_context* context, vxt_report** report);
/// Checks a description without creating anything. Problems of the device are in the report, not in the result.
VXT_CHECKED vxt_result vxt_check(const vxt_context_desc* desc, vxt_report** report);
/// Counts a known number of fragments by each method: voxtact::selfTest(). Blocks.
VXT_CHECKED vxt_result vxt_self_test(const vxt_context* context, const vxt_queue* queue, vxt_report** report);

// ======== Scene ========

/// Options of a volume: voxtact::VolumeOptions.
typedef struct vxt_volume_options {
    size_t struct_size;
    const char* name;  ///< of the Vulkan objects
    uint32_t bricks;   ///< keeps the range of values of every brick of 8^3 cells, for CERTIFIED
    uint32_t editable; ///< allows edits
} vxt_volume_options;

/// An image that the caller owns: voxtact::WrappedVolume.
typedef struct vxt_wrapped_volume {
    size_t struct_size;
    VkImageView view; ///< 3D, one mip level, component r sampled
    VkFormat format;  ///< R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT or R32_SFLOAT
    /// Layout while commands execute: READ_ONLY_OPTIMAL or GENERAL; 0: SHADER_READ_ONLY_OPTIMAL.
    VkImageLayout layout;
    vxt_grid grid;         ///< position of the voxels
    double slope;          ///< value = slope * stored + intercept; 0: 1
    double intercept;      ///< image value of the stored 0
    vxt_range boundary;    ///< with has_boundary: contains the values of the voxels on the image's faces
    uint32_t has_boundary; ///< lets VXT_BOUNDARY_AUTO clamp
    uint32_t bricks;       ///< as in vxt_volume_options
} vxt_wrapped_volume;

/// Facts of a volume on the device.
typedef struct vxt_volume_info {
    size_t struct_size;
    VkImageView view;   ///< 3D, in SHADER_READ_ONLY_OPTIMAL, or as it was wrapped
    vxt_grid grid;      ///< position of the voxels
    vxt_range range;    ///< with has_range: contains all voxels
    VkFormat format;    ///< of the image
    uint32_t has_range; ///< 0 for a wrapped volume, and after vxt_volume_cmd_copy()
} vxt_volume_info;

/// A 3D image on the device: voxtact::Volume.
typedef struct vxt_volume vxt_volume;
/// Copies the voxels into a staging buffer.
VXT_CHECKED vxt_result vxt_volume_create(const vxt_context* context, const vxt_volume_view* view,
                                         const vxt_volume_options* options, vxt_volume** volume);
/// Uses an image of the caller.
VXT_CHECKED vxt_result vxt_volume_wrap(const vxt_context* context, const vxt_wrapped_volume* wrapped,
                                       vxt_volume** volume);
VXT_CHECKED vxt_result vxt_volume_upload(const vxt_context* context, const vxt_queue* queue,
                                         const vxt_volume_view* view, const vxt_volume_options* options,
                                         vxt_volume** volume);
VXT_CHECKED vxt_result vxt_volume_cmd_upload(vxt_volume* volume, VkCommandBuffer commands);
VXT_API void vxt_volume_release_staging(vxt_volume* volume);
/// Updates the bricks after the caller changed voxels of a wrapped image.
VXT_CHECKED vxt_result vxt_volume_cmd_update_bricks(vxt_volume* volume, VkCommandBuffer commands,
                                                    const vxt_voxel_box* changed);
/// Sets the voxels of a box to a value.
VXT_CHECKED vxt_result vxt_volume_cmd_set_box(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                              double value);
/// Sets the voxels whose centre is within `radius` mm of a world point to a value.
VXT_CHECKED vxt_result vxt_volume_cmd_set_ball(vxt_volume* volume, VkCommandBuffer commands, const double centre[3],
                                               double radius, double value);
/// Writes the voxels of a box: scalars of the volume's type, x fastest. The command buffer holds the data.
VXT_CHECKED vxt_result vxt_volume_cmd_write(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                            const void* voxels, size_t bytes);
/// Copies the voxels of a box from a buffer of the caller: voxtact::Volume::cmdCopy().
VXT_CHECKED vxt_result vxt_volume_cmd_copy(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                           VkBuffer source, VkDeviceSize offset);
/// Returns the facts of the volume.
VXT_CHECKED vxt_result vxt_volume_get_info(const vxt_volume* volume, vxt_volume_info* info);
VXT_API void vxt_volume_destroy(vxt_volume* volume);

/// A table that the caller owns: voxtact::WrappedTransferFunction.
typedef struct vxt_wrapped_transfer_function {
    size_t struct_size;
    VkImageView view;     ///< 1D, opacity in component r
    vxt_range domain;     ///< values that the table covers; lo < hi
    const float* table;   ///< the same table on the host, required by `certified`; may be null
    size_t table_size;    ///< entries of `table`
    VkImageLayout layout; ///< while commands execute; 0: SHADER_READ_ONLY_OPTIMAL
} vxt_wrapped_transfer_function;

/// Value -> opacity, on the device: voxtact::TransferFunction.
typedef struct vxt_transfer_function vxt_transfer_function;
/// Computes the table in a staging buffer.
VXT_CHECKED vxt_result vxt_transfer_function_create(const vxt_context* context, const vxt_transfer_function_desc* desc,
                                                    const char* name, vxt_transfer_function** function);
/// Uses a table of the caller.
VXT_CHECKED vxt_result vxt_transfer_function_wrap(const vxt_context* context,
                                                  const vxt_wrapped_transfer_function* wrapped,
                                                  vxt_transfer_function** function);
VXT_CHECKED vxt_result vxt_transfer_function_upload(const vxt_context* context, const vxt_queue* queue,
                                                    const vxt_transfer_function_desc* desc, const char* name,
                                                    vxt_transfer_function** function);
VXT_CHECKED vxt_result vxt_transfer_function_cmd_upload(vxt_transfer_function* function, VkCommandBuffer commands);
VXT_API void vxt_transfer_function_release_staging(vxt_transfer_function* function);
/// Records a new table of the same size.
VXT_CHECKED vxt_result vxt_transfer_function_cmd_update(vxt_transfer_function* function, VkCommandBuffer commands,
                                                        const vxt_transfer_function_desc* desc);
/// Returns the values that the table covers, as last recorded.
VXT_CHECKED vxt_result vxt_transfer_function_domain(const vxt_transfer_function* function, vxt_range* domain);
VXT_API void vxt_transfer_function_destroy(vxt_transfer_function* function);

/// Options of a mesh: voxtact::MeshOptions.
typedef struct vxt_mesh_options {
    size_t struct_size;
    const char* name;  ///< of the Vulkan objects
    uint32_t clusters; ///< keeps clusters of triangles, which the projection CERTIFIED culls
    uint32_t editable; ///< allows vxt_mesh_cmd_update() and vxt_mesh_cmd_copy()
    /// Bytes from vertex to vertex on the device; at least 12; a multiple of 4; 0: 12. For drawing, at most the
    /// device's maxVertexInputBindingStride.
    uint32_t vertex_stride;
} vxt_mesh_options;

/// Buffers that the caller owns: voxtact::WrappedMesh. Vertices are three floats at the start of a stride.
typedef struct vxt_wrapped_mesh {
    size_t struct_size;
    VkBuffer vertices;          ///< usage VERTEX_BUFFER
    VkDeviceSize vertex_offset; ///< bytes to the first position; a multiple of 4
    VkBuffer indices;           ///< usage INDEX_BUFFER; null: every three vertices form a triangle
    VkDeviceSize index_offset;  ///< bytes
    uint32_t vertex_stride;     ///< bytes; 0: 12
    uint32_t vertex_count;      ///< vertices in the buffer
    VkIndexType index_type;     ///< UINT16, which is 0, or UINT32
    uint32_t triangle_count;    ///< triangles to draw
    uint32_t storage;           ///< 1: the buffers also have usage STORAGE_BUFFER
    /// As in vxt_mesh_options. Call vxt_mesh_cmd_upload() before use, and vxt_mesh_cmd_refit() after changes.
    uint32_t clusters;
    /// With clusters: the same triangles on the host, read by vxt_mesh_wrap() only; null: clusters in the order of the
    /// triangles.
    const vxt_mesh_view* shape;
} vxt_wrapped_mesh;

/// A triangle mesh on the device: voxtact::Mesh.
typedef struct vxt_mesh vxt_mesh;
/// Copies the arrays into a staging buffer.
VXT_CHECKED vxt_result vxt_mesh_create(const vxt_context* context, const vxt_mesh_view* view,
                                       const vxt_mesh_options* options, vxt_mesh** mesh);
/// Uses buffers of the caller.
VXT_CHECKED vxt_result vxt_mesh_wrap(const vxt_context* context, const vxt_wrapped_mesh* wrapped, vxt_mesh** mesh);
VXT_CHECKED vxt_result vxt_mesh_upload(const vxt_context* context, const vxt_queue* queue, const vxt_mesh_view* view,
                                       const vxt_mesh_options* options, vxt_mesh** mesh);
VXT_CHECKED vxt_result vxt_mesh_cmd_upload(vxt_mesh* mesh, VkCommandBuffer commands);
VXT_API void vxt_mesh_release_staging(vxt_mesh* mesh);
/// Moves all vertices of an editable mesh, three coordinates each: voxtact::Mesh::cmdUpdate().
VXT_CHECKED vxt_result vxt_mesh_cmd_update(vxt_mesh* mesh, VkCommandBuffer commands, const double* positions,
                                           size_t vertex_count);
/// Like vxt_mesh_cmd_update(), from a buffer with usage TRANSFER_SRC and the mesh's vertex stride; `offset` in bytes, a
/// multiple of 4: voxtact::Mesh::cmdCopy().
VXT_CHECKED vxt_result vxt_mesh_cmd_copy(vxt_mesh* mesh, VkCommandBuffer commands, VkBuffer source,
                                         VkDeviceSize offset);
/// Refits the clusters of a wrapped mesh to the contents of its buffers: voxtact::Mesh::cmdRefit().
VXT_CHECKED vxt_result vxt_mesh_cmd_refit(vxt_mesh* mesh, VkCommandBuffer commands);
/// Returns the number of triangles; 0 for null.
VXT_API uint32_t vxt_mesh_triangles(const vxt_mesh* mesh);
/// Returns the facts of the vertices as last recorded; NOT_READY for a wrapped mesh, and after vxt_mesh_cmd_copy().
VXT_CHECKED vxt_result vxt_mesh_get_facts(const vxt_mesh* mesh, vxt_mesh_facts* facts);
VXT_API void vxt_mesh_destroy(vxt_mesh* mesh);

/// A label map on the device: voxtact::LabelMap.
typedef struct vxt_label_map vxt_label_map;
/// Copies the labels into a staging buffer.
VXT_CHECKED vxt_result vxt_label_map_create(const vxt_context* context, const vxt_labels* labels, const char* name,
                                            vxt_label_map** map);
VXT_CHECKED vxt_result vxt_label_map_upload(const vxt_context* context, const vxt_queue* queue,
                                            const vxt_labels* labels, const char* name, vxt_label_map** map);
VXT_CHECKED vxt_result vxt_label_map_cmd_upload(vxt_label_map* map, VkCommandBuffer commands);
VXT_API void vxt_label_map_release_staging(vxt_label_map* map);
/// Returns the labels by index.
VXT_API const int32_t* vxt_label_map_values(const vxt_label_map* map, size_t* count);
VXT_API void vxt_label_map_destroy(vxt_label_map* map);

// ======== Answers in device memory ========

/// The answer for one pair: voxtact::PairAnswer.
typedef struct vxt_pair {
    uint64_t count;            ///< passing fragments; 1 for a touch by a boolean query or an early exit
    uint32_t pair;             ///< index of the pair in its batch
    uint32_t item;             ///< index of the item of the pair
    uint32_t pose;             ///< index of the pose in that item
    uint32_t hit;              ///< at least one passing fragment: the pair certainly touches
    uint32_t possible;         ///< undecided: no passing fragment, but undecided fragments
    vxt_exactness exactness;   ///< meaning of the count
    vxt_method method;         ///< method that counted
    vxt_projection projection; ///< projection that made the fragments
} vxt_pair;

/// The answer for one pair in device memory: PairResult of device_results.h, which is for C++ and GLSL.
typedef struct vxt_device_pair {
    uint32_t count_low;  ///< passing fragments, low 32 bits
    uint32_t count_high; ///< passing fragments, high 32 bits
    uint32_t pair;       ///< index of the pair in its batch
    uint32_t item;       ///< index of the item of the pair
    uint32_t pose;       ///< index of the pose in that item
    uint32_t how;        ///< method, projection, exactness and more, packed
} vxt_device_pair;

/// A contact in device memory: ContactResult of device_results.h.
typedef struct vxt_device_contact {
    float position[3]; ///< world, mm
    float normal[3];   ///< unit vector, or zero
    float depth;       ///< mm
    float value;       ///< image value, in its own units
    float opacity;     ///< opacity of that value, 0..1
    uint32_t pair;     ///< index of the pair in its batch
    uint32_t triangle; ///< index of the triangle in the mesh
    uint32_t label;    ///< index of the label in the label map's values; 0 without a label map
} vxt_device_contact;

/// Unpacks a device pair: voxtact::unpack().
VXT_CHECKED vxt_result vxt_unpack(const vxt_device_pair* packed, vxt_pair* pair);

// ======== Detectors ========

/// Options of a certified detector: voxtact::CertifiedDesc.
typedef struct vxt_certified_desc {
    size_t struct_size;     ///< sizeof this struct
    double max_depth;       ///< mm: maximum depth of a contact; 0: 10
    double resolution;      ///< voxels; 2^-12 to 1; 0: 1/64
    uint32_t outputs;       ///< bits of vxt_output; default none; vxt_results_desc has their capacity
    uint32_t stop_at_first; ///< early exit, without outputs: the count is 0 or 1, a lower bound; default 0
    uint32_t counters;      ///< counts the work of the passes, for vxt_answer_counters(); default 0
    uint32_t device_poses;  ///< allows vxt_item::poses: voxtact::CertifiedDesc::devicePoses; default 0
} vxt_certified_desc;

/// Options of a detector that counts the fragments of a rasterisation: voxtact::RasterDesc.
typedef struct vxt_raster_desc {
    size_t struct_size;         ///< sizeof this struct
    vxt_method method;          ///< default QUERY; CPU is refused
    vxt_projection projection;  ///< default VIEW; CERTIFIED is refused
    vxt_filter filter;          ///< default HARDWARE
    vxt_boundary boundary;      ///< default AUTO
    double max_depth;           ///< mm: maximum depth of a contact; 0: 10
    uint32_t outputs;           ///< bits of vxt_output; default none; vxt_results_desc has their capacity
    uint32_t samples_per_voxel; ///< DOMINANT_AXIS: per voxel side; 1 to 16; 0: 1
    uint32_t overestimate;      ///< DOMINANT_AXIS: every pixel that a triangle touches gives a fragment; default 0
    uint32_t device_poses;      ///< allows vxt_item::poses: voxtact::CertifiedDesc::devicePoses; default 0
} vxt_raster_desc;

/// Poses in a buffer of the caller: voxtact::WrappedPoses. 16 floats each, column-major: a mat4 of std430.
typedef struct vxt_wrapped_poses {
    size_t struct_size;  ///< sizeof this struct
    VkBuffer buffer;     ///< usage STORAGE_BUFFER
    VkDeviceSize offset; ///< bytes to the first pose; a multiple of 4
    VkDeviceSize stride; ///< bytes from pose to pose; at least 64; a multiple of 4; 0: 64
    double max_scale;    ///< upper bound of the scaling by any pose; 0: 1. No answer depends on it
    uint32_t count;      ///< poses in the buffer; at least 1
} vxt_wrapped_poses;

/// Poses on the device, read when commands execute: voxtact::PoseBuffer.
typedef struct vxt_pose_buffer vxt_pose_buffer;
/// Uses a buffer of the caller, which must outlive it. `name` may be null.
VXT_CHECKED vxt_result vxt_pose_buffer_wrap(const vxt_context* context, const vxt_wrapped_poses* wrapped,
                                            const char* name, vxt_pose_buffer** poses);
/// Returns the number of poses; 0 for null.
VXT_API uint32_t vxt_pose_buffer_count(const vxt_pose_buffer* poses);
VXT_API void vxt_pose_buffer_destroy(vxt_pose_buffer* poses);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_item {
    size_t struct_size;                             ///< sizeof this struct
    const vxt_mesh* mesh;                           ///< must outlive the command buffer, like all objects
    const vxt_volume* volume;                       ///< the image
    const vxt_transfer_function* transfer_function; ///< defines the opaque region
    const double* world_from_object;                ///< 16 doubles per pose; affine; read during recording only
    size_t pose_count;                              ///< number of poses; one pair each
    const vxt_label_map* labels;                    ///< for the outputs CONTACTS (optional) and LABELS
    const vxt_pose_buffer* poses; ///< with device_poses, instead of world_from_object; unusable ones: EXACTNESS_REFUSED
} vxt_item;

/// The pairs of one submission: the items in order, each with its poses in order.
typedef struct vxt_batch {
    size_t struct_size;    ///< sizeof this struct
    const vxt_item* items; ///< any number; the answers have the same order
    size_t item_count;     ///< length of `items`
    const vxt_view* view;  ///< may be null for projections without a camera
    double threshold;      ///< above 0, up to 1: opacity at which a value is opaque; 0: 0.1
} vxt_batch;

/// A part of a device buffer with the usage STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST. The buffer is null for an
/// empty part.
typedef struct vxt_buffer_range {
    VkBuffer buffer;     ///< null: empty
    VkDeviceSize offset; ///< bytes
    VkDeviceSize size;   ///< bytes
} vxt_buffer_range;

/// Capacity of results: voxtact::ResultsDesc. Each output of the detector needs its capacity; others are ignored.
typedef struct vxt_results_desc {
    size_t struct_size;     ///< sizeof this struct
    uint64_t triangle_room; ///< output TRIANGLES: triangles of all pairs' meshes together
    uint64_t label_room;    ///< output LABELS: labels of all pairs' label maps together
    uint32_t contact_room;  ///< output CONTACTS: maximum number; a longer list is cut; 0: 2^16
    uint32_t max_pairs;     ///< maximum pairs per batch; 0 means 1
    uint32_t no_read_back;  ///< 1: no host copy for vxt_results_read()
    uint32_t timestamps;    ///< 1: measures the device time; default 0
    uint32_t queue_family;  ///< with timestamps: family of the executing queue; default 0
    /// Certified detectors: maximum clusters per dispatch, 16 to 262144: voxtact::ResultsDesc::clustersAtOnce. Default
    /// 0: chosen by max_pairs.
    uint32_t clusters_at_once;
    uint32_t staged; ///< 1: voxtact::ResultsDesc::staged, with its conditions for the caller; default 0
    /// Destination of the answers, one PairResult per pair: a part of a buffer of the caller, which outlives the
    /// results: voxtact::ResultsDesc::into. Default null: an internal buffer.
    vxt_buffer_range into;
} vxt_results_desc;

/// Returns the bytes from one frame's answers to the next in vxt_results_desc::into: voxtact::resultBytes().
static inline VkDeviceSize vxt_result_bytes(uint32_t max_pairs) {
    return (UINT64_C(24) * max_pairs + 255) / 256 * 256;
}

/// Answers of a batch on the device, for the next pass; see voxtact::Results and device_results.h.
typedef enum vxt_device_part {
    VXT_DEVICE_PAIRS = 0,           ///< a PairResult per pair
    VXT_DEVICE_TRIANGLE_COUNTS = 1, ///< a uint per triangle of each pair
    VXT_DEVICE_TRIANGLE_MASK = 2,   ///< a bit per triangle of each pair; each pair begins with its own uint
    VXT_DEVICE_CONTACTS = 3,        ///< four uints: found, low and high word; the capacity; 0. Then the ContactResults
    VXT_DEVICE_BOUNDS = 4,          ///< six uints per pair
    VXT_DEVICE_LABEL_COUNTS = 5,    ///< a uint per label of each pair
    VXT_DEVICE_MAX = 0x7fffffff     ///< makes the type 32 bits wide
} vxt_device_part;

/// Decides which pairs touch: voxtact::Detector.
typedef struct vxt_detector vxt_detector;

/// Destination of the answers of one batch in flight: voxtact::Results.
typedef struct vxt_results vxt_results;
/// Allocates the buffers for batches of a detector: voxtact::Results::create(). A null `desc` has all defaults.
VXT_CHECKED vxt_result vxt_results_create(const vxt_detector* detector, const vxt_results_desc* desc,
                                          vxt_results** results);
/// Returns a part of the answers on the device; empty without capacity for it.
VXT_CHECKED vxt_result vxt_results_on_device(const vxt_results* results, vxt_device_part part, vxt_buffer_range* range);
/// Records a copy of the results to host memory; after vxt_detector_cmd_detect().
VXT_CHECKED vxt_result vxt_results_cmd_read_back(vxt_results* results, VkCommandBuffer commands);
/// Reads the host copy of a completed submission; NOT_READY if the copy visibly has not executed. With timestamps,
/// gpu_milliseconds is the device time of the batch.
VXT_CHECKED vxt_result vxt_results_read(vxt_results* results, vxt_answer* answer);
/// Destroys the object. Ignores the results of a ring, which the ring owns.
VXT_API void vxt_results_destroy(vxt_results* results);

/// Counters of the passes of the projection CERTIFIED for a batch: voxtact::CertifiedCounters, whose comments describe
/// them. A peak is the maximum over all rounds.
typedef struct vxt_certified_counters {
    size_t struct_size;       ///< sizeof this struct
    uint64_t clusters;        ///< tested clusters, counted once per pair
    uint64_t clusters_kept;   ///< tested clusters that may touch
    uint64_t runs_kept;       ///< runs of 16 triangles that may touch
    uint64_t large_parts;     ///< shares of triangles with more than 27 cells
    uint64_t bricks_seen;     ///< tested bricks of these triangles
    uint64_t cells_seen;      ///< tested cells
    uint64_t cells_listed;    ///< of cells_seen: cells that need a decision
    uint64_t cells_decided;   ///< cells that a lane decided
    uint64_t lanes;           ///< lanes dispatched for these cells
    uint64_t cells_open;      ///< cells that single precision left undecided
    uint64_t left;            ///< shares of work groups for which a queue had no room
    uint64_t bricks_left;     ///< bricks tested for these shares
    uint64_t cells_left;      ///< cells tested for these shares
    uint32_t rounds;          ///< dispatches of each pass
    uint32_t room;            ///< maximum number of clusters in a round
    uint32_t peak_clusters;   ///< peak of clusters_kept
    uint32_t peak_runs;       ///< peak of runs_kept
    uint32_t peak_parts;      ///< peak of large_parts
    uint32_t peak_cells;      ///< peak of cells_listed
    uint32_t peak_open;       ///< peak of cells_open
    uint32_t peak_left;       ///< peak of left
    uint32_t peak_tests;      ///< peak of bricks_seen and cells_seen together
    uint32_t peak_tests_left; ///< peak of bricks_left and cells_left together
    uint64_t cells_certain;   ///< of cells_seen: opaque, with a triangle clearly inside; counted without a decision
} vxt_certified_counters;

/// Returns the counters of an answer with vxt_certified_desc::counters; otherwise NOT_READY.
VXT_CHECKED vxt_result vxt_answer_counters(const vxt_answer* answer, vxt_certified_counters* counters);

/// Results for frames in flight: voxtact::ResultRing.
typedef struct vxt_result_ring vxt_result_ring;
/// Creates a ring. `frames`: maximum number in flight. A null `desc` has all defaults.
VXT_CHECKED vxt_result vxt_result_ring_create(const vxt_detector* detector, uint32_t frames,
                                              const vxt_results_desc* desc, vxt_result_ring** ring);
/// Returns the slot of a frame, for recording. The ring owns the slot, which is valid until its next
/// vxt_result_ring_begin(). The previous frame of the slot must have completed. The slot is readable after a recorded
/// detection and read-back.
VXT_CHECKED vxt_result vxt_result_ring_begin(vxt_result_ring* ring, uint64_t frame, vxt_results** results);
/// Reads the results of a completed frame; NOT_READY if its slot was never used, or a later frame has claimed it.
VXT_CHECKED vxt_result vxt_result_ring_read(vxt_result_ring* ring, uint64_t frame, vxt_answer* answer);
/// Destroys the object and its results.
VXT_API void vxt_result_ring_destroy(vxt_result_ring* ring);

/// Creates a certified detector: voxtact::Detector::certified(). UNSUPPORTED if the device cannot run the detector; the
/// error names the missing feature or limit. A null `desc` has all defaults.
VXT_CHECKED vxt_result vxt_detector_create_certified(const vxt_context* context, const vxt_certified_desc* desc,
                                                     vxt_detector** detector);
/// Like vxt_detector_create_certified(), for voxtact::Detector::raster().
VXT_CHECKED vxt_result vxt_detector_create_raster(const vxt_context* context, const vxt_raster_desc* desc,
                                                  vxt_detector** detector);
/// Records the detection of a batch: no allocation of device memory, no submission, no wait, no map. After an error, do
/// not submit the command buffer.
VXT_CHECKED vxt_result vxt_detector_cmd_detect(const vxt_detector* detector, VkCommandBuffer commands,
                                               const vxt_batch* batch, vxt_results* results);
/// Returns the variant that VXT_BOUNDARY_AUTO selects for an item at a threshold above 0, up to 1; 0: 0.1.
VXT_CHECKED vxt_result vxt_detector_boundary_for(const vxt_detector* detector, const vxt_item* item, double threshold,
                                                 vxt_boundary* boundary);
VXT_API void vxt_detector_destroy(vxt_detector* detector);

/// Records, submits on the caller's queue, waits and reads: voxtact::BlockingDetector.
typedef struct vxt_blocking_detector vxt_blocking_detector;
/// Creates a certified detector. `max_contacts`: maximum number of contacts; a longer list is cut; 0: 2^16. A null
/// `desc` has all defaults.
VXT_CHECKED vxt_result vxt_blocking_detector_create_certified(const vxt_context* context,
                                                              const vxt_certified_desc* desc, const vxt_queue* queue,
                                                              uint32_t max_contacts, vxt_blocking_detector** detector);
/// Like vxt_blocking_detector_create_certified(), for voxtact::RasterDesc.
VXT_CHECKED vxt_result vxt_blocking_detector_create_raster(const vxt_context* context, const vxt_raster_desc* desc,
                                                           const vxt_queue* queue, uint32_t max_contacts,
                                                           vxt_blocking_detector** detector);
/// Answers for every pair. Blocks. After a failure `answer` is unchanged.
VXT_CHECKED vxt_result vxt_blocking_detector_detect(vxt_blocking_detector* detector, const vxt_batch* batch,
                                                    vxt_answer* answer);
VXT_API void vxt_blocking_detector_destroy(vxt_blocking_detector* detector);

// ======== Looks and views of pictures ========

/// Opacity and colours of a kind of image: voxtact::Look.
typedef struct vxt_look vxt_look;
/// Returns the name of a preset, such as `mr-brain`; null beyond the last one.
VXT_API const char* vxt_look_name(size_t index);
/// Creates the look of a preset. `values`: the image's smallest and largest voxel.
VXT_CHECKED vxt_result vxt_look_create(const char* name, const vxt_range* values, vxt_look** look);
/// Returns the opacity, ascending.
VXT_API const vxt_control_point* vxt_look_opacity(const vxt_look* look, size_t* count);
/// Returns the colours, ascending.
VXT_API const vxt_colour_point* vxt_look_colours(const vxt_look* look, size_t* count);
VXT_API void vxt_look_destroy(vxt_look* look);

/// Position of the eye, in degrees: voxtact::ViewDirection. 0, 0 is in front of the patient's face.
typedef struct vxt_view_direction {
    double azimuth;   ///< 90: left ear, 180: back of the head
    double elevation; ///< 90: above
} vxt_view_direction;
/// Returns the direction of `front`, `back`, `left`, `right`, `top` or `bottom`.
VXT_CHECKED vxt_result vxt_direction_named(const char* name, vxt_view_direction* direction);
/// Returns an orthographic view that frames the volume's box in the whole picture: voxtact::viewFrom(). `also`: another
/// box in world space between the near and far planes; may be null.
VXT_CHECKED vxt_result vxt_view_from(const vxt_view_direction* direction, const vxt_grid* grid, const vxt_box* also,
                                     uint32_t width, uint32_t height, vxt_view* view);
/// Returns the same triangles, with separate vertices at edges of more than `degrees` (0..180; recommended: 40):
/// voxtact::splitAtCreases().
VXT_CHECKED vxt_result vxt_split_at_creases(const vxt_mesh_view* mesh, double degrees, vxt_mesh_data** data);

// ======== Parts of pictures ========

/// Renders pictures in one colour format: voxtact::Renderer.
typedef struct vxt_renderer vxt_renderer;
/// Creates a renderer. UNSUPPORTED if the device cannot render to the format, or its pixels are integers. Recommended:
/// R8G8B8A8_UNORM.
VXT_CHECKED vxt_result vxt_renderer_create(const vxt_context* context, VkFormat color_format, vxt_renderer** renderer);
/// Destroys the object; objects created with it remain valid. Ignores the renderer of a vxt_blocking_renderer.
VXT_API void vxt_renderer_destroy(vxt_renderer* renderer);

/// Value -> opacity and colour: voxtact::RenderTransferFunctionDesc.
typedef struct vxt_render_function_desc {
    size_t struct_size;
    const vxt_control_point* points; ///< opacity, as for a detector
    size_t point_count;              ///< at least 1
    const vxt_colour_point* colours; ///< ascending values; constant outside; none: white
    size_t colour_count;             ///< length of `colours`
    vxt_range domain;                ///< domain of the table; lo < hi; {0, 0}: the range of the points
    double opacity_unit;             ///< path length over which opacity absorbs, mm; 0: 1
    double step;                     ///< mm between samples of a ray; recommended: half a voxel; 0: 0.5
    uint32_t table_size;             ///< entries; 2 to 1024; 0: 256
} vxt_render_function_desc;

/// Value -> opacity and colour, on the device: voxtact::RenderTransferFunction.
typedef struct vxt_render_function vxt_render_function;
/// Creates the function without a staging buffer.
VXT_CHECKED vxt_result vxt_render_function_create(const vxt_renderer* renderer, const vxt_render_function_desc* desc,
                                                  vxt_render_function** function);
VXT_CHECKED vxt_result vxt_render_function_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                  const vxt_render_function_desc* desc, vxt_render_function** function);
/// Records the computation of the table.
VXT_CHECKED vxt_result vxt_render_function_cmd_upload(vxt_render_function* function, VkCommandBuffer commands);
/// Like vxt_render_function_cmd_upload(), for a new function with as many entries.
VXT_CHECKED vxt_result vxt_render_function_cmd_update(vxt_render_function* function, VkCommandBuffer commands,
                                                      const vxt_render_function_desc* desc);
/// Returns 1 if some entry has an opacity above 0; 0 for null.
VXT_API uint32_t vxt_render_function_visible(const vxt_render_function* function);
VXT_API void vxt_render_function_destroy(vxt_render_function* function);

/// The normals of a mesh's vertices: voxtact::MeshNormals. Without them, each triangle is flat.
typedef struct vxt_mesh_normals vxt_mesh_normals;
/// Computes the normals in a staging buffer.
VXT_CHECKED vxt_result vxt_mesh_normals_create(const vxt_renderer* renderer, const vxt_mesh_view* mesh,
                                               vxt_mesh_normals** normals);
VXT_CHECKED vxt_result vxt_mesh_normals_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                               const vxt_mesh_view* mesh, vxt_mesh_normals** normals);
VXT_CHECKED vxt_result vxt_mesh_normals_cmd_upload(vxt_mesh_normals* normals, VkCommandBuffer commands);
VXT_API void vxt_mesh_normals_release_staging(vxt_mesh_normals* normals);
/// Records the normals of another shape of the mesh, with as many vertices.
VXT_CHECKED vxt_result vxt_mesh_normals_cmd_update(vxt_mesh_normals* normals, VkCommandBuffer commands,
                                                   const vxt_mesh_view* mesh);
VXT_API void vxt_mesh_normals_destroy(vxt_mesh_normals* normals);

/// Lets pictures skip transparent bricks: voxtact::RenderBricks.
typedef struct vxt_render_bricks vxt_render_bricks;
/// Uses the bricks of a volume, which must outlive it. Copies nothing.
VXT_CHECKED vxt_result vxt_render_bricks_create(const vxt_renderer* renderer, const vxt_volume* volume,
                                                vxt_render_bricks** bricks);
VXT_API void vxt_render_bricks_destroy(vxt_render_bricks* bricks);

/// The triangles that VXT_PAINT_TRIANGLES paints: voxtact::PaintedTriangles.
typedef struct vxt_painted_triangles vxt_painted_triangles;
/// Selects triangles by index, in any order, of a mesh with `mesh_triangles` triangles.
VXT_CHECKED vxt_result vxt_painted_triangles_create(const vxt_renderer* renderer, uint32_t mesh_triangles,
                                                    const uint32_t* triangles, size_t triangle_count,
                                                    vxt_painted_triangles** painted);
VXT_CHECKED vxt_result vxt_painted_triangles_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                    uint32_t mesh_triangles, const uint32_t* triangles,
                                                    size_t triangle_count, vxt_painted_triangles** painted);
/// Wraps a device buffer of bits: VXT_DEVICE_TRIANGLE_MASK of a batch of one pair.
VXT_CHECKED vxt_result vxt_painted_triangles_wrap(const vxt_renderer* renderer, const vxt_buffer_range* mask,
                                                  vxt_painted_triangles** painted);
VXT_CHECKED vxt_result vxt_painted_triangles_cmd_upload(vxt_painted_triangles* painted, VkCommandBuffer commands);
VXT_API void vxt_painted_triangles_release_staging(vxt_painted_triangles* painted);
VXT_API void vxt_painted_triangles_destroy(vxt_painted_triangles* painted);

/// The colours of a mesh's vertices that VXT_PAINT_VERTICES paints: voxtact::PaintedVertices.
typedef struct vxt_painted_vertices vxt_painted_vertices;
/// Sets `colours`: red, green and blue of each vertex; at least one vertex.
VXT_CHECKED vxt_result vxt_painted_vertices_create(const vxt_renderer* renderer, const double* colours,
                                                   size_t vertex_count, vxt_painted_vertices** painted);
VXT_CHECKED vxt_result vxt_painted_vertices_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                                   const double* colours, size_t vertex_count,
                                                   vxt_painted_vertices** painted);
/// Wraps a device buffer: one uint per vertex, red in its lowest 8 bits, then green and blue.
VXT_CHECKED vxt_result vxt_painted_vertices_wrap(const vxt_renderer* renderer, const vxt_buffer_range* colours,
                                                 vxt_painted_vertices** painted);
VXT_CHECKED vxt_result vxt_painted_vertices_cmd_upload(vxt_painted_vertices* painted, VkCommandBuffer commands);
VXT_API void vxt_painted_vertices_release_staging(vxt_painted_vertices* painted);
VXT_API void vxt_painted_vertices_destroy(vxt_painted_vertices* painted);

/// Paint on a mesh: voxtact::Paint.
typedef enum vxt_paint {
    VXT_PAINT_PLAIN = 0,     ///< nothing
    VXT_PAINT_CONTACTS = 1,  ///< passing fragments, as the projection VIEW counts them
    VXT_PAINT_DISCARDED = 2, ///< discarded fragments, and passing fragments by opacity
    VXT_PAINT_TRIANGLES = 3, ///< chosen triangles
    VXT_PAINT_VERTICES = 4,  ///< a colour for each vertex
    VXT_PAINT_MAX = 0x7fffffff
} vxt_paint;

/// A mesh at a pose, with its appearance: voxtact::SceneMesh and voxtact::MeshPaint. -0.0 in a colour makes it black.
typedef struct vxt_scene_mesh {
    size_t struct_size;
    const vxt_mesh* mesh;                           ///< required
    const vxt_mesh_normals* normals;                ///< of `mesh`: smooth shading; null: each triangle is flat
    const vxt_transfer_function* transfer_function; ///< of the detector; for CONTACTS and DISCARDED
    const vxt_painted_triangles* triangles;         ///< for TRIANGLES
    double world_from_object[16];                   ///< affine, not singular; all 0: the identity
    double colour[3];                               ///< without paint; all 0: 0.75 0.78 0.82
    double contact_colour[3];                       ///< passing fragments, chosen triangles; all 0: 1 0.23 0.08
    double discarded_colour[3];                     ///< discarded fragments; all 0: 0.16 0.36 0.88
    double threshold;                               ///< for CONTACTS and DISCARDED; 0..1; 0: 0.1; -0.0: 0
    double through;                                 ///< 0..1: visibility of the paint through the volume
    vxt_paint paint;                                ///< 0: PLAIN
    uint32_t clipped;                               ///< cut by the clipping planes, like the volume
    const vxt_painted_vertices* vertices;           ///< for VERTICES
} vxt_scene_mesh;

/// Removes the points p of world space with dot(normal, p) > offset.
typedef struct vxt_clip_plane {
    double normal[3]; ///< any length; it scales `offset`
    double offset;    ///< along the normal, if the normal has length 1
} vxt_clip_plane;

/// Light: voxtact::Lighting. Numbers without a range are from 0 to 1e6; -0.0: 0.
typedef struct vxt_lighting {
    size_t struct_size;
    double ambient;          ///< ambient light; 0: 0.25
    double diffuse;          ///< diffuse light from the eye; 0: 0.75
    double specular;         ///< strength of highlights; 0: 0.2
    double shininess;        ///< exponent of highlights; 0: 30
    double side;             ///< strength of the side light
    double side_from[3];     ///< direction to its source: picture's right, up, towards the eye; all 0: -0.55 0.6 0.6
    double occlusion;        ///< 0..1: darkening of enclosed points of the volume
    double reach;            ///< mm, above 0: range of occluders; 0: 8
    uint32_t plain_volume;   ///< 1: does not shade the volume by its gradient
    uint32_t plain_mesh;     ///< 1: does not shade meshes
    uint32_t gradient_faces; ///< 1: shades cut faces by the gradient, not by the normal of the plane
} vxt_lighting;

/// Returns the preset `soft`, `eye` or `none` for a volume: voxtact::lightingNamed().
VXT_CHECKED vxt_result vxt_lighting_named(const char* name, const vxt_grid* grid, vxt_lighting* lighting);
/// Returns a plane that removes a side of a volume, such as `left` or `near`: voxtact::clipSide(). `at`: mm; null: the
/// middle. `direction`: of the eye, only for `near`; else may be null.
VXT_CHECKED vxt_result vxt_clip_side(const char* side, const double* at, const vxt_grid* grid,
                                     const vxt_view_direction* direction, vxt_clip_plane* plane);
/// Returns the default colour of the mesh with this index; colours repeat after six: voxtact::meshColour(). Null is
/// allowed.
VXT_API void vxt_mesh_colour(size_t number, double colour[3]);
/// Returns the colour of a volume without a look, a warm white: voxtact::plainColours(). Null is allowed.
VXT_API void vxt_plain_colour(double colour[3]);
/// Returns a value of vxt_scene_mesh::through that makes the paint visible: voxtact::throughFor(); 0 without paint.
VXT_API double vxt_paint_through(vxt_paint paint);

/// Visible objects: voxtact::Scene.
typedef struct vxt_picture_scene {
    size_t struct_size;
    const vxt_volume* volume;            ///< required
    const vxt_render_function* function; ///< required
    const vxt_render_bricks* bricks;     ///< of `volume`: skips its transparent parts; may be null
    const vxt_scene_mesh* meshes;        ///< meshes at the right depth; any number
    size_t mesh_count;                   ///< length of `meshes`
    const vxt_clip_plane* clip_planes;   ///< a point that any plane removes is invisible
    size_t clip_plane_count;             ///< at most 6
    const vxt_lighting* lighting;        ///< null: the defaults
    double clip_from_world[16];          ///< orthographic or perspective; not singular
    double background[3];                ///< behind all objects; 0: black
    uint32_t no_jitter;                  ///< 1: bands instead of noise
    const vxt_cancel* cancel;            ///< cancels vxt_blocking_renderer_render(); null: never
} vxt_picture_scene;

// ======== Pictures ========

/// Intermediate images of one picture in flight: voxtact::RenderTargets.
typedef struct vxt_render_targets vxt_render_targets;
/// Creates targets for pictures of at most this size.
VXT_CHECKED vxt_result vxt_render_targets_create(const vxt_renderer* renderer, uint32_t width, uint32_t height,
                                                 vxt_render_targets** targets);
VXT_API void vxt_render_targets_destroy(vxt_render_targets* targets);

/// Destination of a recorded picture: voxtact::Target.
typedef struct vxt_picture_target {
    size_t struct_size;
    vxt_render_targets* targets; ///< required
    VkImageView view;            ///< of the renderer's format, one sample, usage COLOR_ATTACHMENT
    VkExtent2D extent;           ///< size of the picture, from the image's corner
    VkRect2D area;               ///< part to render; without an extent, the whole picture
    VkQueryPool timestamps;      ///< receives three timestamps; null: none
    VkImageLayout layout;        ///< COLOR_ATTACHMENT_OPTIMAL, or GENERAL; 0: COLOR_ATTACHMENT_OPTIMAL
    uint32_t first_timestamp;    ///< index of the first query
} vxt_picture_target;

/// Records a picture: voxtact::Renderer::cmdRender(). No allocation of device memory, no submission, no wait.
VXT_CHECKED vxt_result vxt_renderer_cmd_render(const vxt_renderer* renderer, VkCommandBuffer commands,
                                               const vxt_picture_scene* scene, const vxt_picture_target* target);

/// A view of a picture's pixels.
typedef struct vxt_picture_view {
    size_t struct_size;
    const uint8_t* rgba; ///< four bytes per pixel, row by row without padding, the uppermost first; alpha is 255
    size_t bytes;        ///< size of `rgba`: 4 * width * height
    uint32_t width;      ///< pixels
    uint32_t height;     ///< pixels
} vxt_picture_view;

/// A picture in host memory: voxtact::Picture. vxt_write_png() writes it.
typedef struct vxt_picture vxt_picture;
/// Creates an empty picture.
VXT_CHECKED vxt_result vxt_picture_create(vxt_picture** picture);
/// Returns a view of the pixels, valid until the next picture is written.
VXT_CHECKED vxt_result vxt_picture_get(const vxt_picture* picture, vxt_picture_view* view);
VXT_API void vxt_picture_destroy(vxt_picture* picture);

/// Receives the progress: rows done and in total. Called on the rendering thread.
typedef void (*vxt_picture_progress)(void* user, uint32_t done, uint32_t rows);

/// Renders into its own image, submits on the caller's queue, waits and reads: voxtact::BlockingRenderer.
typedef struct vxt_blocking_renderer vxt_blocking_renderer;
/// Creates a renderer. `queue` needs graphics.
VXT_CHECKED vxt_result vxt_blocking_renderer_create(const vxt_context* context, const vxt_queue* queue,
                                                    vxt_blocking_renderer** renderer);
/// Returns the recording renderer, for creating the parts of a scene; null for null.
VXT_API const vxt_renderer* vxt_blocking_renderer_renderer(const vxt_blocking_renderer* renderer);
/// Renders a picture; one at a time. With `progress` or the scene's `cancel`, renders bands of rows of about 0.2 s
/// each. Returns CANCELLED after the band in which `cancel` is set. After a failure `picture` is unchanged.
VXT_CHECKED vxt_result vxt_blocking_renderer_render(vxt_blocking_renderer* renderer, const vxt_picture_scene* scene,
                                                    uint32_t width, uint32_t height, vxt_picture_progress progress,
                                                    void* user, vxt_picture* picture);
VXT_API void vxt_blocking_renderer_destroy(vxt_blocking_renderer* renderer);

#ifdef __cplusplus
}
#endif

#endif

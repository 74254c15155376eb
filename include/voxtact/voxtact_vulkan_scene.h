/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_SCENE_H
#define VOXTACT_VOXTACT_VULKAN_SCENE_H

#include "voxtact/voxtact_vulkan_context.h"

/// @file
/// Volumes, transfer functions, meshes and label maps on the caller's device. See voxtact_vulkan.h.

#ifdef __cplusplus
extern "C" {
#endif

/// Options of a volume: voxtact::VolumeOptions.
typedef struct vxt_volume_options {
    size_t struct_size; ///< sizeof this struct
    const char* name;   ///< appears on the Vulkan objects; may be null
    uint32_t bricks;    ///< keeps the range of values of every brick of 8^3 cells, for CERTIFIED; default 0
    uint32_t editable;  ///< allows edits; default 0
} vxt_volume_options;

/// An image that the caller owns: voxtact::WrappedVolume.
typedef struct vxt_wrapped_volume {
    size_t struct_size; ///< sizeof this struct
    VkImageView view;   ///< 3D, one mip level, component r sampled
    VkFormat format;    ///< R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT or R32_SFLOAT
    /// While commands execute: SHADER_READ_ONLY_OPTIMAL (or 0), READ_ONLY_OPTIMAL or GENERAL.
    VkImageLayout layout;
    vxt_grid grid;         ///< position of the voxels
    double slope;          ///< value = slope * stored + intercept; 0: 1
    double intercept;      ///< in the image's units; default 0
    vxt_range boundary;    ///< with has_boundary: contains the values of the voxels on the image's faces
    uint32_t has_boundary; ///< lets VXT_BOUNDARY_AUTO clamp; default 0
    uint32_t bricks;       ///< as in vxt_volume_options; default 0
} vxt_wrapped_volume;

/// Facts of a volume on the device.
typedef struct vxt_volume_info {
    size_t struct_size; ///< sizeof this struct
    VkImageView view;   ///< 3D, in SHADER_READ_ONLY_OPTIMAL, or as it was wrapped
    vxt_grid grid;      ///< position of the voxels
    vxt_range range;    ///< with has_range: contains all voxels
    VkFormat format;    ///< of the image
    uint32_t has_range; ///< 0 for a wrapped volume, and after vxt_volume_cmd_copy()
} vxt_volume_info;

/// A 3D image on the device: voxtact::Volume.
typedef struct vxt_volume vxt_volume;
/// Creates the object and fills a staging buffer; call vxt_volume_cmd_upload() next. Null options are the defaults.
VXT_CHECKED vxt_result vxt_volume_create(const vxt_context* context, const vxt_volume_view* view,
                                         const vxt_volume_options* options, vxt_volume** volume);
/// Uses an image of the caller, which must outlive it.
VXT_CHECKED vxt_result vxt_volume_wrap(const vxt_context* context, const vxt_wrapped_volume* wrapped,
                                       vxt_volume** volume);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_volume_upload(const vxt_context* context, const vxt_queue* queue,
                                         const vxt_volume_view* view, const vxt_volume_options* options,
                                         vxt_volume** volume);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_volume_cmd_upload(vxt_volume* volume, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of vxt_volume_cmd_upload() must be complete.
VXT_API void vxt_volume_release_staging(vxt_volume* volume);
/// Updates the bricks after the caller changed voxels of a wrapped image.
VXT_CHECKED vxt_result vxt_volume_cmd_update_bricks(vxt_volume* volume, VkCommandBuffer commands,
                                                    const vxt_voxel_box* changed);
/// Sets the voxels of a box to a value in the image's own units; takes effect in command-buffer order.
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
/// Destroys the object.
VXT_API void vxt_volume_destroy(vxt_volume* volume);

/// A table that the caller owns: voxtact::WrappedTransferFunction.
typedef struct vxt_wrapped_transfer_function {
    size_t struct_size;   ///< sizeof this struct
    VkImageView view;     ///< 1D, opacity in component r
    vxt_range domain;     ///< values that the table covers; lo < hi
    const float* table;   ///< the same table on the host, if the caller has it; else null. `certified` needs it
    size_t table_size;    ///< entries of `table`
    VkImageLayout layout; ///< while commands execute; 0: SHADER_READ_ONLY_OPTIMAL
} vxt_wrapped_transfer_function;

/// Value -> opacity, on the device: voxtact::TransferFunction.
typedef struct vxt_transfer_function vxt_transfer_function;
/// Creates the object and fills a staging buffer. `name` appears on the Vulkan objects and may be null.
VXT_CHECKED vxt_result vxt_transfer_function_create(const vxt_context* context, const vxt_transfer_function_desc* desc,
                                                    const char* name, vxt_transfer_function** function);
/// Uses a table of the caller, which must outlive it.
VXT_CHECKED vxt_result vxt_transfer_function_wrap(const vxt_context* context,
                                                  const vxt_wrapped_transfer_function* wrapped,
                                                  vxt_transfer_function** function);
/// Creates and uploads in one call: submits on `queue` and waits.
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
/// Returns the values that the table covers, as last recorded.
VXT_CHECKED vxt_result vxt_transfer_function_domain(const vxt_transfer_function* function, vxt_range* domain);
/// Destroys the object.
VXT_API void vxt_transfer_function_destroy(vxt_transfer_function* function);

/// Options of a mesh: voxtact::MeshOptions.
typedef struct vxt_mesh_options {
    size_t struct_size; ///< sizeof this struct
    const char* name;   ///< appears on the Vulkan objects; may be null
    uint32_t clusters;  ///< keeps clusters of triangles, which the projection CERTIFIED culls; default 0
    uint32_t editable;  ///< allows vxt_mesh_cmd_update() and vxt_mesh_cmd_copy(); default 0
    /// Bytes from vertex to vertex on the device; at least 12, the default; a multiple of 4. For drawing, at most the
    /// device's maxVertexInputBindingStride.
    uint32_t vertex_stride;
} vxt_mesh_options;

/// Buffers that the caller owns: voxtact::WrappedMesh. Vertices are three floats at the start of a stride.
typedef struct vxt_wrapped_mesh {
    size_t struct_size;         ///< sizeof this struct
    VkBuffer vertices;          ///< usage VERTEX_BUFFER
    VkDeviceSize vertex_offset; ///< bytes to the first position; a multiple of 4
    VkBuffer indices;           ///< usage INDEX_BUFFER; null: every three vertices form a triangle
    VkDeviceSize index_offset;  ///< bytes
    uint32_t vertex_stride;     ///< bytes; 0: 12
    uint32_t vertex_count;      ///< vertices in the buffer
    VkIndexType index_type;     ///< UINT16, which is 0, or UINT32
    uint32_t triangle_count;    ///< triangles to draw
    uint32_t storage;           ///< the buffers also have usage STORAGE_BUFFER; default 0
    /// As in vxt_mesh_options. Call vxt_mesh_cmd_upload() before use, and vxt_mesh_cmd_refit() after changes.
    uint32_t clusters;
    /// With clusters: the same triangles on the host, read by vxt_mesh_wrap() only; null: clusters in the order of the
    /// triangles.
    const vxt_mesh_view* shape;
} vxt_wrapped_mesh;

/// A triangle mesh on the device: voxtact::Mesh.
typedef struct vxt_mesh vxt_mesh;
/// Creates the object and fills a staging buffer. Null options are the defaults.
VXT_CHECKED vxt_result vxt_mesh_create(const vxt_context* context, const vxt_mesh_view* view,
                                       const vxt_mesh_options* options, vxt_mesh** mesh);
/// Uses buffers of the caller, which must outlive it.
VXT_CHECKED vxt_result vxt_mesh_wrap(const vxt_context* context, const vxt_wrapped_mesh* wrapped, vxt_mesh** mesh);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_mesh_upload(const vxt_context* context, const vxt_queue* queue, const vxt_mesh_view* view,
                                       const vxt_mesh_options* options, vxt_mesh** mesh);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_mesh_cmd_upload(vxt_mesh* mesh, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_mesh_release_staging(vxt_mesh* mesh);
/// Moves the vertices of an editable mesh: `vertex_count` vertices of three coordinates, as many as it has, in
/// command-buffer order: voxtact::Mesh::cmdUpdate(). A refused call changes nothing.
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
/// Destroys the object.
VXT_API void vxt_mesh_destroy(vxt_mesh* mesh);

/// A label map on the device: voxtact::LabelMap.
typedef struct vxt_label_map vxt_label_map;
/// Creates the object and fills a staging buffer. `name` appears on the Vulkan objects and may be null.
VXT_CHECKED vxt_result vxt_label_map_create(const vxt_context* context, const vxt_labels* labels, const char* name,
                                            vxt_label_map** map);
/// Creates and uploads in one call: submits on `queue` and waits.
VXT_CHECKED vxt_result vxt_label_map_upload(const vxt_context* context, const vxt_queue* queue,
                                            const vxt_labels* labels, const char* name, vxt_label_map** map);
/// Records the copy to the device.
VXT_CHECKED vxt_result vxt_label_map_cmd_upload(vxt_label_map* map, VkCommandBuffer commands);
/// Frees the staging buffer. The submission of the upload must be complete.
VXT_API void vxt_label_map_release_staging(vxt_label_map* map);
/// Returns the labels by index; valid as long as the object.
VXT_API const int32_t* vxt_label_map_values(const vxt_label_map* map, size_t* count);
/// Destroys the object.
VXT_API void vxt_label_map_destroy(vxt_label_map* map);

#ifdef __cplusplus
}
#endif

#endif

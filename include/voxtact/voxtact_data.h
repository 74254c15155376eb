/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_DATA_H
#define VOXTACT_VOXTACT_DATA_H

#include "voxtact/voxtact_base.h"

/// @file
/// Host data of the C interface: images, transfer functions, meshes, boxes, label maps, and builtins. The conventions
/// of voxtact.h apply.

#ifdef __cplusplus
extern "C" {
#endif

/// Position of an image's voxels in the world: voxtact::Grid. World is LPS, in millimetres.
typedef struct vxt_grid {
    double spacing[3];   ///< mm; from 1e-9 to 1e12; all 0: 1
    double origin[3];    ///< mm, within 1e12; the centre of voxel (0,0,0)
    double direction[9]; ///< columns: unit vectors along the index axes; [3 * c + r]; not singular; all 0: axes
    uint32_t size[3];    ///< voxels along x, y, z; each at least 1
} vxt_grid;

/// Storage type of a voxel: voxtact::ScalarType.
typedef enum vxt_scalar_type {
    VXT_SCALAR_UINT8 = 0,       ///< a byte
    VXT_SCALAR_INT16 = 1,       ///< two bytes
    VXT_SCALAR_UINT16 = 2,      ///< two bytes
    VXT_SCALAR_FLOAT32 = 3,     ///< four bytes
    VXT_SCALAR_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_scalar_type;

/// An image that the caller owns.
typedef struct vxt_volume_view {
    size_t struct_size;   ///< sizeof this struct
    const void* voxels;   ///< x fastest, then y, then z, without padding, in the machine's byte order, aligned
    size_t bytes;         ///< size of `voxels`
    vxt_grid grid;        ///< position of the voxels
    vxt_scalar_type type; ///< type of each voxel
} vxt_volume_view;

/// A closed interval of values in the image's own units.
typedef struct vxt_range {
    double lo; ///< smallest value
    double hi; ///< largest value
} vxt_range;

/// A corner of the piecewise linear transfer function.
typedef struct vxt_control_point {
    double value;   ///< in the image's own units
    double opacity; ///< 0..1
} vxt_control_point;

/// Value -> opacity: voxtact::TransferFunctionDesc.
typedef struct vxt_transfer_function_desc {
    size_t struct_size;              ///< sizeof this struct
    const vxt_control_point* points; ///< ascending values; piecewise linear between, constant outside
    size_t point_count;              ///< at least 1
    vxt_range domain;                ///< domain of the table; lo < hi; default {0, 0}: the range of the points
    uint32_t table_size;             ///< entries; 2 to 2^24; 0: 256
} vxt_transfer_function_desc;

/// A triangle mesh that the caller owns, in object space.
typedef struct vxt_mesh_view {
    size_t struct_size;      ///< sizeof this struct
    const double* positions; ///< three per vertex
    size_t vertex_count;     ///< number of vertices
    const uint32_t* indices; ///< three per triangle
    size_t triangle_count;   ///< number of triangles
    double deflection;       ///< object units: voxtact::MeshView::deflection
} vxt_mesh_view;

/// An axis-aligned box. Empty if lo > hi.
typedef struct vxt_box {
    double lo[3]; ///< smallest coordinates
    double hi[3]; ///< largest coordinates
} vxt_box;

/// Facts of a mesh: voxtact::MeshFacts.
typedef struct vxt_mesh_facts {
    vxt_box bounds;      ///< object space
    uint32_t vertices;   ///< number of vertices
    uint32_t triangles;  ///< number of triangles, degenerate ones included
    uint32_t degenerate; ///< triangles whose area is zero in float: allowed; they cover no pixel of a view
    double rounding;     ///< object units: voxtact::MeshFacts::rounding; above 1e-4 it gives a note
    double deflection;   ///< object units: vxt_mesh_view::deflection
} vxt_mesh_facts;

/// A box of voxels.
typedef struct vxt_voxel_box {
    uint32_t first[3]; ///< lowest corner
    uint32_t size[3];  ///< voxels along each axis; 0: empty
} vxt_voxel_box;

/// The camera of the projections VIEW and TWO_VIEW.
typedef struct vxt_view {
    double clip_from_world[16]; ///< Vulkan's clip space; orthographic or perspective; not singular
    uint32_t width;             ///< pixels
    uint32_t height;            ///< pixels
} vxt_view;

/// Indices of two boxes that overlap.
typedef struct vxt_box_pair {
    uint32_t first;  ///< index in the first array
    uint32_t second; ///< index in the same array, or in the second one
} vxt_box_pair;

/// Returns the smallest and largest voxel; refuses what voxtact::checkVolume() refuses. O(voxels).
VXT_CHECKED vxt_result vxt_check_volume(const vxt_volume_view* volume, vxt_range* range);
/// Returns the facts of a mesh; refuses what voxtact::checkMesh() refuses. O(vertices + triangles).
VXT_CHECKED vxt_result vxt_check_mesh(const vxt_mesh_view* mesh, vxt_mesh_facts* facts);
/// Returns "uint8", "int16", "uint16" or "float", with static lifetime; "unknown" for an invalid number.
VXT_API const char* vxt_scalar_type_name(vxt_scalar_type type);
/// Refuses what voxtact::checkGrid() refuses.
VXT_CHECKED vxt_result vxt_check_grid(const vxt_grid* grid);
/// Refuses elements that are not finite and a last row other than 0 0 0 1.
VXT_CHECKED vxt_result vxt_check_affine(const double b_from_a[16]);
/// Writes the table of a transfer function, `table_size` entries, to `table`, which holds `room`. Refuses what
/// voxtact::sampleTable() refuses, and too small a table.
VXT_CHECKED vxt_result vxt_sample_table(const vxt_transfer_function_desc* desc, float* table, size_t room);
/// Effect of a threshold on a transfer function and a volume's values: voxtact::OpacityFacts. If nothing is opaque,
/// nothing touches: a correct answer, but rarely an intended one.
typedef struct vxt_opacity_facts {
    double moved;     ///< largest error of the table at an end of an opaque interval, in the image's units; or infinity
    uint32_t reaches; ///< 1: some value is opaque
    uint32_t any;     ///< 1: some value of the data is opaque
} vxt_opacity_facts;
/// Computes the facts of a transfer function: voxtact::checkOpacity(). `data`: the range that vxt_check_volume()
/// returns.
VXT_CHECKED vxt_result vxt_check_opacity(const vxt_transfer_function_desc* desc, const vxt_range* data,
                                         double threshold, vxt_opacity_facts* facts);
/// Returns the matrix from index space to the world. Refuses what voxtact::checkGrid() refuses.
VXT_CHECKED vxt_result vxt_world_from_index(const vxt_grid* grid, double world_from_index[16]);
/// Returns the matrix from texture space, [0,1]^3 over the whole image, to the world.
VXT_CHECKED vxt_result vxt_world_from_texture(const vxt_grid* grid, double world_from_texture[16]);
/// Returns the inverse of vxt_world_from_texture().
VXT_CHECKED vxt_result vxt_texture_from_world(const vxt_grid* grid, double texture_from_world[16]);
/// Returns the smallest box that contains all voxels whose centre is within `radius` mm of a world point, as for an
/// edit.
VXT_CHECKED vxt_result vxt_ball_voxels(const vxt_grid* grid, const double centre[3], double radius, vxt_voxel_box* box);
/// Returns an orthographic view from above whose square pixels frame the volume.
VXT_CHECKED vxt_result vxt_framing_view(const vxt_grid* grid, uint32_t width, uint32_t height, vxt_view* view);
/// Returns the second camera of the projection TWO_VIEW: voxtact::sideView(). Both arguments may be the same array.
VXT_CHECKED vxt_result vxt_side_view(const double clip_from_world[16], double side_from_world[16]);
/// Multiplies: c_from_a = c_from_b * b_from_a. The result may be one of the factors.
VXT_CHECKED vxt_result vxt_multiply(const double c_from_b[16], const double b_from_a[16], double c_from_a[16]);
/// Transforms a point and divides by its w. `point` and `transformed` may be the same array.
VXT_CHECKED vxt_result vxt_transform_point(const double b_from_a[16], const double point[3], double transformed[3]);
/// Inverts any 4x4 matrix; the inverse of an affine one is exactly affine. Refuses a singular one. Both may be the same
/// array.
VXT_CHECKED vxt_result vxt_inverse(const double b_from_a[16], double a_from_b[16]);

/// Returns the bounding box of a box's corners under an affine matrix, rounded outward: voxtact::transformBox(). `box`
/// and `transformed` may be the same.
VXT_CHECKED vxt_result vxt_transform_box(const double b_from_a[16], const vxt_box* box, vxt_box* transformed);
/// Returns the bounding boxes of one box at `count` poses, 16 doubles each, in `boxes`.
VXT_CHECKED vxt_result vxt_boxes_at(const double* world_from_object, size_t count, const vxt_box* box, vxt_box* boxes);

/// Pairs found by a broad phase.
typedef struct vxt_box_pairs vxt_box_pairs;
/// Finds all pairs of closed boxes that share a point, sorted: within `left` if `right` is null, else between the two.
VXT_CHECKED vxt_result vxt_overlapping_pairs(const vxt_box* left, size_t left_count, const vxt_box* right,
                                             size_t right_count, vxt_box_pairs** pairs);
/// Returns the pairs, valid as long as the object. For null: null and count 0.
VXT_API const vxt_box_pair* vxt_box_pairs_get(const vxt_box_pairs* pairs, size_t* count);
/// Destroys the object.
VXT_API void vxt_box_pairs_destroy(vxt_box_pairs* pairs);

/// A label map in host memory: voxtact::LabelData.
typedef struct vxt_labels vxt_labels;
/// Creates a label map from an image of labels. Refuses what voxtact::makeLabels() refuses.
VXT_CHECKED vxt_result vxt_labels_create(const vxt_volume_view* volume, vxt_labels** labels);
/// Returns the labels, ascending, each once, including 0. Valid as long as the object.
VXT_API const int32_t* vxt_labels_values(const vxt_labels* labels, size_t* count);
/// Returns the position of the voxels.
VXT_CHECKED vxt_result vxt_labels_grid(const vxt_labels* labels, vxt_grid* grid);
/// Returns the label at a world point; 0 outside the map's grid.
VXT_CHECKED vxt_result vxt_labels_at(const vxt_labels* labels, const double world[3], int32_t* label);
/// Returns the labels at `count` world points, three coordinates each, in `found`.
VXT_CHECKED vxt_result vxt_labels_at_points(const vxt_labels* labels, const double* points, size_t count,
                                            int32_t* found);
/// Destroys the object.
VXT_API void vxt_labels_destroy(vxt_labels* labels);

/// An image that was read or created: voxtact::VolumeData.
typedef struct vxt_volume_data vxt_volume_data;
/// Returns a view of the voxels, valid as long as the object. struct_size of `view` must be set.
VXT_CHECKED vxt_result vxt_volume_data_view(const vxt_volume_data* data, vxt_volume_view* view);
/// Returns the name of the file or builtin.
VXT_API const char* vxt_volume_data_name(const vxt_volume_data* data);
/// Returns a note of the reader for the user, one line each; null beyond the last one.
VXT_API const char* vxt_volume_data_note(const vxt_volume_data* data, size_t index);
/// Destroys the object.
VXT_API void vxt_volume_data_destroy(vxt_volume_data* data);

/// A mesh that was read or created: voxtact::MeshData.
typedef struct vxt_mesh_data vxt_mesh_data;
/// Returns a view of the arrays, valid as long as the object. struct_size of `view` must be set.
VXT_CHECKED vxt_result vxt_mesh_data_view(const vxt_mesh_data* data, vxt_mesh_view* view);
/// Returns the name of the file or builtin.
VXT_API const char* vxt_mesh_data_name(const vxt_mesh_data* data);
/// Like vxt_volume_data_note().
VXT_API const char* vxt_mesh_data_note(const vxt_mesh_data* data, size_t index);
/// Destroys the object.
VXT_API void vxt_mesh_data_destroy(vxt_mesh_data* data);

/// Creates a builtin volume, by the name after `builtin:` on the command line ("head:64").
VXT_CHECKED vxt_result vxt_builtin_volume(const char* name, vxt_volume_data** data);
/// Creates a builtin mesh, by the name after `builtin:` on the command line ("scalpel:3068").
VXT_CHECKED vxt_result vxt_builtin_mesh(const char* name, vxt_mesh_data** data);

#ifdef __cplusplus
}
#endif

#endif

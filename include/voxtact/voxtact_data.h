/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_DATA_H
#define VOXTACT_VOXTACT_DATA_H

#include "voxtact/voxtact_base.h"

/// @file
/// Host data of the C interface: images, transfer functions, meshes, boxes, label maps, and builtins. What holds for
/// voxtact.h, which includes this, holds here.

#ifdef __cplusplus
extern "C" {
#endif

/// Where the voxels of an image are: voxtact::Grid. World is LPS, in millimetres.
typedef struct vxt_grid {
    double spacing[3];   ///< mm; from 1e-9 to 1e12; all 0: 1
    double origin[3];    ///< mm, within 1e12; the centre of voxel (0,0,0)
    double direction[9]; ///< three columns, the unit vectors along the index axes; [3 * c + r]; not singular; all 0:
                         ///< the axes
    uint32_t size[3];    ///< voxels along x, y, z; each at least 1
} vxt_grid;

/// How a voxel is stored: voxtact::ScalarType.
typedef enum vxt_scalar_type {
    VXT_SCALAR_UINT8 = 0,       ///< a byte
    VXT_SCALAR_INT16 = 1,       ///< two bytes
    VXT_SCALAR_UINT16 = 2,      ///< two bytes
    VXT_SCALAR_FLOAT32 = 3,     ///< four bytes
    VXT_SCALAR_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_scalar_type;

/// An image of the caller's.
typedef struct vxt_volume_view {
    size_t struct_size;   ///< sizeof
    const void* voxels;   ///< x fastest, then y, then z, without padding, in the machine's byte order, aligned
    size_t bytes;         ///< of `voxels`
    vxt_grid grid;        ///< where the voxels are
    vxt_scalar_type type; ///< of each voxel
} vxt_volume_view;

/// A closed interval of values in the image's own units.
typedef struct vxt_range {
    double lo; ///< the least
    double hi; ///< the greatest
} vxt_range;

/// A corner of the piecewise linear transfer function.
typedef struct vxt_control_point {
    double value;   ///< in the image's own units
    double opacity; ///< 0..1
} vxt_control_point;

/// Value -> opacity: voxtact::TransferFunctionDesc.
typedef struct vxt_transfer_function_desc {
    size_t struct_size;              ///< sizeof
    const vxt_control_point* points; ///< ascending values; piecewise linear between, constant outside
    size_t point_count;              ///< at least 1
    vxt_range domain;                ///< of the table; lo < hi; default {0, 0}: what the points span
    uint32_t table_size;             ///< entries; 2 to 2^24; 0: 256
} vxt_transfer_function_desc;

/// A triangle mesh of the caller's, in object space.
typedef struct vxt_mesh_view {
    size_t struct_size;      ///< sizeof
    const double* positions; ///< three a vertex
    size_t vertex_count;     ///< vertices
    const uint32_t* indices; ///< three a triangle
    size_t triangle_count;   ///< triangles
    double deflection;       ///< object units: voxtact::MeshView::deflection
} vxt_mesh_view;

/// An axis-aligned box. Empty where lo > hi.
typedef struct vxt_box {
    double lo[3]; ///< least coordinates
    double hi[3]; ///< greatest coordinates
} vxt_box;

/// What was found out about a mesh: voxtact::MeshFacts.
typedef struct vxt_mesh_facts {
    vxt_box bounds;      ///< object space
    uint32_t vertices;   ///< how many
    uint32_t triangles;  ///< how many, degenerate ones included
    uint32_t degenerate; ///< triangles whose area is zero in float: allowed, no pixel of a view is theirs
    double rounding;     ///< object units: voxtact::MeshFacts::rounding; above 1e-4 worth a note
    double deflection;   ///< object units: that of the view
} vxt_mesh_facts;

/// A box of voxels.
typedef struct vxt_voxel_box {
    uint32_t first[3]; ///< the lowest corner
    uint32_t size[3];  ///< voxels along each axis; 0: empty
} vxt_voxel_box;

/// The camera of the projections VIEW and TWO_VIEW.
typedef struct vxt_view {
    double clip_from_world[16]; ///< Vulkan's clip space; orthographic or perspective; not singular
    uint32_t width;             ///< pixels
    uint32_t height;            ///< pixels
} vxt_view;

/// Two boxes that overlap: their numbers.
typedef struct vxt_box_pair {
    uint32_t first;  ///< number of a box in the first array
    uint32_t second; ///< in the same array, or in the second one
} vxt_box_pair;

/// Smallest and largest voxel; refuses what voxtact::checkVolume() refuses. O(voxels).
VXT_CHECKED vxt_result vxt_check_volume(const vxt_volume_view* volume, vxt_range* range);
/// Refuses what voxtact::checkMesh() refuses. O(vertices + triangles).
VXT_CHECKED vxt_result vxt_check_mesh(const vxt_mesh_view* mesh, vxt_mesh_facts* facts);
/// "uint8", "int16", "uint16" or "float"; it lives for ever; "unknown" for a number that is none.
VXT_API const char* vxt_scalar_type_name(vxt_scalar_type type);
/// Refuses what voxtact::checkGrid() refuses.
VXT_CHECKED vxt_result vxt_check_grid(const vxt_grid* grid);
/// Refuses elements that are not finite and a last row other than 0 0 0 1.
VXT_CHECKED vxt_result vxt_check_affine(const double b_from_a[16]);
/// The table of a transfer function, `table_size` entries: `room` is that of `table`. Refuses what
/// voxtact::sampleTable() refuses, and too little room.
VXT_CHECKED vxt_result vxt_sample_table(const vxt_transfer_function_desc* desc, float* table, size_t room);
/// What a threshold makes of a transfer function and of the values of a volume: voxtact::OpacityFacts. Where nothing is
/// opaque nothing touches, which is a true answer to what was hardly meant.
typedef struct vxt_opacity_facts {
    double moved;     ///< how far the table moves an end of the opaque values, in the image's units; or infinity
    uint32_t reaches; ///< whether some values are opaque
    uint32_t any;     ///< whether some value of the data is
} vxt_opacity_facts;
/// voxtact::checkOpacity(): `data` is the least and the largest value, as vxt_check_volume() gives them.
VXT_CHECKED vxt_result vxt_check_opacity(const vxt_transfer_function_desc* desc, const vxt_range* data,
                                         double threshold, vxt_opacity_facts* facts);
/// From index space to the world. Refuses what voxtact::checkGrid() refuses.
VXT_CHECKED vxt_result vxt_world_from_index(const vxt_grid* grid, double world_from_index[16]);
/// From texture space, [0,1]^3 over the whole image, to the world.
VXT_CHECKED vxt_result vxt_world_from_texture(const vxt_grid* grid, double world_from_texture[16]);
/// The inverse of vxt_world_from_texture().
VXT_CHECKED vxt_result vxt_texture_from_world(const vxt_grid* grid, double texture_from_world[16]);
/// The least box with the voxels whose centre is at most `radius` mm from a point of the world, as an edit has them.
VXT_CHECKED vxt_result vxt_ball_voxels(const vxt_grid* grid, const double centre[3], double radius, vxt_voxel_box* box);
/// An orthographic view from above whose square pixels frame the volume.
VXT_CHECKED vxt_result vxt_framing_view(const vxt_grid* grid, uint32_t width, uint32_t height, vxt_view* view);
/// The second camera of the projection TWO_VIEW: voxtact::sideView(). The two may be the same.
VXT_CHECKED vxt_result vxt_side_view(const double clip_from_world[16], double side_from_world[16]);
/// c_from_a = c_from_b * b_from_a. It may be one of the two.
VXT_CHECKED vxt_result vxt_multiply(const double c_from_b[16], const double b_from_a[16], double c_from_a[16]);
/// The image of a point, divided by its w. The two may be the same.
VXT_CHECKED vxt_result vxt_transform_point(const double b_from_a[16], const double point[3], double transformed[3]);
/// The inverse of any 4x4 matrix, of an affine one exactly affine; refuses a singular one. The two may be the same.
VXT_CHECKED vxt_result vxt_inverse(const double b_from_a[16], double a_from_b[16]);

/// The box of a box's corners under an affine matrix, rounded outward: voxtact::transformBox(). The two may be the
/// same.
VXT_CHECKED vxt_result vxt_transform_box(const double b_from_a[16], const vxt_box* box, vxt_box* transformed);
/// The boxes of one box at `count` poses, 16 doubles each: as many into `boxes`.
VXT_CHECKED vxt_result vxt_boxes_at(const double* world_from_object, size_t count, const vxt_box* box, vxt_box* boxes);

/// The pairs that a broad phase found.
typedef struct vxt_box_pairs vxt_box_pairs;
/// All pairs of closed boxes that share a point, sorted: within `left` where `right` is null, else between the two.
VXT_CHECKED vxt_result vxt_overlapping_pairs(const vxt_box* left, size_t left_count, const vxt_box* right,
                                             size_t right_count, vxt_box_pairs** pairs);
/// The pairs; valid as long as the object. Null and 0 of null.
VXT_API const vxt_box_pair* vxt_box_pairs_get(const vxt_box_pairs* pairs, size_t* count);
/// Ends it.
VXT_API void vxt_box_pairs_destroy(vxt_box_pairs* pairs);

/// A label map in host memory: voxtact::LabelData.
typedef struct vxt_labels vxt_labels;
/// Makes one of an image of labels. Refuses what voxtact::makeLabels() refuses.
VXT_CHECKED vxt_result vxt_labels_create(const vxt_volume_view* volume, vxt_labels** labels);
/// The labels, ascending, each once; 0 is always among them. Valid as long as the object.
VXT_API const int32_t* vxt_labels_values(const vxt_labels* labels, size_t* count);
/// Where its voxels are.
VXT_CHECKED vxt_result vxt_labels_grid(const vxt_labels* labels, vxt_grid* grid);
/// The label at a world point; 0 outside of the map's grid.
VXT_CHECKED vxt_result vxt_labels_at(const vxt_labels* labels, const double world[3], int32_t* label);
/// The labels at `count` world points, three coordinates each: as many into `found`.
VXT_CHECKED vxt_result vxt_labels_at_points(const vxt_labels* labels, const double* points, size_t count,
                                            int32_t* found);
/// Ends it.
VXT_API void vxt_labels_destroy(vxt_labels* labels);

/// An image that was read or built: voxtact::VolumeData.
typedef struct vxt_volume_data vxt_volume_data;
/// Its voxels; valid as long as the object. struct_size of `view` must be set.
VXT_CHECKED vxt_result vxt_volume_data_view(const vxt_volume_data* data, vxt_volume_view* view);
/// The file's name, or the builtin's.
VXT_API const char* vxt_volume_data_name(const vxt_volume_data* data);
/// What the reader did that the user may want to know, a line each; null beyond the last one.
VXT_API const char* vxt_volume_data_note(const vxt_volume_data* data, size_t index);
/// Ends it.
VXT_API void vxt_volume_data_destroy(vxt_volume_data* data);

/// A mesh that was read or built: voxtact::MeshData.
typedef struct vxt_mesh_data vxt_mesh_data;
/// Its arrays; valid as long as the object. struct_size of `view` must be set.
VXT_CHECKED vxt_result vxt_mesh_data_view(const vxt_mesh_data* data, vxt_mesh_view* view);
/// The file's name, or the builtin's.
VXT_API const char* vxt_mesh_data_name(const vxt_mesh_data* data);
/// As vxt_volume_data_note().
VXT_API const char* vxt_mesh_data_note(const vxt_mesh_data* data, size_t index);
/// Ends it.
VXT_API void vxt_mesh_data_destroy(vxt_mesh_data* data);

/// A volume that needs no file, by the name that follows `builtin:` on the command line ("head:64").
VXT_CHECKED vxt_result vxt_builtin_volume(const char* name, vxt_volume_data** data);
/// The same for a mesh ("scalpel:3068").
VXT_CHECKED vxt_result vxt_builtin_mesh(const char* name, vxt_mesh_data** data);

#ifdef __cplusplus
}
#endif

#endif

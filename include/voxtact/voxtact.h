/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_H
#define VOXTACT_VOXTACT_H

#include "voxtact/version.h"

#include <stddef.h>
#include <stdint.h>

/// @file
/// C interface without Vulkan: data, questions and answers, the host engine, files. voxtact_vulkan.h adds Vulkan
/// devices and pictures. Terms are those of the C++ headers, which have more detail: vxt_host_volume is
/// voxtact::cpu::Volume, vxt_volume_view is voxtact::VolumeView.
///
/// Structs: a struct that begins with `struct_size` can grow. Fill the struct with zeros, set `struct_size` to its
/// `sizeof`, also where a function fills it, and set the members that you need:
/// `vxt_pairs pairs = {.struct_size = sizeof pairs, .items = &item, .item_count = 1};`. A newer library uses the
/// defaults of missing members; an older library refuses unknown members that are not zero. All elements of an array
/// have the same `struct_size`. A struct without `struct_size` never changes.
///
/// Defaults: 0 selects the default of a member; comments state defaults other than 0. Where 0 is also useful, a comment
/// names -0.0, which selects 0. Null options select all defaults. In a vxt_setting 0 is a value: for the default, leave
/// out the setting.
///
/// Values: world space is LPS, in mm. Image values are in the image's own units. A truth value is 0 or not 0. Text is
/// UTF-8 and ends with a 0. Matrices are 16 doubles, column-major: the element in row r and column c is at [4 * c + r].
/// `b_from_a` maps points of space a to space b. Colours are red, green and blue, 0..1, in the space of the picture.
///
/// Errors: functions that can fail return a vxt_result; vxt_last_error() returns the reason. Nothing throws, prints or
/// aborts. On failure a creating function sets its pointer to null. Without voxtact::io in the build, functions for
/// files return UNSUPPORTED; without voxtact::render, functions for looks and pictures.
///
/// Pointers: a returned pointer is valid as long as its object; without an object, it has static lifetime. `count`
/// receives the number of returned elements and may be null. A null object has no elements. `..._destroy()` accepts
/// null. Arguments are read during the call only, unless their comment says otherwise.
///
/// Threads: functions that take an object as const are safe from any thread. All others need the caller's lock on the
/// objects that they may change.

#if defined(__GNUC__) && defined(VOXTACT_STATIC)
#define VXT_API
#define VXT_CHECKED __attribute__((warn_unused_result))
#elif defined(__GNUC__)
/// Marks exported symbols; empty for a static library (VOXTACT_STATIC, which its packages define).
#define VXT_API __attribute__((visibility("default")))
/// Marks exported functions whose result must be checked.
#define VXT_CHECKED __attribute__((visibility("default"), warn_unused_result))
#else
#define VXT_API
#define VXT_CHECKED
#endif

#ifdef __cplusplus
extern "C" {
#endif

// ======== Errors ========

/// Result of a call. The numbers are those of voxtact::ErrorCode.
typedef enum vxt_result {
    VXT_OK = 0,                     ///< done
    VXT_ERROR_INVALID_ARGUMENT = 1, ///< an argument that no device could accept
    VXT_ERROR_UNSUPPORTED = 2,      ///< not supported by the device, its enabled features, or this build of the library
    VXT_ERROR_LIMIT_EXCEEDED = 3,   ///< a limit of the device; the text names it with its value
    VXT_ERROR_OUT_OF_MEMORY = 4,    ///< host or device memory
    VXT_ERROR_DEVICE_LOST = 5,      ///< sticky: every later call on the same context returns it
    VXT_ERROR_VULKAN = 6,           ///< another VkResult: vxt_last_vk_result()
    VXT_ERROR_FILE = 7,             ///< a file cannot be read or written
    VXT_ERROR_FORMAT = 8,           ///< the contents of a file cannot be used
    VXT_ERROR_NOT_READY = 9,        ///< the result does not exist yet, or was replaced
    VXT_ERROR_INTERNAL = 10,        ///< a bug in voxtact
    VXT_ERROR_CANCELLED = 11,       ///< the caller cancelled the call: vxt_cancel
    VXT_RESULT_MAX = 0x7fffffff
} vxt_result;

/// voxtact on one Vulkan device: voxtact_vulkan.h.
typedef struct vxt_context vxt_context;

/// Returns the version, "0.1.0".
VXT_API const char* vxt_version(void);
/// Returns the last error as one line: the argument, the reason and the fix. With a context: of any call that used it
/// or its objects, from any thread. Null: of the calling thread. Empty without an error; success does not change it.
/// Valid until the same thread calls this again.
VXT_API const char* vxt_last_error(const vxt_context* context);
/// Returns the VkResult of that error; 0 (VK_SUCCESS) if there is none.
VXT_API int32_t vxt_last_vk_result(const vxt_context* context);

// ======== Volumes, transfer functions and meshes of the caller ========

/// Position of an image's voxels in the world: voxtact::Grid.
typedef struct vxt_grid {
    double spacing[3];   ///< mm; from 1e-9 to 1e12; all 0: 1
    double origin[3];    ///< mm, within 1e12; the centre of voxel (0,0,0)
    double direction[9]; ///< columns: unit vectors along the index axes; [3 * c + r]; not singular; all 0: axes
    uint32_t size[3];    ///< voxels along x, y, z; each at least 1
} vxt_grid;

/// Storage type of a voxel: voxtact::ScalarType.
typedef enum vxt_scalar_type {
    VXT_SCALAR_UINT8 = 0,   ///< a byte
    VXT_SCALAR_INT16 = 1,   ///< two bytes
    VXT_SCALAR_UINT16 = 2,  ///< two bytes
    VXT_SCALAR_FLOAT32 = 3, ///< four bytes
    VXT_SCALAR_MAX = 0x7fffffff
} vxt_scalar_type;

/// An image that the caller owns.
typedef struct vxt_volume_view {
    size_t struct_size;
    const void* voxels;   ///< x fastest, then y, then z, without padding, in the machine's byte order, aligned
    size_t bytes;         ///< size of `voxels`
    vxt_grid grid;        ///< position of the voxels
    vxt_scalar_type type; ///< type of each voxel
} vxt_volume_view;

/// A closed interval of image values.
typedef struct vxt_range {
    double lo; ///< smallest value
    double hi; ///< largest value
} vxt_range;

/// A corner of the piecewise linear transfer function.
typedef struct vxt_control_point {
    double value;   ///< image value
    double opacity; ///< 0..1
} vxt_control_point;

/// A corner of the piecewise linear colours of pictures.
typedef struct vxt_colour_point {
    double value;     ///< image value
    double colour[3]; ///< colour of that value
} vxt_colour_point;

/// Value -> opacity: voxtact::TransferFunctionDesc.
typedef struct vxt_transfer_function_desc {
    size_t struct_size;
    const vxt_control_point* points; ///< ascending values; piecewise linear between, constant outside
    size_t point_count;              ///< at least 1
    vxt_range domain;                ///< domain of the table; lo < hi; {0, 0}: the range of the points
    uint32_t table_size;             ///< entries; 2 to 2^24; 0: 256
} vxt_transfer_function_desc;

/// A triangle mesh that the caller owns, in object space.
typedef struct vxt_mesh_view {
    size_t struct_size;
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
    double rounding;     ///< object units: voxtact::MeshFacts::rounding; above 1e-4, a note
    double deflection;   ///< object units: vxt_mesh_view::deflection
} vxt_mesh_facts;

/// Effect of a threshold on a transfer function and a volume's values: voxtact::OpacityFacts.
typedef struct vxt_opacity_facts {
    double moved;     ///< largest error of the table at an end of an opaque interval, as an image value; or infinity
    uint32_t reaches; ///< 1: some value is opaque
    uint32_t any;     ///< 1: some value of the data is opaque
} vxt_opacity_facts;

/// Whether a mesh has an inside: voxtact::SolidFacts.
typedef struct vxt_solid_facts {
    uint32_t holes;        ///< loops of edges where the surface ends; 0: closed
    uint32_t open_edges;   ///< edges of all holes together
    uint32_t non_manifold; ///< edges of more than two triangles
    uint32_t inward;       ///< 1: the triangles face inwards, which does not matter
    double longest_hole;   ///< object units: length of the longest loop
    double signed_volume;  ///< object units^3, without bounds
} vxt_solid_facts;

/// Refuses grids that voxtact::checkGrid() refuses.
VXT_CHECKED vxt_result vxt_check_grid(const vxt_grid* grid);
/// Returns the smallest and largest voxel; refuses volumes that voxtact::checkVolume() refuses. O(voxels).
VXT_CHECKED vxt_result vxt_check_volume(const vxt_volume_view* volume, vxt_range* range);
/// Returns the facts of a mesh; refuses meshes that voxtact::checkMesh() refuses. O(vertices + triangles).
VXT_CHECKED vxt_result vxt_check_mesh(const vxt_mesh_view* mesh, vxt_mesh_facts* facts);
/// Checks whether a mesh is closed. Refuses meshes that voxtact::checkSolid() refuses.
VXT_CHECKED vxt_result vxt_check_solid(const vxt_mesh_view* mesh, vxt_solid_facts* facts);
/// Computes the effect of a threshold: voxtact::checkOpacity(). `data`: the range that vxt_check_volume() returns.
VXT_CHECKED vxt_result vxt_check_opacity(const vxt_transfer_function_desc* desc, const vxt_range* data,
                                         double threshold, vxt_opacity_facts* facts);
/// Writes the `table_size` entries of a transfer function to `table`, which holds `room` entries. Refuses functions
/// that voxtact::sampleTable() refuses, and a table that is too small.
VXT_CHECKED vxt_result vxt_sample_table(const vxt_transfer_function_desc* desc, float* table, size_t room);
/// Returns "uint8", "int16", "uint16" or "float"; "unknown" for an invalid number.
VXT_API const char* vxt_scalar_type_name(vxt_scalar_type type);

// ======== Spaces, poses and boxes ========

/// The camera of the projections VIEW and TWO_VIEW.
typedef struct vxt_view {
    double clip_from_world[16]; ///< Vulkan's clip space; orthographic or perspective; not singular
    uint32_t width;             ///< pixels
    uint32_t height;            ///< pixels
} vxt_view;

/// A box of voxels.
typedef struct vxt_voxel_box {
    uint32_t first[3]; ///< lowest corner
    uint32_t size[3];  ///< voxels along each axis; 0: empty
} vxt_voxel_box;

/// Kind of motion between two poses: voxtact::Interpolation.
typedef enum vxt_interpolation {
    VXT_INTERPOLATION_SCREW = 0, ///< along and about one axis
    VXT_INTERPOLATION_SLERP = 1, ///< the centre of the mesh's box moves straight; the mesh rotates about it
    VXT_INTERPOLATION_MAX = 0x7fffffff
} vxt_interpolation;

/// Returns the matrix from index space to the world.
VXT_CHECKED vxt_result vxt_world_from_index(const vxt_grid* grid, double world_from_index[16]);
/// Returns the matrix from texture space, [0,1]^3 over the whole image, to the world.
VXT_CHECKED vxt_result vxt_world_from_texture(const vxt_grid* grid, double world_from_texture[16]);
/// Returns the inverse of vxt_world_from_texture().
VXT_CHECKED vxt_result vxt_texture_from_world(const vxt_grid* grid, double texture_from_world[16]);
/// Returns the smallest box of all voxels whose centre is within `radius` mm of a world point, as for an edit.
VXT_CHECKED vxt_result vxt_ball_voxels(const vxt_grid* grid, const double centre[3], double radius, vxt_voxel_box* box);
/// Returns an orthographic view from above whose square pixels frame the volume.
VXT_CHECKED vxt_result vxt_framing_view(const vxt_grid* grid, uint32_t width, uint32_t height, vxt_view* view);

/// Refuses elements that are not finite and a last row other than 0 0 0 1.
VXT_CHECKED vxt_result vxt_check_affine(const double b_from_a[16]);

// In these functions, the result may be one of the arguments.

/// Returns the second camera of the projection TWO_VIEW: voxtact::sideView().
VXT_CHECKED vxt_result vxt_side_view(const double clip_from_world[16], double side_from_world[16]);
/// Multiplies: c_from_a = c_from_b * b_from_a.
VXT_CHECKED vxt_result vxt_multiply(const double c_from_b[16], const double b_from_a[16], double c_from_a[16]);
/// Inverts any 4x4 matrix; the inverse of an affine one is exactly affine. Refuses a singular one.
VXT_CHECKED vxt_result vxt_inverse(const double b_from_a[16], double a_from_b[16]);
/// Transforms a point and divides by its w.
VXT_CHECKED vxt_result vxt_transform_point(const double b_from_a[16], const double point[3], double transformed[3]);
/// Returns the bounding box of a box's corners under an affine matrix, rounded outward: voxtact::transformBox().
VXT_CHECKED vxt_result vxt_transform_box(const double b_from_a[16], const vxt_box* box, vxt_box* transformed);
/// Returns the pose at a parameter from 0 to 1 between two poses: voxtact::poseBetween(). `centre`: centre of the
/// mesh's box in object space; may be null for SCREW.
VXT_CHECKED vxt_result vxt_pose_between(const double from[16], const double to[16], double parameter,
                                        vxt_interpolation interpolation, const double centre[3],
                                        double world_from_object[16]);

/// Indices of two boxes that overlap.
typedef struct vxt_box_pair {
    uint32_t first;  ///< index in the first array
    uint32_t second; ///< index in the same array, or in the second one
} vxt_box_pair;

/// Pairs found by a broad phase.
typedef struct vxt_box_pairs vxt_box_pairs;
/// Finds all pairs of closed boxes that share a point, sorted: within `left` if `right` is null, else between the two.
VXT_CHECKED vxt_result vxt_overlapping_pairs(const vxt_box* left, size_t left_count, const vxt_box* right,
                                             size_t right_count, vxt_box_pairs** pairs);
/// Returns the pairs.
VXT_API const vxt_box_pair* vxt_box_pairs_get(const vxt_box_pairs* pairs, size_t* count);
VXT_API void vxt_box_pairs_destroy(vxt_box_pairs* pairs);

/// Returns the bounding boxes of one box at `count` poses, 16 doubles each, in `boxes`.
VXT_CHECKED vxt_result vxt_boxes_at(const double* world_from_object, size_t count, const vxt_box* box, vxt_box* boxes);

// ======== Volumes, meshes and label maps of the library ========

/// An image that was read or created: voxtact::VolumeData.
typedef struct vxt_volume_data vxt_volume_data;
/// Creates a builtin volume, by the name after `builtin:` on the command line ("head:64").
VXT_CHECKED vxt_result vxt_builtin_volume(const char* name, vxt_volume_data** data);
/// Returns a view of the voxels.
VXT_CHECKED vxt_result vxt_volume_data_view(const vxt_volume_data* data, vxt_volume_view* view);
/// Returns the name of the file or builtin.
VXT_API const char* vxt_volume_data_name(const vxt_volume_data* data);
/// Returns a note of the reader for the user, one line each; null beyond the last one.
VXT_API const char* vxt_volume_data_note(const vxt_volume_data* data, size_t index);
VXT_API void vxt_volume_data_destroy(vxt_volume_data* data);

/// A mesh that was read or created: voxtact::MeshData.
typedef struct vxt_mesh_data vxt_mesh_data;
/// Creates a builtin mesh, by the name after `builtin:` on the command line ("scalpel:3068").
VXT_CHECKED vxt_result vxt_builtin_mesh(const char* name, vxt_mesh_data** data);
/// Fills each hole by a fan: voxtact::fillHoles(). `area`: added area, object units^2; may be null.
VXT_CHECKED vxt_result vxt_mesh_fill_holes(const vxt_mesh_view* mesh, vxt_mesh_data** filled, double* area);
/// Returns a view of the arrays.
VXT_CHECKED vxt_result vxt_mesh_data_view(const vxt_mesh_data* data, vxt_mesh_view* view);
/// Returns the name of the file or builtin.
VXT_API const char* vxt_mesh_data_name(const vxt_mesh_data* data);
/// Like vxt_volume_data_note().
VXT_API const char* vxt_mesh_data_note(const vxt_mesh_data* data, size_t index);
VXT_API void vxt_mesh_data_destroy(vxt_mesh_data* data);

/// A label map in host memory: voxtact::LabelData.
typedef struct vxt_labels vxt_labels;
/// Creates a label map from an image of labels. Refuses images that voxtact::makeLabels() refuses.
VXT_CHECKED vxt_result vxt_labels_create(const vxt_volume_view* volume, vxt_labels** labels);
/// Extends a label map to a volume's grid, which must contain the map's grid: voxtact::labelsOnGrid().
VXT_CHECKED vxt_result vxt_labels_on_grid(const vxt_labels* labels, const vxt_grid* volume, vxt_labels** on_grid);
/// Returns the labels, ascending, each once, including 0.
VXT_API const int32_t* vxt_labels_values(const vxt_labels* labels, size_t* count);
/// Returns the position of the voxels.
VXT_CHECKED vxt_result vxt_labels_grid(const vxt_labels* labels, vxt_grid* grid);
/// Returns the label at a world point; 0 outside the map's grid.
VXT_CHECKED vxt_result vxt_labels_at(const vxt_labels* labels, const double world[3], int32_t* label);
/// Returns the labels at `count` world points, three coordinates each, in `found`.
VXT_CHECKED vxt_result vxt_labels_at_points(const vxt_labels* labels, const double* points, size_t count,
                                            int32_t* found);
/// Returns the labels that a straight line crosses, in order, each once, without 0: voxtact::labelsAlong(). Writes at
/// most `room` labels to `found`, which may be null if `room` is 0; `count`, not null, receives their number.
VXT_CHECKED vxt_result vxt_labels_along(const vxt_labels* labels, const double from[3], const double to[3],
                                        int32_t* found, size_t room, size_t* count);
VXT_API void vxt_labels_destroy(vxt_labels* labels);

// ======== Counting methods ========

/// How passing fragments are counted: voxtact::CountingMethod.
typedef enum vxt_method {
    VXT_METHOD_QUERY = 0,     ///< precise occlusion query, one per pair
    VXT_METHOD_QUERY_ANY = 1, ///< occlusion query without the precise bit: zero or not zero
    VXT_METHOD_ATOMIC = 2,    ///< one atomicAdd per passing fragment
    VXT_METHOD_SUBGROUP = 3,  ///< ballot, then one atomicAdd per subgroup
    VXT_METHOD_COMPUTE = 4,   ///< no rasteriser: a compute shader covers the same pixels by the same rule
    VXT_METHOD_CPU = 5,       ///< on the host, without a device
    VXT_METHOD_MAX = 0x7fffffff
} vxt_method;

/// How triangles become fragments: voxtact::Projection.
typedef enum vxt_projection {
    VXT_PROJECTION_VIEW = 0,          ///< the caller's camera and viewport
    VXT_PROJECTION_TWO_VIEW = 1,      ///< the view, and its view volume seen along its x
    VXT_PROJECTION_DOMINANT_AXIS = 2, ///< each triangle along its own dominant axis in voxel space: no camera
    VXT_PROJECTION_CERTIFIED = 3,     ///< every voxel cell that a triangle passes through, decided with bounds
    VXT_PROJECTION_MAX = 0x7fffffff
} vxt_projection;

/// How the image is sampled: voxtact::Filter.
typedef enum vxt_filter {
    VXT_FILTER_HARDWARE = 0, ///< the device's sampler
    VXT_FILTER_EXACT = 1,    ///< fp32 in a fixed order: the same bits on every device and on the host
    VXT_FILTER_MAX = 0x7fffffff
} vxt_filter;

/// Treatment of fragments outside the volume: voxtact::Boundary.
typedef enum vxt_boundary {
    VXT_BOUNDARY_AUTO = 0,  ///< CLAMP if it provably gives the same count
    VXT_BOUNDARY_RANGE = 1, ///< a range test discards them
    VXT_BOUNDARY_CLAMP = 2, ///< the coordinate is clamped; the caller guarantees transparent boundary voxels
    VXT_BOUNDARY_MAX = 0x7fffffff
} vxt_boundary;

/// Meaning of a count: voxtact::Exactness.
typedef enum vxt_exactness {
    VXT_EXACTNESS_EXACT = 0,       ///< the exact count
    VXT_EXACTNESS_LOWER_BOUND = 1, ///< a lower bound
    VXT_EXACTNESS_REFUSED = 2,     ///< nothing was counted: the pose on the device is not finite or not affine
    VXT_EXACTNESS_MAX = 0x7fffffff
} vxt_exactness;

/// Additional outputs of a detector: bits of `outputs`.
typedef enum vxt_output {
    VXT_OUTPUT_TRIANGLES = 1, ///< triangles with passing fragments, and their counts
    VXT_OUTPUT_CONTACTS = 2,  ///< a contact per passing fragment, up to the capacity
    VXT_OUTPUT_BOUNDS = 4,    ///< world bounding box of each pair's passing fragments
    VXT_OUTPUT_LABELS = 8,    ///< counts per label of the passing fragments; the items need label maps
    VXT_OUTPUT_MAX = 0x7fffffff
} vxt_output;

/// Return the names on the command line ("query-any"); "unknown" for an invalid number.
/// @{
VXT_API const char* vxt_method_name(vxt_method method);
VXT_API const char* vxt_projection_name(vxt_projection projection);
VXT_API const char* vxt_filter_name(vxt_filter filter);
VXT_API const char* vxt_boundary_name(vxt_boundary boundary);
VXT_API const char* vxt_exactness_name(vxt_exactness exactness);
/// @}
/// Inverts vxt_method_name().
VXT_CHECKED vxt_result vxt_method_from_name(const char* name, vxt_method* method);
/// Inverts vxt_projection_name().
VXT_CHECKED vxt_result vxt_projection_from_name(const char* name, vxt_projection* projection);
/// Returns 1 if a projection uses the batch's view, else 0.
VXT_API uint32_t vxt_projection_uses_view(vxt_projection projection);
/// Returns the best exactness of a method.
VXT_API vxt_exactness vxt_method_exactness(vxt_method method);
/// Returns EXACT for methods that give the same count on every device with it (compute, cpu), HARDWARE for the others.
VXT_API vxt_filter vxt_default_filter(vxt_method method);

// ======== Host scene ========

/// A 3D image of the host engine: voxtact::cpu::Volume. Edit only between questions; the next question uses the edit.
typedef struct vxt_host_volume vxt_host_volume;
/// Copies the voxels.
VXT_CHECKED vxt_result vxt_host_volume_create(const vxt_volume_view* view, vxt_host_volume** volume);
/// Returns the position of the voxels.
VXT_CHECKED vxt_result vxt_host_volume_grid(const vxt_host_volume* volume, vxt_grid* grid);
/// Sets the voxels of a box to a value.
VXT_CHECKED vxt_result vxt_host_volume_set_box(vxt_host_volume* volume, const vxt_voxel_box* box, double value);
/// Sets the voxels whose centre is within `radius` mm of a world point to a value.
VXT_CHECKED vxt_result vxt_host_volume_set_ball(vxt_host_volume* volume, const double centre[3], double radius,
                                                double value);
/// Replaces the voxels of a box by scalars of the volume's type, x fastest, without padding.
VXT_CHECKED vxt_result vxt_host_volume_write(vxt_host_volume* volume, const vxt_voxel_box* box, const void* voxels,
                                             size_t bytes);
/// Copies the current voxels of a box, in the layout of vxt_host_volume_write().
VXT_CHECKED vxt_result vxt_host_volume_read(const vxt_host_volume* volume, const vxt_voxel_box* box, void* voxels,
                                            size_t bytes);
VXT_API void vxt_host_volume_destroy(vxt_host_volume* volume);

/// Value -> opacity on the host: voxtact::cpu::TransferFunction.
typedef struct vxt_host_transfer_function vxt_host_transfer_function;
/// Creates a transfer function. Refuses functions that voxtact::sampleTable() refuses.
VXT_CHECKED vxt_result vxt_host_transfer_function_create(const vxt_transfer_function_desc* desc,
                                                         vxt_host_transfer_function** function);
VXT_API void vxt_host_transfer_function_destroy(vxt_host_transfer_function* function);

/// A triangle mesh on the host: voxtact::cpu::Mesh.
typedef struct vxt_host_mesh vxt_host_mesh;
/// Copies the arrays.
VXT_CHECKED vxt_result vxt_host_mesh_create(const vxt_mesh_view* view, vxt_host_mesh** mesh);
/// Returns facts of the mesh: sizes, bounds and rounding.
VXT_CHECKED vxt_result vxt_host_mesh_facts(const vxt_host_mesh* mesh, vxt_mesh_facts* facts);
/// Moves all vertices, three coordinates each: voxtact::cpu::Mesh::update(). No other call may use the mesh meanwhile.
VXT_CHECKED vxt_result vxt_host_mesh_update(vxt_host_mesh* mesh, const double* positions, size_t vertex_count);
VXT_API void vxt_host_mesh_destroy(vxt_host_mesh* mesh);

/// A cancel flag for any thread: calls that read a set flag soon return CANCELLED, even after a reset.
typedef struct vxt_cancel vxt_cancel;
/// Creates a cancel flag, initially not set.
VXT_CHECKED vxt_result vxt_cancel_create(vxt_cancel** cancel);
/// Sets the flag, or resets it with 0. Null is allowed.
VXT_API void vxt_cancel_set(vxt_cancel* cancel, uint32_t set);
/// Destroys the object. No call may use it.
VXT_API void vxt_cancel_destroy(vxt_cancel* cancel);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_host_item {
    const vxt_host_mesh* mesh;                           ///< the mesh
    const vxt_host_volume* volume;                       ///< the image
    const vxt_host_transfer_function* transfer_function; ///< defines the opaque region
    const double* world_from_object;                     ///< 16 doubles per pose; affine
    size_t pose_count;                                   ///< number of poses; one pair each
    const vxt_labels* labels;                            ///< for questions about labels; else null
} vxt_host_item;

/// The pairs of one call: the items in order, each with its poses in order.
typedef struct vxt_pairs {
    size_t struct_size;
    const vxt_host_item* items; ///< any number; the answers have the same order
    size_t item_count;          ///< length of `items`
    const vxt_view* view;       ///< for projections with a camera; else null
    double opacity_threshold;   ///< above 0, up to 1: opacity of an opaque value; 0: 0.1; -0.0: all is opaque
    vxt_cancel* cancel;         ///< cancels the call; may be null
} vxt_pairs;

// ======== Questions ========

/// A setting of a question: its name and one value, of the kind that vxt_fact_get() returns. A choice sets only `text`;
/// a list sets only `numbers` or `labels`; numbers and flags set none of these. Unset pointers are null.
typedef struct vxt_setting {
    const char* name;      ///< "tolerance"
    double number;         ///< value of a number or whole number; of a flag: 0 or 1
    const char* text;      ///< value of a choice: one of its names
    const double* numbers; ///< value of a list of numbers
    const int32_t* labels; ///< value of a list of labels
    size_t count;          ///< length of the list; an empty list needs a pointer, too
} vxt_setting;

/// A question about pairs: voxtact::NamedQuestion.
typedef struct vxt_question {
    size_t struct_size;
    const char* name;     ///< "touch"
    const char* text;     ///< "does it touch?"
    uint32_t measures;    ///< 1: the table `pairs` has bounds: the columns `lower` and `upper`
    uint32_t least_worst; ///< 1: the worst pair has the smallest bounds; 0: the largest
} vxt_question;
/// Returns the number of questions: touch, count, distance, area, overlap, motion.
VXT_API size_t vxt_question_count(void);
/// Returns a question by index. The texts have static lifetime.
VXT_CHECKED vxt_result vxt_question_get(size_t index, vxt_question* question);

/// A region that paths must avoid: voxtact::cpu::PlanObstacle.
typedef struct vxt_obstacle {
    const vxt_host_volume* volume;                       ///< required
    const vxt_host_transfer_function* transfer_function; ///< defines the opaque region; null: labels at any opacity
    const vxt_labels* labels;                            ///< on the volume's grid; null: the whole opaque region
    const int32_t* avoid;                                ///< labels to avoid
    size_t avoid_count;                                  ///< length of `avoid`
    double opacity_threshold;                            ///< above 0, up to 1; 0: 0.1
    const char* name;                                    ///< used in messages; null: "obstacle" and its index
} vxt_obstacle;

/// Which straight paths keep clear of obstacles? voxtact::cpu::Plan. An entry is the point at which a direction from
/// the target leaves the opaque region of `entry_volume`, a label, or a ball; set exactly one of the three.
typedef struct vxt_plan {
    size_t struct_size;
    const vxt_obstacle* obstacles;                             ///< at least one
    size_t obstacle_count;                                     ///< length of `obstacles`
    const vxt_host_volume* entry_volume;                       ///< with a transfer function: its opaque region
    const vxt_host_transfer_function* entry_transfer_function; ///< of entry_volume
    const vxt_labels* entry_labels;                            ///< instead of a volume: a label map
    const vxt_host_mesh* mesh;                                 ///< the instrument, instead of the needle; may be null
    vxt_cancel* cancel;                                        ///< cancels the call; may be null
    double target[3];                                          ///< destination of the tip
    double mesh_tip[3];                                        ///< object space: moves to the target
    double mesh_axis[3];         ///< object space: from the tip to the handle; all 0: 0 0 1
    double entry_threshold;      ///< above 0, up to 1: of entry_volume; 0: 0.1
    double entry_radius;         ///< mm, above 0.001: radius of a ball, without a volume and labels
    double needle_diameter;      ///< mm, above 0; 0: 2
    double needle_length;        ///< mm, from tip to end; at least the diameter; 0: 200
    double margin;               ///< mm: distance of a safe path from the obstacles
    double max_length;           ///< mm: maximum length of a path; 0: no limit
    double max_angle;            ///< with limit_angle: maximum degrees between a path and the normal of the surface
    uint32_t limit_angle;        ///< 0: any angle, also without a normal
    uint32_t entries;            ///< directions; rounded up to 10 n^2 + 2; 0: 1002
    int32_t entry_label;         ///< label value in entry_labels
    uint32_t border_entries;     ///< 1: paths may also begin where the image's border cuts the region
    uint32_t triangle_distances; ///< 1: needle only: the column `distance` of triangles; doubles the time
    double tolerance;            ///< mm: stop when upper - lower is at most this
    double max;                  ///< mm: stop when lower reaches this distance; 0: 10
    uint64_t max_steps;          ///< iteration limit per path
} vxt_plan;

// ======== Answers ========

/// Answers as tables. Each question has a table `pairs` (motion: `segments`, plan: `paths`) with one row per pair in
/// order, further tables, and `totals` with one row. A question replaces the answer in the object.
typedef struct vxt_answer vxt_answer;
/// Creates an empty answer.
VXT_CHECKED vxt_result vxt_answer_create(vxt_answer** answer);
VXT_API void vxt_answer_destroy(vxt_answer* answer);

/// Type of a column's elements.
typedef enum vxt_type {
    VXT_TYPE_UINT32 = 0, ///< a number, or an index into `choices` of the column
    VXT_TYPE_INT32 = 1,  ///< a label
    VXT_TYPE_UINT64 = 2, ///< a count
    VXT_TYPE_DOUBLE = 3, ///< in `unit`
    VXT_TYPE_MAX = 0x7fffffff
} vxt_type;

/// A column of an answer. Its texts have static lifetime; `data` is valid until the next answer in the object.
typedef struct vxt_column {
    size_t struct_size;
    const char* table;   ///< "pairs"
    const char* name;    ///< "lower"
    const char* unit;    ///< "mm"; "" for none
    const char* text;    ///< one line: meaning
    const char* choices; ///< of an enumeration, the names of 0, 1, 2 ...: "no,yes,undecided"; else ""
    const void* data;    ///< first row; null without rows
    size_t rows;         ///< number of rows of the table
    size_t stride;       ///< bytes from row to row
    vxt_type type;       ///< type of each element
    uint32_t elements;   ///< per row: 1, 3 for a point, 16 for a pose
    size_t offset;       ///< bytes from the start of a row to the column
} vxt_column;

/// Returns the number of columns in all tables of an answer; 0 for null.
VXT_API size_t vxt_answer_columns(const vxt_answer* answer);
/// Returns a column by index.
VXT_CHECKED vxt_result vxt_answer_column(const vxt_answer* answer, size_t index, vxt_column* column);
/// Returns a column by name, or NOT_READY if the answer does not have it.
VXT_CHECKED vxt_result vxt_answer_find(const vxt_answer* answer, const char* table, const char* name,
                                       vxt_column* column);

// ======== Host engine ========

/// Answers questions on the host: voxtact::cpu::HostEngine. One call at a time.
typedef struct vxt_host_engine vxt_host_engine;
/// Starts the threads; 0: one per processor.
VXT_CHECKED vxt_result vxt_host_engine_create(uint32_t threads, vxt_host_engine** engine);
/// Returns the number of threads; 0 for null.
VXT_API uint32_t vxt_host_engine_threads(const vxt_host_engine* engine);
VXT_API void vxt_host_engine_destroy(vxt_host_engine* engine);

/// Answers a question for every pair: voxtact::ask(). Settings that are not in `settings` have their defaults. Refuses
/// an unknown question or setting, a setting given twice, and a value of another kind or outside its range. An overlap
/// needs closed meshes: vxt_mesh_fill_holes() fills holes. After a failure `answer` is unchanged. The C++ structs of
/// the questions, such as voxtact::Touch, describe the settings.
VXT_CHECKED vxt_result vxt_ask(vxt_host_engine* engine, const char* question, const vxt_setting* settings,
                               size_t setting_count, const vxt_pairs* pairs, vxt_answer* answer);
/// Answers a plan, which has no pairs. The question must not be null.
VXT_CHECKED vxt_result vxt_ask_plan(vxt_host_engine* engine, const vxt_plan* question, vxt_answer* answer);

/// State of a moving mesh at one pose: voxtact::TrackedDistance.
typedef struct vxt_tracked {
    size_t struct_size;
    double lower;      ///< mm: lower bound of the distance
    double upper;      ///< mm: upper bound of the distance; infinite if unknown
    uint32_t touch;    ///< 0: no, proven; 1: yes, proven; 2: undecided
    uint32_t searched; ///< 1: the volume was searched; 0: earlier bounds were enough
} vxt_tracked;
/// Tracks a mesh that moves little from call to call, on the calling thread: voxtact::cpu::DistanceTracker.
typedef struct vxt_tracker vxt_tracker;
/// Creates a tracker. `max`: search radius, mm; 0: unlimited. `resolution`: voxels; 0: 1/64. `max_steps`: iteration
/// limit per search; 0: 512.
VXT_CHECKED vxt_result vxt_tracker_create(double max, double resolution, uint64_t max_steps, vxt_tracker** tracker);
/// Tracks the mesh at the one pose of the item. `opacity_threshold`: above 0, up to 1; 0: 0.1.
VXT_CHECKED vxt_result vxt_tracker_track(vxt_tracker* tracker, const vxt_host_item* item, double opacity_threshold,
                                         vxt_tracked* tracked);
VXT_API void vxt_tracker_destroy(vxt_tracker* tracker);

// ======== Limits and defaults ========

/// Limits and defaults that are whole numbers.
typedef enum vxt_limit {
    VXT_MAX_THREADS = 4096,          ///< threads of a host engine
    VXT_MAX_TABLE_SIZE = 16777216,   ///< entries of a transfer function's table
    VXT_MAX_SAMPLES_PER_VOXEL = 16,  ///< setting `samples_per_voxel` of count
    VXT_MAX_ENTRIES = 3994242,       ///< vxt_plan::entries
    VXT_DEFAULT_TABLE_SIZE = 256,    ///< entries of a transfer function's table
    VXT_DEFAULT_ENTRIES = 1002,      ///< vxt_plan::entries
    VXT_DEFAULT_PLAN_MAX = 10,       ///< mm, vxt_plan::max
    VXT_DEFAULT_PLAN_STEPS = 262144, ///< vxt_plan::max_steps
    VXT_DEFAULT_TRACKER_STEPS = 512, ///< vxt_tracker_create()
    VXT_LIMIT_MAX = 0x7fffffff
} vxt_limit;

/// Kind of a setting's value.
typedef enum vxt_fact_kind {
    VXT_FACT_NUMBER = 0,  ///< a number in `unit`
    VXT_FACT_WHOLE = 1,   ///< a whole number
    VXT_FACT_FLAG = 2,    ///< 0 or 1
    VXT_FACT_CHOICE = 3,  ///< one of `choices`
    VXT_FACT_NUMBERS = 4, ///< a list of numbers
    VXT_FACT_LABELS = 5,  ///< a list of labels
    VXT_FACT_MAX = 0x7fffffff
} vxt_fact_kind;

/// Kind, range and default of a setting. The texts have static lifetime.
typedef struct vxt_fact {
    size_t struct_size;
    const char* question;  ///< "touch"; "scene" and "plan": members of structs, not settings
    const char* name;      ///< vxt_setting::name
    const char* unit;      ///< "mm", "mm^2", "degrees", "voxels"; "" for none
    const char* text;      ///< one line
    const char* range;     ///< "from 1e-06 mm on"; a flag: "0 or 1"; a choice: its names; a list: "a list"
    double min;            ///< smallest number
    double max;            ///< largest number
    double standard;       ///< the default, if has_standard is 1
    uint32_t has_standard; ///< 0: the default is not a number, or the setting is optional
    vxt_fact_kind kind;    ///< kind of the value
    const char* choices;   ///< a choice: its names, comma-separated, the default first; else ""
} vxt_fact;
/// Returns the number of facts.
VXT_API size_t vxt_fact_count(void);
/// Returns a fact by index.
VXT_CHECKED vxt_result vxt_fact_get(size_t index, vxt_fact* fact);

// ======== Files ========

/// Selects an image of a file or folder that holds several.
typedef struct vxt_volume_read_options {
    size_t struct_size;
    const char* series;    ///< SeriesInstanceUID in a DICOM folder; null: the only series
    uint32_t choose_frame; ///< 1: uses `frame`; 0: the only image
    uint32_t frame;        ///< index in a 4D NIfTI file, from 0
    uint32_t resample;     ///< 1: resamples DICOM slices without a regular grid, with a note; 0: refuses them
} vxt_volume_read_options;

/// Unit and space of a mesh file.
typedef struct vxt_mesh_read_options {
    size_t struct_size;
    double scale;      ///< millimetres per unit of the file; 0: 1
    uint32_t ras;      ///< 1: RAS coordinates: x and y are negated; 0: as the file states, else LPS
    double deflection; ///< mm, for the triangulation of STEP and IGES; 0: 0.01
} vxt_mesh_read_options;

/// Reads a volume from a file or a DICOM folder: voxtact::io::readVolume().
VXT_CHECKED vxt_result vxt_read_volume(const char* path, const vxt_volume_read_options* options,
                                       vxt_volume_data** data);
/// Like vxt_read_volume(), from the bytes of one file; the ending of `name` selects the format.
VXT_CHECKED vxt_result vxt_read_volume_bytes(const char* name, const void* content, size_t bytes,
                                             const vxt_volume_read_options* options, vxt_volume_data** data);
/// Writes a volume: voxtact::io::writeVolume().
VXT_CHECKED vxt_result vxt_write_volume(const char* path, const vxt_volume_view* volume);
/// Reads a mesh from a file: voxtact::io::readMesh().
VXT_CHECKED vxt_result vxt_read_mesh(const char* path, const vxt_mesh_read_options* options, vxt_mesh_data** data);
/// Like vxt_read_mesh(), from the bytes of one file; the ending of `name` selects the format.
VXT_CHECKED vxt_result vxt_read_mesh_bytes(const char* name, const void* content, size_t bytes,
                                           const vxt_mesh_read_options* options, vxt_mesh_data** data);
/// Writes a mesh: voxtact::io::writeMesh().
VXT_CHECKED vxt_result vxt_write_mesh(const char* path, const vxt_mesh_view* mesh);
/// Writes a PNG file of 8 bits per channel, red, green, blue and alpha of each pixel, the uppermost row first:
/// voxtact::io::writePng().
VXT_CHECKED vxt_result vxt_write_png(const char* path, uint32_t width, uint32_t height, const void* rgba, size_t bytes);
/// Reads one `clip_from_world` matrix: voxtact::io::readCamera().
VXT_CHECKED vxt_result vxt_read_camera(const char* path, double clip_from_world[16]);

/// Returns the largest deviation of a grid's axes from right angles, degrees: voxtact::io::shearDegrees().
/// `max_degrees` receives the maximum for a NIfTI sform; may be null.
VXT_CHECKED vxt_result vxt_grid_shear(const vxt_grid* grid, double* degrees, double* max_degrees);
/// Return the readers' note on a sheared grid, or on vertices that single precision rounds; otherwise "". Valid until
/// the same thread calls again.
/// @{
VXT_API const char* vxt_grid_note(const vxt_grid* grid);
VXT_API const char* vxt_mesh_note(const vxt_mesh_facts* facts);
/// @}

/// Contents of a file.
/// @{
typedef struct vxt_poses vxt_poses;
typedef struct vxt_control_points vxt_control_points;
typedef struct vxt_colour_points vxt_colour_points;
typedef struct vxt_label_names vxt_label_names;
typedef struct vxt_points vxt_points;
/// @}
/// Reads poses: voxtact::io::readPoses(). `format`: "matrix", "t-xyzw", "t-wxyz", "xyzw-t" or "wxyz-t"; null: "matrix".
VXT_CHECKED vxt_result vxt_read_poses(const char* path, const char* format, vxt_poses** poses);
/// Returns 16 doubles per pose, in the layout of vxt_host_item::world_from_object. `count`: poses.
VXT_API const double* vxt_poses_get(const vxt_poses* poses, size_t* count);
VXT_API void vxt_poses_destroy(vxt_poses* poses);
/// Reads a transfer function: voxtact::io::readTransferFunction().
VXT_CHECKED vxt_result vxt_read_transfer_function(const char* path, vxt_control_points** points);
/// Parses control points from "v:a,v:a,...".
VXT_CHECKED vxt_result vxt_parse_opacity(const char* text, vxt_control_points** points);
/// Returns the points.
VXT_API const vxt_control_point* vxt_control_points_get(const vxt_control_points* points, size_t* count);
VXT_API void vxt_control_points_destroy(vxt_control_points* points);
/// Reads the colours of a transfer function's file; none without colours: voxtact::io::readColours().
VXT_CHECKED vxt_result vxt_read_colours(const char* path, vxt_colour_points** points);
/// Returns the points.
VXT_API const vxt_colour_point* vxt_colour_points_get(const vxt_colour_points* points, size_t* count);
VXT_API void vxt_colour_points_destroy(vxt_colour_points* points);
/// Reads lines `number name`: voxtact::io::readLabelNames().
VXT_CHECKED vxt_result vxt_read_label_names(const char* path, vxt_label_names** names);
/// Returns the name at an index, in the file's order, and its label; null beyond the last one. `label` may be null.
VXT_API const char* vxt_label_names_get(const vxt_label_names* names, size_t index, int32_t* label);
VXT_API void vxt_label_names_destroy(vxt_label_names* names);
/// Reads lines `x y z` or `x y z name`, or 3D Slicer's .fcsv or .mrk.json: voxtact::io::readPoints().
VXT_CHECKED vxt_result vxt_read_points(const char* path, vxt_points** points);
/// Returns the name at an index, in the file's order; "" without a name, null beyond the last one. Also returns
/// position and line, from 1; both may be null.
VXT_API const char* vxt_points_get(const vxt_points* points, size_t index, double position[3], uint64_t* line);
VXT_API void vxt_points_destroy(vxt_points* points);

/// Reads poses in parts, in constant memory, like vxt_read_poses(): voxtact::io::PoseReader.
typedef struct vxt_pose_reader vxt_pose_reader;
/// Opens a file.
VXT_CHECKED vxt_result vxt_pose_reader_open(const char* path, const char* format, vxt_pose_reader** reader);
/// Reads at most `most` poses into `poses`, 16 doubles each. `count` receives their number: 0 at the end.
VXT_CHECKED vxt_result vxt_pose_reader_read(vxt_pose_reader* reader, double* poses, size_t most, size_t* count);
VXT_API void vxt_pose_reader_destroy(vxt_pose_reader* reader);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_H
#define VOXTACT_VOXTACT_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// @file
/// voxtact in C: data, the host engine, files and builtins. Nothing here needs Vulkan; what runs on a Vulkan device is
/// in voxtact_vulkan.h. The words are those of the C++ headers, whose comments say more: vxt_host_volume is
/// voxtact::cpu::Volume, and vxt_volume_view is voxtact::VolumeView.
///
/// Structs that begin with `struct_size` can grow. Make one with its `..._init()`, which gives it its size and its
/// defaults, or fill it with zeros and set `struct_size` to its `sizeof` and every member yourself. A library that
/// knows more members takes the defaults of those that are missing; one that knows fewer refuses members that are not
/// zero. In an array of them all have the same `struct_size`. A struct without `struct_size` never changes.
///
/// Functions that can fail return a vxt_result, and vxt_last_error() has the reason. One that makes an object sets the
/// pointer to null where it fails. Every `..._destroy()` accepts null. Nothing is thrown, printed or aborted. Pointers
/// in arguments are read during the call only, unless their comment says otherwise. A truth value is 0 or not 0. Text
/// is UTF-8 and ends with a 0.
///
/// Matrices are 16 doubles, column by column: the element in row r and column c is at [4 * c + r]. `b_from_a` takes
/// points of space a to space b.
///
/// Thread-safety: functions that take an object as const are safe from any thread; all others need the caller's lock
/// for the objects that they take as not const.

#if defined(__GNUC__)
/// What the library exports.
#define VXT_API __attribute__((visibility("default")))
/// The same, of a function whose result must be looked at.
#define VXT_CHECKED __attribute__((visibility("default"), warn_unused_result))
#else
#define VXT_API
#define VXT_CHECKED
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// How a call ended. The numbers are those of voxtact::ErrorCode.
typedef enum vxt_result {
    VXT_OK = 0,                     ///< done
    VXT_ERROR_INVALID_ARGUMENT = 1, ///< an argument that no device could accept
    VXT_ERROR_UNSUPPORTED = 2,      ///< the device, its enabled features, or this build of the library cannot do this
    VXT_ERROR_LIMIT_EXCEEDED = 3,   ///< a limit of the device, named in the text with its size
    VXT_ERROR_OUT_OF_MEMORY = 4,    ///< host or device memory
    VXT_ERROR_DEVICE_LOST = 5,      ///< sticky: every later call on the same context returns it
    VXT_ERROR_VULKAN = 6,           ///< another VkResult: vxt_last_vk_result()
    VXT_ERROR_FILE = 7,             ///< a file cannot be read or written
    VXT_ERROR_FORMAT = 8,           ///< a file can be read, but what it holds cannot be used
    VXT_ERROR_NOT_READY = 9,        ///< the result asked for does not exist yet, or no longer
    VXT_ERROR_INTERNAL = 10,        ///< a bug in voxtact
    VXT_RESULT_MAX = 0x7fffffff     ///< makes the type 32 bits wide
} vxt_result;

/// voxtact on one Vulkan device: voxtact_vulkan.h.
typedef struct vxt_context vxt_context;

/// "0.1.0"; it lives for ever.
VXT_API const char* vxt_version(void);
/// One line about what went wrong last: which argument, why, and what to do. Of a context: in any call that had to do
/// with it or with what was made with it, from any thread. Null: in the calling thread. Empty where nothing did.
/// Success does not change it. Valid until the same thread asks again.
VXT_API const char* vxt_last_error(const vxt_context* context);
/// The VkResult behind that error; 0 (VK_SUCCESS) where there is none.
VXT_API int32_t vxt_last_vk_result(const vxt_context* context);

/// How surviving fragments are counted: voxtact::CountingMethod.
typedef enum vxt_method {
    VXT_METHOD_QUERY = 0,       ///< precise occlusion query, one a pair
    VXT_METHOD_QUERY_ANY = 1,   ///< occlusion query without the precise bit: zero or not zero
    VXT_METHOD_ATOMIC = 2,      ///< one atomicAdd a survivor
    VXT_METHOD_SUBGROUP = 3,    ///< ballot, then one atomicAdd a subgroup
    VXT_METHOD_COMPUTE = 4,     ///< no rasteriser: a compute shader covers the same pixels by the same rule
    VXT_METHOD_CPU = 5,         ///< the host, no device
    VXT_METHOD_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_method;

/// How a mesh is turned into fragments: voxtact::Projection.
typedef enum vxt_projection {
    VXT_PROJECTION_VIEW = 0,          ///< the caller's camera and viewport
    VXT_PROJECTION_TWO_VIEW = 1,      ///< the view, and its view volume seen along its x
    VXT_PROJECTION_DOMINANT_AXIS = 2, ///< each triangle along its own dominant axis in voxel space: no camera
    VXT_PROJECTION_CONSERVATIVE = 3,  ///< every voxel cell that a triangle passes through, decided with bounds
    VXT_PROJECTION_MAX = 0x7fffffff   ///< makes the type 32 bits wide
} vxt_projection;

/// How the image is sampled: voxtact::Filter.
typedef enum vxt_filter {
    VXT_FILTER_HARDWARE = 0,    ///< the device's sampler
    VXT_FILTER_EXACT = 1,       ///< fp32 in a written order: the same bits on every device and on the host
    VXT_FILTER_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_filter;

/// What happens to fragments outside of the volume: voxtact::Boundary.
typedef enum vxt_boundary {
    VXT_BOUNDARY_AUTO = 0,        ///< CLAMP where it provably gives the same count
    VXT_BOUNDARY_RANGE = 1,       ///< a range test discards them
    VXT_BOUNDARY_CLAMP = 2,       ///< the coordinate is clamped. The caller vouches for transparent boundary voxels
    VXT_BOUNDARY_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_boundary;

/// What a count is worth: voxtact::Exactness.
typedef enum vxt_exactness {
    VXT_EXACTNESS_EXACT = 0,       ///< it is the count
    VXT_EXACTNESS_LOWER_BOUND = 1, ///< at least that many
    VXT_EXACTNESS_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_exactness;

/// The names as on the command line ("query-any"); they live for ever; "unknown" for a number that is none.
/// @{
VXT_API const char* vxt_method_name(vxt_method method);
VXT_API const char* vxt_projection_name(vxt_projection projection);
VXT_API const char* vxt_filter_name(vxt_filter filter);
VXT_API const char* vxt_boundary_name(vxt_boundary boundary);
VXT_API const char* vxt_exactness_name(vxt_exactness exactness);
/// @}
/// The inverse of vxt_method_name().
VXT_CHECKED vxt_result vxt_method_from_name(const char* name, vxt_method* method);
/// The inverse of vxt_projection_name().
VXT_CHECKED vxt_result vxt_projection_from_name(const char* name, vxt_projection* projection);
/// EXACT for the methods that are the same on every device with it (compute, cpu), HARDWARE for the others.
VXT_API vxt_filter vxt_default_filter(vxt_method method);

/// What a detector answers beside the counts: bits of `outputs`.
typedef enum vxt_output {
    VXT_OUTPUT_TRIANGLES = 1,   ///< which triangles have survivors, and how many
    VXT_OUTPUT_CONTACTS = 2,    ///< a vxt_contact for each survivor, as many as there is room for
    VXT_OUTPUT_BOUNDS = 4,      ///< the world box of the survivors of each pair
    VXT_OUTPUT_LABELS = 8,      ///< survivors by the label of the place where they are; the items need label maps
    VXT_OUTPUT_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_output;

// Data

/// Where the voxels of an image are: voxtact::Grid. World is LPS, in millimetres.
typedef struct vxt_grid {
    double spacing[3];   ///< mm; positive
    double origin[3];    ///< mm; the centre of voxel (0,0,0)
    double direction[9]; ///< three columns, the unit vectors along the index axes; [3 * c + r]; not singular
    uint32_t size[3];    ///< voxels along x, y, z; each at least 1
    uint32_t reserved;   ///< 0
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
    uint32_t reserved;    ///< 0
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
    vxt_range domain;                ///< what the table covers; lo < hi; default 0..255
    uint32_t table_size;             ///< entries; at least 2; default 256
    uint32_t reserved;               ///< 0
} vxt_transfer_function_desc;

/// A triangle mesh of the caller's, in object space.
typedef struct vxt_mesh_view {
    size_t struct_size;      ///< sizeof
    const float* positions;  ///< three a vertex
    size_t vertex_count;     ///< vertices
    const uint32_t* indices; ///< three a triangle
    size_t triangle_count;   ///< triangles
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
    uint32_t degenerate; ///< triangles whose area is zero in float: allowed, they give no fragment
    uint32_t reserved;   ///< 0
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

/// Spacing 1, origin 0, the axes of the world, and no size.
static inline vxt_grid vxt_grid_init(void) {
    vxt_grid grid;
    memset(&grid, 0, sizeof grid);
    grid.spacing[0] = grid.spacing[1] = grid.spacing[2] = 1;
    grid.direction[0] = grid.direction[4] = grid.direction[8] = 1;
    return grid;
}

/// An empty image of uint8.
static inline vxt_volume_view vxt_volume_view_init(void) {
    vxt_volume_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    view.grid = vxt_grid_init();
    return view;
}

/// No points, the domain 0..255 and 256 entries.
static inline vxt_transfer_function_desc vxt_transfer_function_desc_init(void) {
    vxt_transfer_function_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.domain.hi = 255;
    desc.table_size = 256;
    return desc;
}

/// An empty mesh.
static inline vxt_mesh_view vxt_mesh_view_init(void) {
    vxt_mesh_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// Smallest and largest voxel; refuses what voxtact::checkVolume() refuses. O(voxels).
VXT_CHECKED vxt_result vxt_check_volume(const vxt_volume_view* volume, vxt_range* range);
/// Refuses what voxtact::checkMesh() refuses. O(vertices + triangles).
VXT_CHECKED vxt_result vxt_check_mesh(const vxt_mesh_view* mesh, vxt_mesh_facts* facts);
/// From index space to the world. Refuses what voxtact::checkGrid() refuses.
VXT_CHECKED vxt_result vxt_world_from_index(const vxt_grid* grid, double world_from_index[16]);
/// From texture space, [0,1]^3 over the whole image, to the world.
VXT_CHECKED vxt_result vxt_world_from_texture(const vxt_grid* grid, double world_from_texture[16]);
/// An orthographic view from above whose square pixels frame the volume.
VXT_CHECKED vxt_result vxt_framing_view(const vxt_grid* grid, uint32_t width, uint32_t height, vxt_view* view);
/// The inverse of any 4x4 matrix; refuses a singular one. The two may be the same.
VXT_CHECKED vxt_result vxt_inverse(const double b_from_a[16], double a_from_b[16]);

/// The box of a box's corners under an affine matrix, rounded outward: voxtact::transformBox(). The two may be the
/// same.
VXT_CHECKED vxt_result vxt_transform_box(const double b_from_a[16], const vxt_box* box, vxt_box* transformed);

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
/// The label at a world point; 0 outside of the map's grid.
VXT_CHECKED vxt_result vxt_labels_at(const vxt_labels* labels, const double world[3], int32_t* label);
/// Ends it.
VXT_API void vxt_labels_destroy(vxt_labels* labels);

/// An image that was read or built: voxtact::VolumeData.
typedef struct vxt_volume_data vxt_volume_data;
/// Its voxels; valid as long as the object. An empty image of null.
VXT_API vxt_volume_view vxt_volume_data_view(const vxt_volume_data* data);
/// The file's name, or the builtin's.
VXT_API const char* vxt_volume_data_name(const vxt_volume_data* data);
/// What the reader did that the user may want to know, a line each; null beyond the last one.
VXT_API const char* vxt_volume_data_note(const vxt_volume_data* data, size_t index);
/// Ends it.
VXT_API void vxt_volume_data_destroy(vxt_volume_data* data);

/// A mesh that was read or built: voxtact::MeshData.
typedef struct vxt_mesh_data vxt_mesh_data;
/// Its arrays; valid as long as the object. An empty mesh of null.
VXT_API vxt_mesh_view vxt_mesh_data_view(const vxt_mesh_data* data);
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

// Answers

/// The answer for one pair: voxtact::PairAnswer.
typedef struct vxt_pair {
    uint64_t count;            ///< survivors; 1 for a hit of a boolean query or an early exit
    uint32_t pair;             ///< number of the pair in its batch
    uint32_t item;             ///< number of the item that the pair came from
    uint32_t pose;             ///< number of the pose within that item
    uint32_t hit;              ///< at least one survivor: the pair certainly touches
    uint32_t possible;         ///< no survivor, but fragments that could not be decided: it may touch
    vxt_exactness exactness;   ///< what the count is worth
    vxt_method method;         ///< what counted
    vxt_projection projection; ///< what gave the fragments
} vxt_pair;

/// A triangle with at least one survivor.
typedef struct vxt_touched_triangle {
    uint32_t pair;     ///< number of the pair in its batch
    uint32_t triangle; ///< number in the mesh
    uint32_t count;    ///< its survivors
} vxt_touched_triangle;

/// One survivor and its place: voxtact::Contact.
typedef struct vxt_contact {
    double position[3]; ///< world, mm: on the triangle
    double normal[3];   ///< unit vector in world space, out of what is opaque; zero where there is none
    double depth;       ///< mm along the normal to where the opacity ends; at most max_depth
    double value;       ///< of the image, in its own units
    double opacity;     ///< of that value
    uint32_t pair;      ///< number of the pair in its batch
    uint32_t triangle;  ///< number in the mesh
    int32_t label;      ///< of the nearest voxel of the label map; 0 without a map, and outside of it
    uint32_t reserved;  ///< 0
} vxt_contact;

/// Survivors of a pair at one label.
typedef struct vxt_label_count {
    uint64_t count; ///< at least 1
    uint32_t pair;  ///< number of the pair in its batch
    int32_t label;  ///< as the label map has it
} vxt_label_count;

/// What a batch gave; what the detector was not asked for is empty. The arrays are the answer's.
typedef struct vxt_answer_view {
    size_t struct_size;                    ///< sizeof
    const vxt_pair* pairs;                 ///< in the order of the batch
    size_t pair_count;                     ///< pairs of the batch
    const vxt_touched_triangle* triangles; ///< by pair, then by triangle
    size_t triangle_count;                 ///< of `triangles`
    const vxt_contact* contacts;           ///< by pair, then by triangle, then by position
    size_t contact_count;                  ///< of `contacts`
    uint64_t contacts_found;               ///< more than contact_count: the list was cut, arbitrarily
    const vxt_box* bounds;                 ///< world, of each pair; empty (lo > hi) where it has no survivor
    size_t bounds_count;                   ///< 0 or pair_count
    const vxt_label_count* labels;         ///< by pair, then by label
    size_t label_count;                    ///< of `labels`
    double gpu_milliseconds;               ///< device time of the batch; 0 where it was not measured
    double wall_milliseconds;              ///< from the start to the results in host memory; 0 where it is not known
} vxt_answer_view;

/// Nothing.
static inline vxt_answer_view vxt_answer_view_init(void) {
    vxt_answer_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// Where a detector puts its answers. Used again and again, it keeps its memory.
typedef struct vxt_answer vxt_answer;
/// An empty one.
VXT_CHECKED vxt_result vxt_answer_create(vxt_answer** answer);
/// What it holds; valid until the next answer is put there, or the object ends.
VXT_CHECKED vxt_result vxt_answer_get(const vxt_answer* answer, vxt_answer_view* view);
/// Ends it.
VXT_API void vxt_answer_destroy(vxt_answer* answer);

// The host engine

/// A 3D image on the host: voxtact::cpu::Volume.
typedef struct vxt_host_volume vxt_host_volume;
/// Copies the voxels.
VXT_CHECKED vxt_result vxt_host_volume_create(const vxt_volume_view* view, vxt_host_volume** volume);
/// Gives the voxels of a box a value in the image's own units. The next detection sees it; none may run meanwhile.
VXT_CHECKED vxt_result vxt_host_volume_set_box(vxt_host_volume* volume, const vxt_voxel_box* box, double value);
/// The same for the voxels whose centre is at most `radius` mm from a point of the world.
VXT_CHECKED vxt_result vxt_host_volume_set_ball(vxt_host_volume* volume, const double centre[3], double radius,
                                                double value);
/// Replaces the voxels of a box by scalars of the volume's type, x fastest, without padding.
VXT_CHECKED vxt_result vxt_host_volume_write(vxt_host_volume* volume, const vxt_voxel_box* box, const void* voxels,
                                             size_t bytes);
/// Ends it.
VXT_API void vxt_host_volume_destroy(vxt_host_volume* volume);

/// Value -> opacity on the host: voxtact::cpu::TransferFunction.
typedef struct vxt_host_transfer_function vxt_host_transfer_function;
/// Refuses what voxtact::sampleTable() refuses.
VXT_CHECKED vxt_result vxt_host_transfer_function_create(const vxt_transfer_function_desc* desc,
                                                         vxt_host_transfer_function** function);
/// Ends it.
VXT_API void vxt_host_transfer_function_destroy(vxt_host_transfer_function* function);

/// A triangle mesh on the host: voxtact::cpu::Mesh.
typedef struct vxt_host_mesh vxt_host_mesh;
/// Copies the arrays.
VXT_CHECKED vxt_result vxt_host_mesh_create(const vxt_mesh_view* view, vxt_host_mesh** mesh);
/// What was found out about it.
VXT_CHECKED vxt_result vxt_host_mesh_facts(const vxt_host_mesh* mesh, vxt_mesh_facts* facts);
/// Ends it.
VXT_API void vxt_host_mesh_destroy(vxt_host_mesh* mesh);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_host_item {
    size_t struct_size;                                  ///< sizeof
    const vxt_host_mesh* mesh;                           ///< what touches
    const vxt_host_volume* volume;                       ///< what is touched
    const vxt_host_transfer_function* transfer_function; ///< what of it is opaque
    const double* world_from_object;                     ///< 16 doubles a pose; affine
    size_t pose_count;                                   ///< poses: a pair each
    const vxt_labels* labels;                            ///< for the outputs CONTACTS (optional) and LABELS; else null
} vxt_host_item;

/// The pairs of one call: the items in order, each with its poses in order.
typedef struct vxt_host_batch {
    size_t struct_size;         ///< sizeof
    const vxt_host_item* items; ///< any number; answers are in their order
    size_t item_count;          ///< of `items`
    const vxt_view* view;       ///< may be null for projections without a camera
    double threshold;           ///< 0..1: opacity from which a sample is opaque; default 0.1
} vxt_host_batch;

/// What a detector of the host is made for.
typedef struct vxt_host_detector_desc {
    size_t struct_size;         ///< sizeof
    uint32_t threads;           ///< 0, the default: one for each processor
    vxt_projection projection;  ///< default VIEW
    vxt_boundary boundary;      ///< default AUTO
    uint32_t outputs;           ///< bits of vxt_output; default none
    double max_depth;           ///< mm, how far a contact's penetration is followed; default 10
    double resolution;          ///< CONSERVATIVE, voxels; 2^-12 to 1; default 1/64
    uint32_t samples_per_voxel; ///< DOMINANT_AXIS: along a voxel's side; 1 to 16; default 1
    uint32_t stop_at_first;     ///< the count is then 0 or 1, a lower bound; not with outputs
    uint32_t most_contacts;     ///< a list of contacts is cut beyond that many; default 2^20
    uint32_t reserved;          ///< 0
} vxt_host_detector_desc;

/// Nothing is given.
static inline vxt_host_item vxt_host_item_init(void) {
    vxt_host_item item;
    memset(&item, 0, sizeof item);
    item.struct_size = sizeof item;
    return item;
}

/// No items, and the threshold 0.1.
static inline vxt_host_batch vxt_host_batch_init(void) {
    vxt_host_batch batch;
    memset(&batch, 0, sizeof batch);
    batch.struct_size = sizeof batch;
    batch.threshold = 0.1;
    return batch;
}

/// A view, all processors, no outputs.
static inline vxt_host_detector_desc vxt_host_detector_desc_init(void) {
    vxt_host_detector_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.max_depth = 10;
    desc.resolution = 1.0 / 64;
    desc.samples_per_voxel = 1;
    desc.most_contacts = UINT32_C(1) << 20;
    return desc;
}

/// The detector on the host: voxtact::cpu::Detector. One detection at a time.
typedef struct vxt_host_detector vxt_host_detector;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_detector_create(const vxt_host_detector_desc* desc, vxt_host_detector** detector);
/// Answers for every pair. After a failure `answer` holds what it held.
VXT_CHECKED vxt_result vxt_host_detector_detect(vxt_host_detector* detector, const vxt_host_batch* batch,
                                                vxt_answer* answer);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_detector_threads(const vxt_host_detector* detector);
/// Ends it and its threads.
VXT_API void vxt_host_detector_destroy(vxt_host_detector* detector);

// How near, and on the way

/// Why bounds of a clearance are no nearer to each other: voxtact::ClearanceEnd.
typedef enum vxt_clearance_end {
    VXT_CLEARANCE_CLOSED = 0,      ///< they are within the tolerance, or both infinite
    VXT_CLEARANCE_BEYOND = 1,      ///< it is not less than the maximum
    VXT_CLEARANCE_ROUNDING = 2,    ///< what is left is decided by roundings
    VXT_CLEARANCE_BUDGET = 3,      ///< the steps that were allowed are used up
    VXT_CLEARANCE_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_clearance_end;

/// Which motion joins two poses: voxtact::Interpolation.
typedef enum vxt_interpolation {
    VXT_INTERPOLATION_SCREW = 0,       ///< about and along one axis
    VXT_INTERPOLATION_SLERP = 1,       ///< the middle of the mesh's box goes straight, and the mesh turns about it
    VXT_INTERPOLATION_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_interpolation;

/// Why no more is said of a motion: voxtact::MotionEnd.
typedef enum vxt_motion_end {
    VXT_MOTION_DECIDED = 0,     ///< free, or it touches within the resolution of where it is free until
    VXT_MOTION_GRAZES = 1,      ///< somewhere neither was proven within the resolution
    VXT_MOTION_BUDGET = 2,      ///< the steps that were allowed are used up
    VXT_MOTION_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_motion_end;

/// The names as on the command line; they live for ever.
/// @{
VXT_API const char* vxt_clearance_end_name(vxt_clearance_end end);
VXT_API const char* vxt_interpolation_name(vxt_interpolation interpolation);
VXT_API const char* vxt_motion_end_name(vxt_motion_end end);
/// @}

/// The clearance of one pair: voxtact::PairClearance. Where `has_closest` is 0, what is of the closest points is 0.
typedef struct vxt_pair_clearance {
    double lo;                 ///< mm: no point of the surface is nearer to an opaque one
    double hi;                 ///< mm: some point is as near; infinite where nothing is opaque
    double mesh[3];            ///< closest points: on the triangle, world mm
    double volume[3];          ///< opaque, world mm
    double per_translation[3]; ///< mm of their distance for each mm that the mesh is moved along the world's axes
    double per_rotation[3];    ///< and for each radian that it is turned about them, through the object's origin
    uint32_t pair;             ///< number in the batch
    uint32_t item;             ///< number of the item
    uint32_t pose;             ///< number of the pose in the item
    uint32_t triangle;         ///< closest points: number in the mesh
    uint32_t has_closest;      ///< where `hi` is finite
    vxt_clearance_end end;     ///< why the bounds are no nearer to each other
} vxt_pair_clearance;

/// The clearance of one pair to what is opaque and has a label: voxtact::LabelClearance.
typedef struct vxt_label_clearance {
    double lo;             ///< mm
    double hi;             ///< mm; both are infinite where nothing opaque has the label
    uint32_t pair;         ///< number in the batch
    uint32_t item;         ///< number of the item
    uint32_t pose;         ///< number of the pose in the item
    int32_t label;         ///< as the map has it
    vxt_clearance_end end; ///< why they are no nearer to each other
    uint32_t reserved;     ///< 0
} vxt_label_clearance;

/// What was found of one segment of a motion: voxtact::SegmentMotion. Where `touches` is 0, what is of the touch is 0.
typedef struct vxt_segment_motion {
    double free_until;            ///< certainly nothing touches from 0 to this parameter; 1: all of it is free
    double touch_at;              ///< a parameter at which it certainly touches
    double world_from_object[16]; ///< the pose there
    double position[3];           ///< world mm: a point of the touch
    uint32_t segment;             ///< number in the batch
    uint32_t item;                ///< number of the item
    uint32_t pose;                ///< number in the item of the pose that it begins with
    uint32_t triangle;            ///< of the touch: number in the mesh
    uint32_t touches;             ///< whether there is a certain touch
    uint32_t possible;            ///< not free, and no certain touch
    vxt_motion_end end;           ///< why no more is said
    uint32_t reserved;            ///< 0
} vxt_segment_motion;

/// The arrays of clearances, where they are.
typedef struct vxt_clearance_view {
    size_t struct_size;                ///< sizeof
    const vxt_pair_clearance* pairs;   ///< in the order of the batch
    size_t pair_count;                 ///< of `pairs`
    const vxt_label_clearance* labels; ///< by pair, then in the order that they were asked for
    size_t label_count;                ///< of `labels`
    double wall_milliseconds;          ///< of the call
} vxt_clearance_view;

/// The array of motions, where it is.
typedef struct vxt_motion_view {
    size_t struct_size;                 ///< sizeof
    const vxt_segment_motion* segments; ///< in the order of the batch
    size_t segment_count;               ///< of `segments`
    double wall_milliseconds;           ///< of the call
} vxt_motion_view;

/// What a clearance meter is made for.
typedef struct vxt_host_clearance_desc {
    size_t struct_size;  ///< sizeof
    double tolerance;    ///< mm, from 1e-6 on; default 0.01
    double maximum;      ///< mm: what is farther is not measured; 0, the default: all is
    double resolution;   ///< of the touch, as for a detector; default 1/64
    uint64_t most_steps; ///< of a pair, at least 1; default 2^18
    uint32_t threads;    ///< 0, the default: one for each processor
    uint32_t reserved;   ///< 0
} vxt_host_clearance_desc;

/// What a motion checker is made for.
typedef struct vxt_host_motion_desc {
    size_t struct_size;              ///< sizeof
    double resolution;               ///< mm, from 1e-6 on: from the end of what is free to a touch; default 0.01
    double touch_resolution;         ///< of the touch, as for a detector; default 1/64
    uint64_t most_steps;             ///< of a segment, at least 1; default 2^20
    vxt_interpolation interpolation; ///< default SCREW
    uint32_t threads;                ///< 0, the default: one for each processor
} vxt_host_motion_desc;

/// Nothing.
static inline vxt_clearance_view vxt_clearance_view_init(void) {
    vxt_clearance_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// Nothing.
static inline vxt_motion_view vxt_motion_view_init(void) {
    vxt_motion_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// To 0.01 mm at any distance.
static inline vxt_host_clearance_desc vxt_host_clearance_desc_init(void) {
    vxt_host_clearance_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.tolerance = 0.01;
    desc.resolution = 1.0 / 64;
    desc.most_steps = UINT64_C(1) << 18;
    return desc;
}

/// Screws, to 0.01 mm.
static inline vxt_host_motion_desc vxt_host_motion_desc_init(void) {
    vxt_host_motion_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.resolution = 0.01;
    desc.touch_resolution = 1.0 / 64;
    desc.most_steps = UINT64_C(1) << 20;
    return desc;
}

/// Where a meter puts what it measures. Used again and again, it keeps its memory.
typedef struct vxt_clearances vxt_clearances;
/// An empty one.
VXT_CHECKED vxt_result vxt_clearances_create(vxt_clearances** clearances);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_clearances_get(const vxt_clearances* clearances, vxt_clearance_view* view);
/// Ends it.
VXT_API void vxt_clearances_destroy(vxt_clearances* clearances);

/// Measures how near meshes are: voxtact::cpu::ClearanceMeter. One call at a time. After a failure the answers hold
/// what they held.
typedef struct vxt_host_clearance_meter vxt_host_clearance_meter;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_clearance_meter_create(const vxt_host_clearance_desc* desc,
                                                       vxt_host_clearance_meter** meter);
/// The clearance of every pair.
VXT_CHECKED vxt_result vxt_host_clearance_meter_measure(vxt_host_clearance_meter* meter, const vxt_host_batch* batch,
                                                        vxt_clearances* clearances);
/// The clearance of every pair to each label's part of what is opaque. Every item needs labels, on its volume's grid.
VXT_CHECKED vxt_result vxt_host_clearance_meter_measure_labels(vxt_host_clearance_meter* meter,
                                                               const vxt_host_batch* batch, const int32_t* labels,
                                                               size_t label_count, vxt_clearances* clearances);
/// Whether something opaque is within `margin` mm, for every pair: `hit` and `possible` of its answer.
VXT_CHECKED vxt_result vxt_host_clearance_meter_within(vxt_host_clearance_meter* meter, const vxt_host_batch* batch,
                                                       double margin, vxt_answer* answer);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_clearance_meter_threads(const vxt_host_clearance_meter* meter);
/// Ends it and its threads.
VXT_API void vxt_host_clearance_meter_destroy(vxt_host_clearance_meter* meter);

/// Where a checker puts what it finds. Used again and again, it keeps its memory.
typedef struct vxt_motions vxt_motions;
/// An empty one.
VXT_CHECKED vxt_result vxt_motions_create(vxt_motions** motions);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_motions_get(const vxt_motions* motions, vxt_motion_view* view);
/// Ends it.
VXT_API void vxt_motions_destroy(vxt_motions* motions);

/// Says whether meshes touch on the way from pose to pose: voxtact::cpu::MotionChecker. One call at a time. After a
/// failure the answers hold what they held.
typedef struct vxt_host_motion_checker vxt_host_motion_checker;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_motion_checker_create(const vxt_host_motion_desc* desc,
                                                      vxt_host_motion_checker** checker);
/// The segments between consecutive poses of each item: one fewer than it has poses.
VXT_CHECKED vxt_result vxt_host_motion_checker_check(vxt_host_motion_checker* checker, const vxt_host_batch* batch,
                                                     vxt_motions* motions);
/// Whether a mesh touches at some pose that is turned by no more than `angle` degrees about any axis through its
/// object's origin, and moved by no more than `distance` mm: `hit` and `possible` of each pair's answer.
VXT_CHECKED vxt_result vxt_host_motion_checker_around(vxt_host_motion_checker* checker, const vxt_host_batch* batch,
                                                      double distance, double angle, vxt_answer* answer);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_motion_checker_threads(const vxt_host_motion_checker* checker);
/// Ends it and its threads.
VXT_API void vxt_host_motion_checker_destroy(vxt_host_motion_checker* checker);

/// The pose at a parameter from 0 to 1 on the way between two: voxtact::poseBetween(). `centre` is the middle of the
/// mesh's box in object space, which SLERP alone needs; it may be null for SCREW.
VXT_CHECKED vxt_result vxt_pose_between(const double from[16], const double to[16], double parameter,
                                        vxt_interpolation interpolation, const double centre[3],
                                        double world_from_object[16]);

// Files. A library that was built without voxtact::io refuses them all, UNSUPPORTED.

/// Which image of a file or folder that holds several is read.
typedef struct vxt_volume_read_options {
    size_t struct_size; ///< sizeof
    const char* series; ///< SeriesInstanceUID of a DICOM folder; null: the only one
    int64_t frame;      ///< of a 4D NIfTI file, counted from 0; -1, the default: the only one
} vxt_volume_read_options;

/// The only one.
static inline vxt_volume_read_options vxt_volume_read_options_init(void) {
    vxt_volume_read_options options;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.frame = -1;
    return options;
}

/// What the numbers of a mesh file mean.
typedef struct vxt_mesh_read_options {
    size_t struct_size; ///< sizeof
    double scale;       ///< millimetres in a unit of the file; default 1
    uint32_t ras;       ///< RAS coordinates: x and y are negated; default 0, LPS
    uint32_t reserved;  ///< 0
} vxt_mesh_read_options;

/// LPS in millimetres.
static inline vxt_mesh_read_options vxt_mesh_read_options_init(void) {
    vxt_mesh_read_options options;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.scale = 1;
    return options;
}

/// A volume from a file or a DICOM folder: voxtact::io::readVolume(). Null options are the defaults.
VXT_CHECKED vxt_result vxt_read_volume(const char* path, const vxt_volume_read_options* options,
                                       vxt_volume_data** data);
/// voxtact::io::writeVolume().
VXT_CHECKED vxt_result vxt_write_volume(const char* path, const vxt_volume_view* volume);
/// A mesh from a file: voxtact::io::readMesh(). Null options are the defaults.
VXT_CHECKED vxt_result vxt_read_mesh(const char* path, const vxt_mesh_read_options* options, vxt_mesh_data** data);
/// voxtact::io::writeMesh().
VXT_CHECKED vxt_result vxt_write_mesh(const char* path, const vxt_mesh_view* mesh);
/// One `clip_from_world` matrix: voxtact::io::readCamera().
VXT_CHECKED vxt_result vxt_read_camera(const char* path, double clip_from_world[16]);

/// Poses that were read.
typedef struct vxt_poses vxt_poses;
/// One matrix a line, row by row: voxtact::io::readPoses().
VXT_CHECKED vxt_result vxt_read_poses(const char* path, vxt_poses** poses);
/// 16 doubles a pose, column by column, as items take them; valid as long as the object. `count` is of poses.
VXT_API const double* vxt_poses_get(const vxt_poses* poses, size_t* count);
/// Ends it.
VXT_API void vxt_poses_destroy(vxt_poses* poses);

/// Control points that were read.
typedef struct vxt_control_points vxt_control_points;
/// A transfer function's file: voxtact::io::readTransferFunction().
VXT_CHECKED vxt_result vxt_read_transfer_function(const char* path, vxt_control_points** points);
/// The same as "v:a,v:a,...".
VXT_CHECKED vxt_result vxt_parse_opacity(const char* text, vxt_control_points** points);
/// The points; valid as long as the object.
VXT_API const vxt_control_point* vxt_control_points_get(const vxt_control_points* points, size_t* count);
/// Ends it.
VXT_API void vxt_control_points_destroy(vxt_control_points* points);

/// Names of labels that were read.
typedef struct vxt_label_names vxt_label_names;
/// `number name`, one a line: voxtact::io::readLabelNames().
VXT_CHECKED vxt_result vxt_read_label_names(const char* path, vxt_label_names** names);
/// The name at a place of the file's order, and its label; null beyond the last one. `label` may be null.
VXT_API const char* vxt_label_names_get(const vxt_label_names* names, size_t index, int32_t* label);
/// Ends it.
VXT_API void vxt_label_names_destroy(vxt_label_names* names);

#ifdef __cplusplus
}
#endif

#endif

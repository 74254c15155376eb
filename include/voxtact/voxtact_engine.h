/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_ENGINE_H
#define VOXTACT_VOXTACT_ENGINE_H

#include "voxtact/voxtact_data.h"

/// @file
/// Questions, and the engine that answers them on the host: voxtact::cpu::HostEngine. The conventions of voxtact.h
/// apply. A question is a struct; a member that is 0 has its default. vxt_fact_get() returns the ranges and defaults of
/// all numbers; an answer lists its columns.

#ifdef __cplusplus
extern "C" {
#endif

/// A 3D image of the host engine: voxtact::cpu::Volume.
typedef struct vxt_host_volume vxt_host_volume;
/// Copies the voxels.
VXT_CHECKED vxt_result vxt_host_volume_create(const vxt_volume_view* view, vxt_host_volume** volume);
/// Returns the position of the voxels.
VXT_CHECKED vxt_result vxt_host_volume_grid(const vxt_host_volume* volume, vxt_grid* grid);
/// Sets the voxels of a box to a value in the image's own units. The next question uses the edit; none may run
/// meanwhile.
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
/// Destroys the object.
VXT_API void vxt_host_volume_destroy(vxt_host_volume* volume);

/// Value -> opacity on the host: voxtact::cpu::TransferFunction.
typedef struct vxt_host_transfer_function vxt_host_transfer_function;
/// Creates a transfer function. Refuses what voxtact::sampleTable() refuses.
VXT_CHECKED vxt_result vxt_host_transfer_function_create(const vxt_transfer_function_desc* desc,
                                                         vxt_host_transfer_function** function);
/// Destroys the object.
VXT_API void vxt_host_transfer_function_destroy(vxt_host_transfer_function* function);

/// A triangle mesh on the host: voxtact::cpu::Mesh.
typedef struct vxt_host_mesh vxt_host_mesh;
/// Copies the arrays.
VXT_CHECKED vxt_result vxt_host_mesh_create(const vxt_mesh_view* view, vxt_host_mesh** mesh);
/// Returns facts of the mesh: sizes, bounds and rounding.
VXT_CHECKED vxt_result vxt_host_mesh_facts(const vxt_host_mesh* mesh, vxt_mesh_facts* facts);
/// Moves all vertices, three coordinates each; no other call may use the mesh meanwhile. A refused call changes
/// nothing: voxtact::cpu::Mesh::update().
VXT_CHECKED vxt_result vxt_host_mesh_update(vxt_host_mesh* mesh, const double* positions, size_t vertex_count);
/// Destroys the object.
VXT_API void vxt_host_mesh_destroy(vxt_host_mesh* mesh);

/// A cancel flag: once set, calls that use it soon return CANCELLED. Any thread can set it. A call that saw it set
/// returns CANCELLED, even if it is reset meanwhile.
typedef struct vxt_cancel vxt_cancel;
/// Creates a cancel flag, initially not set.
VXT_CHECKED vxt_result vxt_cancel_create(vxt_cancel** cancel);
/// Sets the flag, or resets it with 0 for the next call. Null is allowed.
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
    size_t struct_size;         ///< sizeof this struct
    const vxt_host_item* items; ///< any number; the answers have the same order
    size_t item_count;          ///< length of `items`
    const vxt_view* view;       ///< for projections with a camera; else null
    double opacity_threshold;   ///< above 0, up to 1: opacity of an opaque value; 0: 0.1; -0.0: all is opaque
    vxt_cancel* cancel;         ///< cancels the call; may be null
} vxt_pairs;

/// Does it touch? voxtact::Touch.
typedef struct vxt_touch {
    size_t struct_size;          ///< sizeof this struct
    double margin;               ///< mm: is anything opaque within this distance? Not with an uncertainty
    double uncertainty_distance; ///< mm: tests all poses translated by at most this,
    double uncertainty_angle;    ///< degrees: and rotated by at most this
    uint32_t witness;            ///< 1: finds a witness point of each yes
    uint32_t solid;              ///< 1: includes the inside of the mesh, which must be closed
    double resolution;           ///< voxels
    uint64_t max_steps;          ///< iteration limit per pair
} vxt_touch;

/// How many fragments pass, and where? voxtact::Count.
typedef struct vxt_count {
    size_t struct_size;         ///< sizeof this struct
    vxt_projection projection;  ///< 0: VIEW
    vxt_boundary boundary;      ///< 0: AUTO
    uint32_t outputs;           ///< bits of vxt_output
    uint32_t stop_at_first;     ///< 1: early exit: the count is 0 or 1, a lower bound; not with outputs
    double max_depth;           ///< mm: maximum depth of a contact
    double resolution;          ///< voxels, for CERTIFIED
    uint32_t samples_per_voxel; ///< DOMINANT_AXIS: per voxel side; 1 to 16; 0: 1
    uint32_t max_contacts;      ///< maximum number of contacts; a longer list is cut; 0: 2^20
} vxt_count;

/// How near? voxtact::Distance.
typedef struct vxt_distance {
    size_t struct_size;    ///< sizeof this struct
    double tolerance;      ///< mm: stop when upper - lower is at most this
    double max;            ///< mm: stop when lower reaches this distance; 0: never
    const int32_t* labels; ///< labels to measure to, instead of the opaque region; null: no labels
    size_t label_count;    ///< length of `labels`
    uint32_t any_opacity;  ///< 1: to whole labels, opaque or not
    uint32_t solid;        ///< 1: includes the inside of the mesh, which must be closed; not with labels
    double resolution;     ///< voxels
    uint64_t max_steps;    ///< iteration limit per pair
} vxt_distance;

/// How much of the surface? voxtact::Area.
typedef struct vxt_area {
    size_t struct_size;    ///< sizeof this struct
    double tolerance;      ///< mm^2: stop when upper - lower is at most this
    const int32_t* labels; ///< labels to measure in, instead of the opaque region; null: no labels
    size_t label_count;    ///< length of `labels`
    uint32_t triangles;    ///< 1: also measures each triangle; not with labels
    double resolution;     ///< voxels
    uint64_t max_steps;    ///< iteration limit per pair
} vxt_area;

/// How much of the opaque region is inside a closed mesh, and of which values? voxtact::Overlap. Returns
/// INVALID_ARGUMENT for a mesh with holes: vxt_mesh_fill_holes().
typedef struct vxt_overlap {
    size_t struct_size;        ///< sizeof this struct
    double tolerance;          ///< mm^3: stop when upper - lower is at most this
    const double* band_limits; ///< ascending values: one row per band; null: no bands
    size_t band_limit_count;   ///< length of `band_limits`, at most 64
    const int32_t* labels;     ///< one row per label; null: no labels
    size_t label_count;        ///< length of `labels`
    uint64_t max_steps;        ///< iteration limit per sum
} vxt_overlap;

/// Kind of motion between two poses: voxtact::Interpolation.
typedef enum vxt_interpolation {
    VXT_INTERPOLATION_SCREW = 0,       ///< along and about one axis
    VXT_INTERPOLATION_SLERP = 1,       ///< the centre of the mesh's box moves straight; the mesh rotates about it
    VXT_INTERPOLATION_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_interpolation;

/// What happens between consecutive poses of each item? voxtact::Motion. An item has one row fewer than poses.
typedef struct vxt_motion {
    size_t struct_size;              ///< sizeof this struct
    vxt_interpolation interpolation; ///< 0: SCREW
    double resolution;               ///< mm: maximum motion from toi_lower to toi_upper
    double touch_resolution;         ///< voxels
    uint64_t max_steps;              ///< iteration limit per segment
} vxt_motion;

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
/// the target leaves the opaque region of `entry_volume`, a label, or a ball; exactly one of them is set. Points are in
/// world space, mm.
typedef struct vxt_plan {
    size_t struct_size;                                        ///< sizeof this struct
    const vxt_obstacle* obstacles;                             ///< at least one
    size_t obstacle_count;                                     ///< length of `obstacles`
    const vxt_host_volume* entry_volume;                       ///< with a transfer function: its opaque region
    const vxt_host_transfer_function* entry_transfer_function; ///< of entry_volume
    const vxt_labels* entry_labels;                            ///< or a label map
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
    double max;                  ///< mm: stop when lower reaches this; 0: 10
    uint64_t max_steps;          ///< iteration limit per path
} vxt_plan;

/// Answers as tables. Each question has a table `pairs` (motion: `segments`, plan: `paths`) with one row per pair in
/// order, further tables, and `totals` with one row. A reused answer keeps its memory.
typedef struct vxt_answer vxt_answer;
/// Creates an empty answer.
VXT_CHECKED vxt_result vxt_answer_create(vxt_answer** answer);
/// Destroys the object.
VXT_API void vxt_answer_destroy(vxt_answer* answer);

/// Type of a column's elements.
typedef enum vxt_type {
    VXT_TYPE_UINT32 = 0,      ///< also an index of an enumeration: `choices` of its column
    VXT_TYPE_INT32 = 1,       ///< a label
    VXT_TYPE_UINT64 = 2,      ///< a count
    VXT_TYPE_DOUBLE = 3,      ///< in `unit`
    VXT_TYPE_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_type;

/// A column of an answer. Its texts have static lifetime; `data` is valid until the next answer, or the object's end.
typedef struct vxt_column {
    size_t struct_size;  ///< sizeof this struct
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
/// Returns a column by index, table by table.
VXT_CHECKED vxt_result vxt_answer_column(const vxt_answer* answer, size_t index, vxt_column* column);
/// Returns a column by name, or NOT_READY if the answer does not have it.
VXT_CHECKED vxt_result vxt_answer_find(const vxt_answer* answer, const char* table, const char* name,
                                       vxt_column* column);

/// Limits and defaults that are whole numbers.
typedef enum vxt_limit {
    VXT_MAX_THREADS = 4096,              ///< threads of a host engine
    VXT_MAX_TABLE_SIZE = 16777216,       ///< entries of a transfer function's table
    VXT_MAX_SAMPLES_PER_VOXEL = 16,      ///< vxt_count::samples_per_voxel
    VXT_MAX_ENTRIES = 3994242,           ///< vxt_plan::entries
    VXT_DEFAULT_TABLE_SIZE = 256,        ///< entries of a transfer function's table
    VXT_DEFAULT_ENTRIES = 1002,          ///< vxt_plan::entries
    VXT_DEFAULT_PLAN_MAX = 10,           ///< mm, vxt_plan::max
    VXT_DEFAULT_TOUCH_STEPS = 1048576,   ///< vxt_touch::max_steps
    VXT_DEFAULT_DISTANCE_STEPS = 262144, ///< vxt_distance::max_steps
    VXT_DEFAULT_AREA_STEPS = 262144,     ///< vxt_area::max_steps
    VXT_DEFAULT_MOTION_STEPS = 1048576,  ///< vxt_motion::max_steps
    VXT_DEFAULT_PLAN_STEPS = 262144,     ///< vxt_plan::max_steps
    VXT_DEFAULT_TRACKER_STEPS = 512,     ///< vxt_tracker_create()
    VXT_LIMIT_MAX = 0x7fffffff           ///< makes the type 32 bits wide
} vxt_limit;

/// A number of a question. Its texts have static lifetime.
typedef struct vxt_fact {
    size_t struct_size;    ///< sizeof this struct
    const char* question;  ///< "touch"; "scene": of every question
    const char* name;      ///< member of its struct
    const char* unit;      ///< "mm", "mm^2", "degrees", "voxels"; "" for none
    const char* text;      ///< one line
    const char* range;     ///< "from 1e-06 mm on"
    double min;            ///< smallest value
    double max;            ///< largest value
    double standard;       ///< the default, if has_standard is 1
    uint32_t has_standard; ///< 0: the number is optional
} vxt_fact;
/// Returns the number of facts.
VXT_API size_t vxt_fact_count(void);
/// Returns a fact by index.
VXT_CHECKED vxt_result vxt_fact_get(size_t index, vxt_fact* fact);

/// Answers questions on the host: voxtact::cpu::HostEngine. One call at a time.
typedef struct vxt_host_engine vxt_host_engine;
/// Starts the threads; 0: one per processor.
VXT_CHECKED vxt_result vxt_host_engine_create(uint32_t threads, vxt_host_engine** engine);
/// Returns the number of threads; 0 for null.
VXT_API uint32_t vxt_host_engine_threads(const vxt_host_engine* engine);
/// Destroys the engine and its threads.
VXT_API void vxt_host_engine_destroy(vxt_host_engine* engine);

/// Answer a question for every pair. A null question has all defaults. After a failure `answer` is unchanged.
/// @{
VXT_CHECKED vxt_result vxt_ask_touch(vxt_host_engine* engine, const vxt_touch* question, const vxt_pairs* pairs,
                                     vxt_answer* answer);
VXT_CHECKED vxt_result vxt_ask_count(vxt_host_engine* engine, const vxt_count* question, const vxt_pairs* pairs,
                                     vxt_answer* answer);
VXT_CHECKED vxt_result vxt_ask_distance(vxt_host_engine* engine, const vxt_distance* question, const vxt_pairs* pairs,
                                        vxt_answer* answer);
VXT_CHECKED vxt_result vxt_ask_area(vxt_host_engine* engine, const vxt_area* question, const vxt_pairs* pairs,
                                    vxt_answer* answer);
VXT_CHECKED vxt_result vxt_ask_overlap(vxt_host_engine* engine, const vxt_overlap* question, const vxt_pairs* pairs,
                                       vxt_answer* answer);
VXT_CHECKED vxt_result vxt_ask_motion(vxt_host_engine* engine, const vxt_motion* question, const vxt_pairs* pairs,
                                      vxt_answer* answer);
/// @}
/// Answers a plan, which has no pairs. The question must not be null.
VXT_CHECKED vxt_result vxt_ask_plan(vxt_host_engine* engine, const vxt_plan* question, vxt_answer* answer);

/// State of a moving mesh at one pose: voxtact::TrackedDistance.
typedef struct vxt_tracked {
    size_t struct_size; ///< sizeof this struct
    double lower;       ///< mm: no point of the surface is nearer to an opaque point
    double upper;       ///< mm: some point is at most this far; infinite if unknown
    uint32_t touch;     ///< 0: no, proven; 1: yes, proven; 2: undecided
    uint32_t searched;  ///< 1: the volume was searched; 0: earlier bounds were enough
} vxt_tracked;
/// Tracks a mesh that moves little from call to call: voxtact::cpu::DistanceTracker. One call at a time, on the calling
/// thread.
typedef struct vxt_tracker vxt_tracker;
/// Creates a tracker. `max`: search radius, mm; 0: unlimited. `resolution`: voxels; 0: 1/64. `max_steps`: iteration
/// limit per search; 0: 512.
VXT_CHECKED vxt_result vxt_tracker_create(double max, double resolution, uint64_t max_steps, vxt_tracker** tracker);
/// Tracks the mesh at the one pose of the item. `opacity_threshold`: above 0, up to 1; 0: 0.1.
VXT_CHECKED vxt_result vxt_tracker_track(vxt_tracker* tracker, const vxt_host_item* item, double opacity_threshold,
                                         vxt_tracked* tracked);
/// Destroys the object.
VXT_API void vxt_tracker_destroy(vxt_tracker* tracker);

/// Whether a mesh has an inside: voxtact::SolidFacts.
typedef struct vxt_solid_facts {
    uint32_t holes;        ///< loops of edges where the surface ends; 0: it is closed
    uint32_t open_edges;   ///< edges of all holes together
    uint32_t non_manifold; ///< edges of more than two triangles
    uint32_t inward;       ///< 1: the triangles face inwards, which does not matter
    double longest_hole;   ///< object units: length of the longest loop
    double signed_volume;  ///< object units^3, without bounds
} vxt_solid_facts;
/// Checks whether a mesh is closed. Refuses what voxtact::checkSolid() refuses.
VXT_CHECKED vxt_result vxt_check_solid(const vxt_mesh_view* mesh, vxt_solid_facts* facts);
/// Fills each hole by a fan: voxtact::fillHoles(). `area`: added area, object units^2; may be null.
VXT_CHECKED vxt_result vxt_mesh_fill_holes(const vxt_mesh_view* mesh, vxt_mesh_data** filled, double* area);

/// Returns the pose at a parameter from 0 to 1 between two poses: voxtact::poseBetween(). `centre`: of the mesh's box
/// in object space; only SLERP needs it; may be null for SCREW.
VXT_CHECKED vxt_result vxt_pose_between(const double from[16], const double to[16], double parameter,
                                        vxt_interpolation interpolation, const double centre[3],
                                        double world_from_object[16]);
/// Returns the labels that a straight line crosses, in order, each once, without 0: voxtact::labelsAlong(). Writes at
/// most `room` labels to `found`, which may be null if `room` is 0; `count` is their number.
VXT_CHECKED vxt_result vxt_labels_along(const vxt_labels* labels, const double from[3], const double to[3],
                                        int32_t* found, size_t room, size_t* count);

#ifdef __cplusplus
}
#endif

#endif

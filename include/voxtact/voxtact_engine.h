/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_ENGINE_H
#define VOXTACT_VOXTACT_ENGINE_H

#include "voxtact/voxtact_data.h"

/// @file
/// Questions, and the engine that answers them on the host: voxtact::cpu::HostEngine. What holds for voxtact.h, which
/// includes this, holds here. A question is a struct; a member that is 0 stands for its default. vxt_facts() lists the
/// ranges and defaults of all numbers, and an answer lists its columns.

#ifdef __cplusplus
extern "C" {
#endif

/// A 3D image of the host engine: voxtact::cpu::Volume.
typedef struct vxt_host_volume vxt_host_volume;
/// Copies the voxels.
VXT_CHECKED vxt_result vxt_host_volume_create(const vxt_volume_view* view, vxt_host_volume** volume);
/// Returns where the voxels are.
VXT_CHECKED vxt_result vxt_host_volume_grid(const vxt_host_volume* volume, vxt_grid* grid);
/// Gives the voxels of a box a value in the image's own units. The next question sees it; none may run meanwhile.
VXT_CHECKED vxt_result vxt_host_volume_set_box(vxt_host_volume* volume, const vxt_voxel_box* box, double value);
/// Gives a value to the voxels whose centre is at most `radius` mm from a point of the world.
VXT_CHECKED vxt_result vxt_host_volume_set_ball(vxt_host_volume* volume, const double centre[3], double radius,
                                                double value);
/// Replaces the voxels of a box by scalars of the volume's type, x fastest, without padding.
VXT_CHECKED vxt_result vxt_host_volume_write(vxt_host_volume* volume, const vxt_voxel_box* box, const void* voxels,
                                             size_t bytes);
/// Copies the voxels of a box as they are now, in the form that vxt_host_volume_write() takes.
VXT_CHECKED vxt_result vxt_host_volume_read(const vxt_host_volume* volume, const vxt_voxel_box* box, void* voxels,
                                            size_t bytes);
/// Destroys it.
VXT_API void vxt_host_volume_destroy(vxt_host_volume* volume);

/// Value -> opacity on the host: voxtact::cpu::TransferFunction.
typedef struct vxt_host_transfer_function vxt_host_transfer_function;
/// Refuses what voxtact::sampleTable() refuses.
VXT_CHECKED vxt_result vxt_host_transfer_function_create(const vxt_transfer_function_desc* desc,
                                                         vxt_host_transfer_function** function);
/// Destroys it.
VXT_API void vxt_host_transfer_function_destroy(vxt_host_transfer_function* function);

/// A triangle mesh on the host: voxtact::cpu::Mesh.
typedef struct vxt_host_mesh vxt_host_mesh;
/// Copies the arrays.
VXT_CHECKED vxt_result vxt_host_mesh_create(const vxt_mesh_view* view, vxt_host_mesh** mesh);
/// Returns counts, bounds and rounding of the mesh.
VXT_CHECKED vxt_result vxt_host_mesh_facts(const vxt_host_mesh* mesh, vxt_mesh_facts* facts);
/// Moves its vertices, three coordinates each, as many as it has; no other call may use the mesh meanwhile. Refused, it
/// is as it was: voxtact::cpu::Mesh::update().
VXT_CHECKED vxt_result vxt_host_mesh_update(vxt_host_mesh* mesh, const double* positions, size_t vertex_count);
/// Destroys it.
VXT_API void vxt_host_mesh_destroy(vxt_host_mesh* mesh);

/// A cancel flag: once it is set, calls that have it soon return CANCELLED. It can be set from any thread. A call that
/// saw it set returns CANCELLED, even if it is reset meanwhile.
typedef struct vxt_cancel vxt_cancel;
/// Creates a cancel flag, initially not set.
VXT_CHECKED vxt_result vxt_cancel_create(vxt_cancel** cancel);
/// Sets the flag, or with 0 resets it for the next call. Null is allowed.
VXT_API void vxt_cancel_set(vxt_cancel* cancel, uint32_t set);
/// Destroys it. No call may use it.
VXT_API void vxt_cancel_destroy(vxt_cancel* cancel);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_host_item {
    const vxt_host_mesh* mesh;                           ///< what touches
    const vxt_host_volume* volume;                       ///< what is touched
    const vxt_host_transfer_function* transfer_function; ///< what of it is opaque
    const double* world_from_object;                     ///< 16 doubles per pose; affine
    size_t pose_count;                                   ///< poses: a pair each
    const vxt_labels* labels;                            ///< for what is about labels; else null
} vxt_host_item;

/// The pairs of one call: the items in order, each with its poses in order.
typedef struct vxt_pairs {
    size_t struct_size;         ///< sizeof
    const vxt_host_item* items; ///< any number; answers are in their order
    size_t item_count;          ///< of `items`
    const vxt_view* view;       ///< of projections with a camera; else null
    double opacity_threshold;   ///< above 0, to 1: opacity from which a value is opaque; 0: 0.1; -0.0: all is opaque
    vxt_cancel* cancel;         ///< ends the call early; may be null
} vxt_pairs;

/// Does it touch? voxtact::Touch.
typedef struct vxt_touch {
    size_t struct_size;          ///< sizeof
    double margin;               ///< mm: is anything opaque within this distance? Not with an uncertainty
    double uncertainty_distance; ///< mm: at any pose that is moved by no more than this,
    double uncertainty_angle;    ///< degrees: and turned by no more than this?
    uint32_t witness;            ///< 1: finds a witness point of each yes
    uint32_t solid;              ///< 1: the inside of the mesh, which must be closed, touches too
    double resolution;           ///< voxels
    uint64_t max_steps;          ///< of the search of one pair
} vxt_touch;

/// How many fragments pass, and where? voxtact::Count.
typedef struct vxt_count {
    size_t struct_size;         ///< sizeof
    vxt_projection projection;  ///< 0: VIEW
    vxt_boundary boundary;      ///< 0: AUTO
    uint32_t outputs;           ///< bits of vxt_output
    uint32_t stop_at_first;     ///< 1: the count is then 0 or 1, a lower bound; not with outputs
    double max_depth;           ///< mm, how far a contact's penetration is followed
    double resolution;          ///< voxels, of CERTIFIED
    uint32_t samples_per_voxel; ///< DOMINANT_AXIS: along a voxel's side; 1 to 16; 0: 1
    uint32_t max_contacts;      ///< a list of contacts is cut beyond that many; 0: 2^20
} vxt_count;

/// How near? voxtact::Distance.
typedef struct vxt_distance {
    size_t struct_size;    ///< sizeof
    double tolerance;      ///< mm: stop when upper - lower is at most this
    double max;            ///< mm: stop when lower reaches this distance; 0: never
    const int32_t* labels; ///< to each of these, instead of to all that is opaque; null: no labels
    size_t label_count;    ///< of `labels`
    uint32_t any_opacity;  ///< 1: to all of a label, opaque or not
    uint32_t solid;        ///< 1: from the inside of the mesh, which must be closed, too; not with labels
    double resolution;     ///< voxels
    uint64_t max_steps;    ///< of the search of one pair
} vxt_distance;

/// How much of the surface? voxtact::Area.
typedef struct vxt_area {
    size_t struct_size;    ///< sizeof
    double tolerance;      ///< mm^2: stop when upper - lower is at most this
    const int32_t* labels; ///< in each of these, instead of in all that is opaque; null: no labels
    size_t label_count;    ///< of `labels`
    uint32_t triangles;    ///< 1: the area of each triangle, too; not with labels
    double resolution;     ///< voxels
    uint64_t max_steps;    ///< of the search of one pair
} vxt_area;

/// How much of the opaque region is inside a closed mesh, and of which values? voxtact::Overlap. A mesh with
/// holes is INVALID_ARGUMENT: vxt_mesh_fill_holes().
typedef struct vxt_overlap {
    size_t struct_size;        ///< sizeof
    double tolerance;          ///< mm^3: stop when upper - lower is at most this
    const double* band_limits; ///< ascending values: a row a band; null: no bands
    size_t band_limit_count;   ///< of `band_limits`, at most 64
    const int32_t* labels;     ///< a row a label, too; null: no labels
    size_t label_count;        ///< of `labels`
    uint64_t max_steps;        ///< of the search of one sum
} vxt_overlap;

/// Which motion joins two poses: voxtact::Interpolation.
typedef enum vxt_interpolation {
    VXT_INTERPOLATION_SCREW = 0,       ///< about and along one axis
    VXT_INTERPOLATION_SLERP = 1,       ///< the middle of the mesh's box goes straight, and the mesh turns about it
    VXT_INTERPOLATION_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_interpolation;

/// What happens between consecutive poses of each item? voxtact::Motion. One row fewer than an item has poses.
typedef struct vxt_motion {
    size_t struct_size;              ///< sizeof
    vxt_interpolation interpolation; ///< 0: SCREW
    double resolution;               ///< mm: maximum motion from toi_lower to toi_upper
    double touch_resolution;         ///< voxels
    uint64_t max_steps;              ///< of the search of one segment
} vxt_motion;

/// What a path must not touch: voxtact::cpu::PlanObstacle.
typedef struct vxt_obstacle {
    const vxt_host_volume* volume;                       ///< must be given
    const vxt_host_transfer_function* transfer_function; ///< what of it is opaque; null: labels at any opacity
    const vxt_labels* labels;                            ///< on the volume's grid; null: all that is opaque
    const int32_t* avoid;                                ///< these labels
    size_t avoid_count;                                  ///< of `avoid`
    double opacity_threshold;                            ///< above 0, to 1; 0: 0.1
    const char* name;                                    ///< in messages; null: "obstacle" and its number
} vxt_obstacle;

/// Which straight paths keep clear of obstacles? voxtact::cpu::Plan. Entries are where a direction from the target
/// leaves the opaque region of `entry_volume`, or a label, or a ball; one of them is given. Points in world space, mm.
typedef struct vxt_plan {
    size_t struct_size;                                        ///< sizeof
    const vxt_obstacle* obstacles;                             ///< at least one
    size_t obstacle_count;                                     ///< of `obstacles`
    const vxt_host_volume* entry_volume;                       ///< with a transfer function: its opaque region
    const vxt_host_transfer_function* entry_transfer_function; ///< see entry_volume
    const vxt_labels* entry_labels;                            ///< or of a label
    const vxt_host_mesh* mesh;                                 ///< the instrument, instead of the needle; may be null
    vxt_cancel* cancel;                                        ///< ends the call early; may be null
    double target[3];                                          ///< where the tip goes
    double mesh_tip[3];                                        ///< object space: comes to the target
    double mesh_axis[3];         ///< object space: from the tip to where it is held; all 0: 0 0 1
    double entry_threshold;      ///< above 0, to 1: of entry_volume; 0: 0.1
    double entry_radius;         ///< mm, above 0.001: of a ball, where neither a volume nor labels are given
    double needle_diameter;      ///< mm, above 0; 0: 2
    double needle_length;        ///< mm, from the tip to the other end, at least the diameter; 0: 200
    double margin;               ///< mm: distance of a safe path from the obstacles
    double max_length;           ///< mm, of a path; 0: any
    double max_angle;            ///< degrees between a path and the normal of the surface, where limit_angle is 1
    uint32_t limit_angle;        ///< 0: at any angle, and where the surface has no normal
    uint32_t entries;            ///< directions: the least 10 n^2 + 2 that is no fewer; 0: 1002
    int32_t entry_label;         ///< of entry_labels
    uint32_t border_entries;     ///< 1: paths may begin where the image ends within the thing, too
    uint32_t triangle_distances; ///< 1: of a needle: the column `distance` of triangles, for about as long again
    double tolerance;            ///< mm: stop when upper - lower is at most this
    double max;                  ///< mm: stop when lower reaches this; 0: 10
    uint64_t max_steps;          ///< of the search of one path
} vxt_plan;

/// Answers as tables. Each question has a table `pairs` (motion: `segments`, plan: `paths`) with a row for each pair in
/// order, others besides, and `totals` with one row. Used again and again, an answer keeps its memory.
typedef struct vxt_answer vxt_answer;
/// Makes an empty one.
VXT_CHECKED vxt_result vxt_answer_create(vxt_answer** answer);
/// Destroys it.
VXT_API void vxt_answer_destroy(vxt_answer* answer);

/// What a column holds.
typedef enum vxt_type {
    VXT_TYPE_UINT32 = 0,      ///< a number of an enumeration, too: `choices` of its column
    VXT_TYPE_INT32 = 1,       ///< a label
    VXT_TYPE_UINT64 = 2,      ///< a count
    VXT_TYPE_DOUBLE = 3,      ///< in `unit`
    VXT_TYPE_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_type;

/// A column of an answer. Its texts live for ever; `data` until the next answer is put there, or the object ends.
typedef struct vxt_column {
    size_t struct_size;  ///< sizeof
    const char* table;   ///< "pairs"
    const char* name;    ///< "lower"
    const char* unit;    ///< "mm"; "" for none
    const char* text;    ///< one line: what it says
    const char* choices; ///< of an enumeration, the names of 0, 1, 2 ...: "no,yes,undecided"; else ""
    const void* data;    ///< of the first row; null where there is no row
    size_t rows;         ///< of the table
    size_t stride;       ///< bytes from row to row
    vxt_type type;       ///< of each element
    uint32_t elements;   ///< in each row: 1, 3 of a point, 16 of a pose
    size_t offset;       ///< bytes from the begin of a row to the column
} vxt_column;

/// How many columns an answer has, of all its tables; 0 of null.
VXT_API size_t vxt_answer_columns(const vxt_answer* answer);
/// One of them, table by table.
VXT_CHECKED vxt_result vxt_answer_column(const vxt_answer* answer, size_t index, vxt_column* column);
/// The column of a name. NOT_READY where the answer has none of that name.
VXT_CHECKED vxt_result vxt_answer_find(const vxt_answer* answer, const char* table, const char* name,
                                       vxt_column* column);

/// Whole numbers that are limits and defaults.
typedef enum vxt_limit {
    VXT_MAX_THREADS = 4096,              ///< of a host engine
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

/// A number that a question takes. Its texts live for ever.
typedef struct vxt_fact {
    size_t struct_size;    ///< sizeof
    const char* question;  ///< "touch"; "scene": of every question
    const char* name;      ///< the member of its struct
    const char* unit;      ///< "mm", "mm^2", "degrees", "voxels"; "" for none
    const char* text;      ///< one line
    const char* range;     ///< "from 1e-06 mm on"
    double min;            ///< smallest value
    double max;            ///< largest value
    double standard;       ///< the default, where there is one
    uint32_t has_standard; ///< 0: the number is optional
} vxt_fact;
/// How many there are.
VXT_API size_t vxt_fact_count(void);
/// One of them.
VXT_CHECKED vxt_result vxt_fact_get(size_t index, vxt_fact* fact);

/// Answers questions on the host: voxtact::cpu::HostEngine. One call at a time.
typedef struct vxt_host_engine vxt_host_engine;
/// Starts its threads; 0: one for each processor.
VXT_CHECKED vxt_result vxt_host_engine_create(uint32_t threads, vxt_host_engine** engine);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_engine_threads(const vxt_host_engine* engine);
/// Destroys it and its threads.
VXT_API void vxt_host_engine_destroy(vxt_host_engine* engine);

/// Each answers a question for every pair. A null question is all defaults. After a failure `answer` holds what it
/// held.
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
/// Answers a plan, which has no pairs. The question cannot be null.
VXT_CHECKED vxt_result vxt_ask_plan(vxt_host_engine* engine, const vxt_plan* question, vxt_answer* answer);

/// What is known of a mesh that moves, at one of its poses: voxtact::TrackedDistance.
typedef struct vxt_tracked {
    size_t struct_size; ///< sizeof
    double lower;       ///< mm: no point of the surface is nearer to an opaque one
    double upper;       ///< mm: some point is as near; infinite where that is not known
    uint32_t touch;     ///< 0: certainly no; 1: certainly yes; 2: undecided
    uint32_t searched;  ///< the volume was looked into; 0: it follows from what was known before
} vxt_tracked;
/// Follows a mesh that moves by little from call to call: voxtact::cpu::DistanceTracker. One call at a time, on the
/// calling thread.
typedef struct vxt_tracker vxt_tracker;
/// `max`: mm, farther than this is never looked; 0: as far as it takes. `resolution`: voxels; 0: 1/64. `max_steps`: of
/// one search; 0: 512.
VXT_CHECKED vxt_result vxt_tracker_create(double max, double resolution, uint64_t max_steps, vxt_tracker** tracker);
/// Tracks the mesh at the one pose of the item. `opacity_threshold`: above 0, to 1; 0: 0.1.
VXT_CHECKED vxt_result vxt_tracker_track(vxt_tracker* tracker, const vxt_host_item* item, double opacity_threshold,
                                         vxt_tracked* tracked);
/// Destroys it.
VXT_API void vxt_tracker_destroy(vxt_tracker* tracker);

/// Whether a mesh has an inside: voxtact::SolidFacts.
typedef struct vxt_solid_facts {
    uint32_t holes;        ///< loops of edges where the surface ends; 0: it is closed
    uint32_t open_edges;   ///< edges of all holes together
    uint32_t non_manifold; ///< edges of more than two triangles
    uint32_t inward;       ///< 1: the triangles face inwards, which changes nothing
    double longest_hole;   ///< object units: length of the longest loop
    double signed_volume;  ///< object units^3, no bound
} vxt_solid_facts;
/// Refuses what voxtact::checkSolid() refuses.
VXT_CHECKED vxt_result vxt_check_solid(const vxt_mesh_view* mesh, vxt_solid_facts* facts);
/// Fills each hole by a fan: voxtact::fillHoles(). `area`: object units^2 that were added; may be null.
VXT_CHECKED vxt_result vxt_mesh_fill_holes(const vxt_mesh_view* mesh, vxt_mesh_data** filled, double* area);

/// The pose at a parameter from 0 to 1 on the way between two: voxtact::poseBetween(). `centre` is the middle of the
/// mesh's box in object space, which SLERP alone needs; it may be null for SCREW.
VXT_CHECKED vxt_result vxt_pose_between(const double from[16], const double to[16], double parameter,
                                        vxt_interpolation interpolation, const double centre[3],
                                        double world_from_object[16]);
/// The labels that a straight line crosses, in their order, each once, without 0: voxtact::labelsAlong(). As many as
/// there is `room` for go to `found`, which may be null where that is 0; `count` is how many there are.
VXT_CHECKED vxt_result vxt_labels_along(const vxt_labels* labels, const double from[3], const double to[3],
                                        int32_t* found, size_t room, size_t* count);

#ifdef __cplusplus
}
#endif

#endif

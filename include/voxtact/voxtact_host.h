/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_HOST_H
#define VOXTACT_VOXTACT_HOST_H

#include "voxtact/voxtact_answer.h"

/// @file
/// The host engine in C: voxtact::cpu. What holds for voxtact.h, which includes this, holds here.

#ifdef __cplusplus
extern "C" {
#endif

/// A 3D image on the host: voxtact::cpu::Volume.
typedef struct vxt_host_volume vxt_host_volume;
/// Copies the voxels.
VXT_CHECKED vxt_result vxt_host_volume_create(const vxt_volume_view* view, vxt_host_volume** volume);
/// Where the voxels are.
VXT_CHECKED vxt_result vxt_host_volume_grid(const vxt_host_volume* volume, vxt_grid* grid);
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
/// Bends it: `vertex_count` vertices of three coordinates, as many as it has, come elsewhere; triangles stay between
/// them. No other call may use the mesh meanwhile. Refused, it is as it was: voxtact::cpu::Mesh::update().
VXT_CHECKED vxt_result vxt_host_mesh_update(vxt_host_mesh* mesh, const float* positions, size_t vertex_count);

/// Ends calls of the host engine early: those whose batch or task has it soon return CANCELLED once it is set, and at
/// once where it was set before. Setting it is safe from any thread while calls look at it; a call that has seen it
/// set returns CANCELLED, even where it is made ready again meanwhile.
typedef struct vxt_cancel vxt_cancel;
/// One that is not set.
VXT_CHECKED vxt_result vxt_cancel_create(vxt_cancel** cancel);
/// Sets it, or with 0 makes it ready for the next call. Null is allowed.
VXT_API void vxt_cancel_set(vxt_cancel* cancel, uint32_t set);
/// Ends it. No call may look at it.
VXT_API void vxt_cancel_destroy(vxt_cancel* cancel);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_host_item {
    size_t struct_size;                                  ///< sizeof
    const vxt_host_mesh* mesh;                           ///< what touches
    const vxt_host_volume* volume;                       ///< what is touched
    const vxt_host_transfer_function* transfer_function; ///< what of it is opaque
    const double* world_from_object;                     ///< 16 doubles per pose; affine
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
    const vxt_cancel* cancel;   ///< ends the call early; may be null, the default
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

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_DETECT_H
#define VOXTACT_VOXTACT_VULKAN_DETECT_H

#include "voxtact/voxtact_answer.h"
#include "voxtact/voxtact_vulkan_scene.h"

/// @file
/// Detectors, poses and results on the caller's device. See voxtact_vulkan.h.

#ifdef __cplusplus
extern "C" {
#endif

/// What a detector is made for: voxtact::DetectorDesc.
typedef struct vxt_detector_desc {
    size_t struct_size;         ///< sizeof
    vxt_method method;          ///< default QUERY; CPU is refused
    vxt_projection projection;  ///< default VIEW
    vxt_filter filter;          ///< default HARDWARE
    vxt_boundary boundary;      ///< default AUTO
    double max_depth;           ///< mm, how far a contact's penetration is followed; 0: 10
    double resolution;          ///< CERTIFIED, voxels; 2^-12 to 1; 0: 1/64
    uint32_t outputs;           ///< bits of vxt_output; default none; the results need room for them
    uint32_t samples_per_voxel; ///< DOMINANT_AXIS: along a voxel's side; 1 to 16; 0: 1
    uint32_t stop_at_first;     ///< CERTIFIED without outputs: the count is then 0 or 1, a lower bound; default 0
    uint32_t overestimate;      ///< DOMINANT_AXIS: every pixel that a triangle touches gives a fragment; default 0
    uint32_t counters;          ///< CERTIFIED: what the passes do is counted, for vxt_answer_counters(); default 0
    uint32_t device_poses;      ///< items may have vxt_item::poses: voxtact::DetectorDesc::devicePoses; default 0
} vxt_detector_desc;

/// Poses in a buffer of the caller's: voxtact::WrappedPoses. 16 floats each, column-major, which is a mat4 of std430.
typedef struct vxt_wrapped_poses {
    size_t struct_size;  ///< sizeof
    VkBuffer buffer;     ///< usage STORAGE_BUFFER
    VkDeviceSize offset; ///< bytes, of the first one; a multiple of 4
    VkDeviceSize stride; ///< bytes from one to the next; at least 64; a multiple of 4; 0: 64
    double most_scale;   ///< no pose makes anything more than so many times as long; 0: 1. No answer depends on it
    uint32_t count;      ///< poses in the buffer; at least 1
} vxt_wrapped_poses;

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
    const double* world_from_object;                ///< 16 doubles per pose; affine; read while recording only
    size_t pose_count;                              ///< poses: a pair each
    const vxt_label_map* labels;                    ///< for the outputs CONTACTS (optional) and LABELS
    const vxt_pose_buffer* poses; ///< on the device: the first pose_count of them, world_from_object being null; for
                                  ///< detectors with device_poses. A pose that cannot be used is EXACTNESS_REFUSED
} vxt_item;

/// The pairs of one submission: the items in order, each with its poses in order.
typedef struct vxt_batch {
    size_t struct_size;    ///< sizeof
    const vxt_item* items; ///< any number; answers are in their order
    size_t item_count;     ///< of `items`
    const vxt_view* view;  ///< may be null for projections without a camera
    double threshold;      ///< above 0, to 1: opacity from which a sample is opaque; 0: 0.1
} vxt_batch;

/// A part of a device buffer with the usage STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST. The buffer is null where
/// there is nothing.
typedef struct vxt_buffer_range {
    VkBuffer buffer;     ///< null: there is nothing
    VkDeviceSize offset; ///< bytes
    VkDeviceSize size;   ///< bytes
} vxt_buffer_range;

/// How large results are, and what they keep: voxtact::ResultsDesc.
typedef struct vxt_results_desc {
    size_t struct_size;     ///< sizeof
    uint64_t triangle_room; ///< with outputs: the sum over the pairs of the triangles of their meshes; default 0
    uint64_t label_room;    ///< with outputs: the sum over the pairs of the labels of their label maps; default 0
    uint32_t contact_room;  ///< with outputs: a longer list is cut; 0: 2^16
    uint32_t outputs;       ///< bits of vxt_output: if there are any, there is room for outputs; default none
    uint32_t max_pairs;     ///< pairs of the largest batch; 0: 1
    uint32_t no_read_back;  ///< 1: no host copy is kept for vxt_results_read()
    uint32_t timestamps;    ///< the device time is measured; default 0
    uint32_t queue_family;  ///< with timestamps: of the queue that will execute; default 0
    /// CERTIFIED: clusters that a dispatch looks at, at most, 16 to 262144: voxtact::ResultsDesc::clustersAtOnce.
    /// Default 0: by max_pairs. VXT_NO_CLUSTERS: none, for results that are for other projections.
    uint32_t clusters_at_once;
    uint32_t staged; ///< not 0: voxtact::ResultsDesc::staged, with what it asks of the caller; default 0
    /// Where the answers go, a PairResult for each pair: a part of a buffer of the caller's, which outlives the
    /// results: voxtact::ResultsDesc::into. Default null: a buffer of the results' own.
    vxt_buffer_range into;
} vxt_results_desc;

/// From the answers of one frame of a ring to those of the next in vxt_results_desc::into: voxtact::resultBytes().
static inline VkDeviceSize vxt_result_bytes(uint32_t max_pairs) {
    return (UINT64_C(24) * max_pairs + 255) / 256 * 256;
}

/// For vxt_results_desc::clusters_at_once.
#define VXT_NO_CLUSTERS UINT32_C(0xffffffff)

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
/// Allocates the buffers. A null `desc` is all defaults.
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

/// What the passes of the projection CERTIFIED did for a batch: voxtact::CertifiedCounters, whose comments say of
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
    uint64_t cells_certain;   ///< of cells_seen, count without a decision: opaque all over, a triangle clearly in them
} vxt_certified_counters;

/// Of an answer that a detector with vxt_detector_desc::counters gave; NOT_READY of any other.
VXT_CHECKED vxt_result vxt_answer_counters(const vxt_answer* answer, vxt_certified_counters* counters);

/// Results for frames in flight: voxtact::ResultRing.
typedef struct vxt_result_ring vxt_result_ring;
/// `frames`: how many may be in flight. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_result_ring_create(const vxt_context* context, uint32_t frames, const vxt_results_desc* desc,
                                              vxt_result_ring** ring);
/// The slot of a frame, for recording; the ring's own, valid until its next vxt_result_ring_begin(). The caller knows
/// that the frame that had the slot before has completed. Nothing can be read of it until a detection and its read-back
/// are recorded.
VXT_CHECKED vxt_result vxt_result_ring_begin(vxt_result_ring* ring, uint64_t frame, vxt_results** results);
/// The results of a completed frame; NOT_READY when its slot was never used, or has been taken by a later frame.
VXT_CHECKED vxt_result vxt_result_ring_read(vxt_result_ring* ring, uint64_t frame, vxt_answer* answer);
/// Ends it and its results.
VXT_API void vxt_result_ring_destroy(vxt_result_ring* ring);

/// Decides which pairs touch: voxtact::Detector.
typedef struct vxt_detector vxt_detector;
/// UNSUPPORTED, with the missing feature or limit named, when the device cannot do it. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_detector_create(const vxt_context* context, const vxt_detector_desc* desc,
                                           vxt_detector** detector);
/// Records the detection of a batch: no allocation of device memory, no submission, no wait, no map. On error nothing
/// useful was recorded, and the command buffer must not be submitted.
VXT_CHECKED vxt_result vxt_detector_cmd_detect(const vxt_detector* detector, VkCommandBuffer commands,
                                               const vxt_batch* batch, vxt_results* results);
/// Which variant VXT_BOUNDARY_AUTO takes for an item at a threshold above 0, to 1; 0: 0.1.
VXT_CHECKED vxt_result vxt_detector_boundary_for(const vxt_detector* detector, const vxt_item* item, double threshold,
                                                 vxt_boundary* boundary);
/// Ends it.
VXT_API void vxt_detector_destroy(vxt_detector* detector);

/// Records, submits on the caller's queue, waits and reads: voxtact::BlockingDetector.
typedef struct vxt_blocking_detector vxt_blocking_detector;
/// A list of contacts is cut beyond `most_contacts`; 0 is 2^16. A null `desc` is all defaults.
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

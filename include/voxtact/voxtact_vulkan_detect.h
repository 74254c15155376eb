/* SPDX-License-Identifier: MIT */
/* A section of voxtact_vulkan.h, which includes this file after the scene. */
#include "voxtact/voxtact_vulkan.h"

#ifndef VOXTACT_VOXTACT_VULKAN_DETECT_H
#define VOXTACT_VOXTACT_VULKAN_DETECT_H

/// @file
/// Detectors, poses and results on the caller's device. See voxtact_vulkan.h.

#ifdef __cplusplus
extern "C" {
#endif

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
/// Destroys the object.
VXT_API void vxt_pose_buffer_destroy(vxt_pose_buffer* poses);

/// One mesh at some poses against one volume under one transfer function.
typedef struct vxt_item {
    size_t struct_size;                             ///< sizeof this struct
    const vxt_mesh* mesh;                           ///< outlives the command buffer, like the others
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

/// Capacity of results: voxtact::ResultsDesc. An output of the detector needs its capacity; the others are ignored.
typedef struct vxt_results_desc {
    size_t struct_size;     ///< sizeof this struct
    uint64_t triangle_room; ///< output TRIANGLES: triangles of all pairs' meshes together
    uint64_t label_room;    ///< output LABELS: labels of all pairs' label maps together
    uint32_t contact_room;  ///< output CONTACTS: maximum number; a longer list is cut; 0: 2^16
    uint32_t max_pairs;     ///< maximum number of pairs of a batch; 0: 1
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
/// Reads the host copy of a submission that the caller knows to be complete; NOT_READY if it visibly is not. With
/// timestamps, gpu_milliseconds is that of the batch.
VXT_CHECKED vxt_result vxt_results_read(vxt_results* results, vxt_answer* answer);
/// Destroys the object. Ignores the results of a ring, which the ring owns.
VXT_API void vxt_results_destroy(vxt_results* results);

/// Counters of the passes of the projection CERTIFIED for a batch: voxtact::CertifiedCounters, whose comments describe
/// them. A peak is that of the round with the most.
typedef struct vxt_certified_counters {
    size_t struct_size;       ///< sizeof this struct
    uint64_t clusters;        ///< clusters that were tested, once for each pair
    uint64_t clusters_kept;   ///< of these, those that may touch
    uint64_t runs_kept;       ///< runs of 16 triangles that may touch
    uint64_t large_parts;     ///< shares of triangles with more than 27 cells
    uint64_t bricks_seen;     ///< bricks of these triangles that were tested
    uint64_t cells_seen;      ///< cells that were tested
    uint64_t cells_listed;    ///< of these, cells that need a decision
    uint64_t cells_decided;   ///< cells that a lane decided
    uint64_t lanes;           ///< lanes dispatched for these cells
    uint64_t cells_open;      ///< cells that single precision left undecided
    uint64_t left;            ///< shares of work groups that a queue had no room for
    uint64_t bricks_left;     ///< bricks tested for these
    uint64_t cells_left;      ///< cells tested for these
    uint32_t rounds;          ///< dispatches of each pass
    uint32_t room;            ///< maximum number of clusters in a round
    uint32_t most_clusters;   ///< peak of clusters_kept
    uint32_t most_runs;       ///< peak of runs_kept
    uint32_t most_parts;      ///< peak of large_parts
    uint32_t most_cells;      ///< peak of cells_listed
    uint32_t most_open;       ///< peak of cells_open
    uint32_t most_left;       ///< peak of left
    uint32_t most_looks;      ///< peak of bricks_seen and cells_seen together
    uint32_t most_looks_left; ///< peak of bricks_left and cells_left together
    uint64_t cells_certain;   ///< of cells_seen, counted without a decision: opaque, a triangle clearly inside
} vxt_certified_counters;

/// Returns the counters of an answer with vxt_certified_desc::counters; otherwise NOT_READY.
VXT_CHECKED vxt_result vxt_answer_counters(const vxt_answer* answer, vxt_certified_counters* counters);

/// Results for frames in flight: voxtact::ResultRing.
typedef struct vxt_result_ring vxt_result_ring;
/// Creates a ring. `frames`: maximum number in flight. A null `desc` has all defaults.
VXT_CHECKED vxt_result vxt_result_ring_create(const vxt_detector* detector, uint32_t frames,
                                              const vxt_results_desc* desc, vxt_result_ring** ring);
/// Returns the slot of a frame, for recording; the ring owns it, and it is valid until its next
/// vxt_result_ring_begin(). The frame that used the slot before must have completed. Nothing can be read from it until
/// a detection and its read-back are recorded.
VXT_CHECKED vxt_result vxt_result_ring_begin(vxt_result_ring* ring, uint64_t frame, vxt_results** results);
/// Reads the results of a completed frame; NOT_READY if its slot was never used, or a later frame has taken it.
VXT_CHECKED vxt_result vxt_result_ring_read(vxt_result_ring* ring, uint64_t frame, vxt_answer* answer);
/// Destroys the object and its results.
VXT_API void vxt_result_ring_destroy(vxt_result_ring* ring);

/// Creates a certified detector: voxtact::Detector::certified(). UNSUPPORTED, with the missing feature or limit, if the
/// device cannot run it. A null `desc` has all defaults.
VXT_CHECKED vxt_result vxt_detector_create_certified(const vxt_context* context, const vxt_certified_desc* desc,
                                                     vxt_detector** detector);
/// Like vxt_detector_create_certified(), for voxtact::Detector::raster().
VXT_CHECKED vxt_result vxt_detector_create_raster(const vxt_context* context, const vxt_raster_desc* desc,
                                                  vxt_detector** detector);
/// Records the detection of a batch: no allocation of device memory, no submission, no wait, no map. On error nothing
/// useful was recorded, and the command buffer must not be submitted.
VXT_CHECKED vxt_result vxt_detector_cmd_detect(const vxt_detector* detector, VkCommandBuffer commands,
                                               const vxt_batch* batch, vxt_results* results);
/// Returns the variant that VXT_BOUNDARY_AUTO selects for an item at a threshold above 0, up to 1; 0: 0.1.
VXT_CHECKED vxt_result vxt_detector_boundary_for(const vxt_detector* detector, const vxt_item* item, double threshold,
                                                 vxt_boundary* boundary);
/// Destroys the object.
VXT_API void vxt_detector_destroy(vxt_detector* detector);

/// Records, submits on the caller's queue, waits and reads: voxtact::BlockingDetector.
typedef struct vxt_blocking_detector vxt_blocking_detector;
/// Creates a certified detector. `most_contacts`: maximum number of contacts; a longer list is cut; 0: 2^16. A null
/// `desc` has all defaults.
VXT_CHECKED vxt_result vxt_blocking_detector_create_certified(const vxt_context* context,
                                                              const vxt_certified_desc* desc, const vxt_queue* queue,
                                                              uint32_t most_contacts, vxt_blocking_detector** detector);
/// Like vxt_blocking_detector_create_certified(), for the other detectors.
VXT_CHECKED vxt_result vxt_blocking_detector_create_raster(const vxt_context* context, const vxt_raster_desc* desc,
                                                           const vxt_queue* queue, uint32_t most_contacts,
                                                           vxt_blocking_detector** detector);
/// Answers for every pair. Blocks. After a failure `answer` is unchanged.
VXT_CHECKED vxt_result vxt_blocking_detector_detect(vxt_blocking_detector* detector, const vxt_batch* batch,
                                                    vxt_answer* answer);
/// Destroys the object.
VXT_API void vxt_blocking_detector_destroy(vxt_blocking_detector* detector);

#ifdef __cplusplus
}
#endif

#endif

// SPDX-License-Identifier: MIT
// Detection on the device.
#include "c/answer.h"
#include "c/batch.h"
#include "c/convert_vulkan.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

using DeviceBatch = BatchOf<Batch, BatchItem>;

std::optional<ClearanceSearch> searchOf(const vxt_detector_desc& desc) {
    if (desc.clearance_tolerance == 0) {
        if (desc.max_clearance != 0) {
            refuse(ErrorCode::InvalidArgument, "detector: max_clearance is given, and clearance_tolerance is 0");
        }
        return std::nullopt;
    }
    ClearanceSearch search{.tolerance = desc.clearance_tolerance};
    if (desc.max_clearance != 0) {
        search.maximum = desc.max_clearance;
    }
    return search;
}

std::optional<PoseTolerance> toleranceOf(const vxt_detector_desc& desc) {
    if (desc.pose_distance == 0 && desc.pose_angle == 0) {
        return std::nullopt;
    }
    return PoseTolerance{desc.pose_distance, desc.pose_angle};
}

std::optional<MotionSearch> motionOf(const vxt_detector_desc& desc) {
    if (desc.motion_resolution == 0) {
        return std::nullopt;
    }
    return MotionSearch{desc.motion_resolution, number<Interpolation>(desc.motion_interpolation)};
}

DetectorDesc toDesc(const vxt_detector_desc* given) {
    const vxt_detector_desc desc = readOptions(given, vxt_detector_desc_init(), "detector");
    return {.method = number<CountingMethod>(desc.method),
            .projection = number<Projection>(desc.projection),
            .filter = number<Filter>(desc.filter),
            .boundary = number<Boundary>(desc.boundary),
            .outputs = toOutputs(desc.outputs, desc.max_depth),
            .samplesPerVoxel = desc.samples_per_voxel,
            .resolution = desc.resolution,
            .stopAtFirst = desc.stop_at_first != 0,
            .counters = desc.counters != 0,
            .overestimate = desc.overestimate != 0,
            .devicePoses = desc.device_poses != 0,
            .margin = desc.margin,
            .poseTolerance = toleranceOf(desc),
            .clearance = searchOf(desc),
            .closest = desc.closest != 0,
            .labelClearances = desc.label_clearances != 0,
            .labelsAtAnyOpacity = desc.labels_at_any_opacity != 0,
            .motion = motionOf(desc)};
}

} // namespace

vxt_result vxt_detector_create(const vxt_context* context, const vxt_detector_desc* desc, vxt_detector** detector) {
    return create(context, "context", detector,
                  [&](const Context& on) { return take(Detector::create(on, toDesc(desc))); });
}

vxt_result vxt_detector_cmd_detect(const vxt_detector* detector, VkCommandBuffer commands, const vxt_batch* batch,
                                   vxt_results* results) {
    return call(detector, [&] {
        const Detector& by = need(detector, "detector").object;
        Results& to = need(results, "results").object.get();
        const DeviceBatch of(batch, vxt_batch_init(), vxt_item_init());
        take(by.cmdDetect(commands, of.batch(), to));
    });
}

vxt_result vxt_detector_boundary_for(const vxt_detector* detector, const vxt_item* item, double threshold,
                                     vxt_boundary* boundary) {
    return call(detector, [&] {
        const Detector& by = need(detector, "detector").object;
        const BatchItem of = DeviceBatch::toItem(readStruct(item, vxt_item_init(), "item"));
        need(of.volume, "item: volume");
        need(of.transferFunction, "item: transfer function");
        need(boundary, "boundary") = number<vxt_boundary>(by.boundaryFor(of, threshold));
    });
}

void vxt_detector_destroy(vxt_detector* detector) {
    delete detector;
}

vxt_result vxt_blocking_detector_create(const vxt_context* context, const vxt_detector_desc* desc,
                                        const vxt_queue* queue, uint32_t most_contacts,
                                        vxt_blocking_detector** detector) {
    return create(context, "context", detector, [&](const Context& on) {
        return take(BlockingDetector::create(on, toDesc(desc), toQueue(queue),
                                             most_contacts == 0 ? kDefaultContactRoom : most_contacts));
    });
}

vxt_result vxt_blocking_detector_detect(vxt_blocking_detector* detector, const vxt_batch* batch, vxt_answer* answer) {
    return call(detector, [&] {
        BlockingDetector& by = need(detector, "detector").object;
        vxt_answer& to = need(answer, "answer");
        const DeviceBatch of(batch, vxt_batch_init(), vxt_item_init());
        to = toAnswer(take(by.detect(of.batch())));
    });
}

void vxt_blocking_detector_destroy(vxt_blocking_detector* detector) {
    delete detector;
}

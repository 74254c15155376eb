// SPDX-License-Identifier: MIT
// Detection on the device.
#include "c/answer.h"
#include "c/batch.h"
#include "c/convert_vulkan.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

DetectorDesc toDesc(const vxt_certified_desc* given) {
    const vxt_certified_desc desc = readOptions(given, zero<vxt_certified_desc>(), "detector");
    return CertifiedDesc{.resolution = orDefault(desc.resolution, kDefaultResolution),
                         .outputs = toOutputs(desc.outputs, orDefault(desc.max_depth, kDefaultMaxDepth)),
                         .stopAtFirst = desc.stop_at_first != 0,
                         .counters = desc.counters != 0,
                         .devicePoses = desc.device_poses != 0};
}

DetectorDesc toDesc(const vxt_raster_desc* given) {
    const vxt_raster_desc desc = readOptions(given, zero<vxt_raster_desc>(), "detector");
    return RasterDesc{.method = number<CountingMethod>(desc.method),
                      .projection = number<Projection>(desc.projection),
                      .filter = number<Filter>(desc.filter),
                      .boundary = number<Boundary>(desc.boundary),
                      .outputs = toOutputs(desc.outputs, orDefault(desc.max_depth, kDefaultMaxDepth)),
                      .samplesPerVoxel = orDefault(desc.samples_per_voxel, kDefaultSamplesPerVoxel),
                      .overestimate = desc.overestimate != 0,
                      .devicePoses = desc.device_poses != 0};
}

template <class Desc> vxt_result makeDetector(const vxt_context* context, const Desc* desc, vxt_detector** detector) {
    return create(context, "context", detector,
                  [&](const Context& on) { return take(Detector::create(on, toDesc(desc))); });
}

template <class Desc>
vxt_result makeBlocking(const vxt_context* context, const Desc* desc, const vxt_queue* queue, std::uint32_t maxContacts,
                        vxt_blocking_detector** detector) {
    return create(context, "context", detector, [&](const Context& on) {
        return take(
            BlockingDetector::create(on, toDesc(desc), toQueue(queue), orDefault(maxContacts, kDefaultContactRoom)));
    });
}

} // namespace

vxt_result vxt_detector_create_certified(const vxt_context* context, const vxt_certified_desc* desc,
                                         vxt_detector** detector) {
    return makeDetector(context, desc, detector);
}

vxt_result vxt_detector_create_raster(const vxt_context* context, const vxt_raster_desc* desc,
                                      vxt_detector** detector) {
    return makeDetector(context, desc, detector);
}

vxt_result vxt_detector_cmd_detect(const vxt_detector* detector, VkCommandBuffer commands, const vxt_batch* batch,
                                   vxt_results* results) {
    return call(detector, [&] {
        const Detector& by = need(detector, "detector").object;
        Results& to = need(results, "results").object.get();
        const DeviceBatch of(batch);
        take(by.cmdDetect(commands, of.batch(), to));
    });
}

vxt_result vxt_detector_boundary_for(const vxt_detector* detector, const vxt_item* item, double threshold,
                                     vxt_boundary* boundary) {
    return call(detector, [&] {
        const Detector& by = need(detector, "detector").object;
        const BatchItem of = DeviceBatch::toItem(readStruct(item, zero<vxt_item>(), "item"));
        need(of.volume, "item: volume");
        need(of.transferFunction, "item: transfer function");
        need(boundary, "boundary") = number<vxt_boundary>(by.boundaryFor(of, thresholdOf(threshold)));
    });
}

void vxt_detector_destroy(vxt_detector* detector) {
    delete detector;
}

vxt_result vxt_blocking_detector_create_certified(const vxt_context* context, const vxt_certified_desc* desc,
                                                  const vxt_queue* queue, uint32_t max_contacts,
                                                  vxt_blocking_detector** detector) {
    return makeBlocking(context, desc, queue, max_contacts, detector);
}

vxt_result vxt_blocking_detector_create_raster(const vxt_context* context, const vxt_raster_desc* desc,
                                               const vxt_queue* queue, uint32_t max_contacts,
                                               vxt_blocking_detector** detector) {
    return makeBlocking(context, desc, queue, max_contacts, detector);
}

vxt_result vxt_blocking_detector_detect(vxt_blocking_detector* detector, const vxt_batch* batch, vxt_answer* answer) {
    return call(detector, [&] {
        BlockingDetector& by = need(detector, "detector").object;
        vxt_answer& to = need(answer, "answer");
        const DeviceBatch of(batch);
        to.object = toTables(take(by.detect(of.batch())));
    });
}

void vxt_blocking_detector_destroy(vxt_blocking_detector* detector) {
    delete detector;
}

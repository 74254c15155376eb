// SPDX-License-Identifier: MIT
// How much.
#include "c/batch.h"
#include "c/convert.h"
#include "c/handles.h"
#include "voxtact/voxtact_area.h"

#include <algorithm>
#include <vector>

using namespace voxtact;
using namespace voxtact::c;

struct vxt_areas {
    std::vector<vxt_pair_area> pairs;
    std::vector<vxt_label_area> labels;
    std::vector<vxt_triangle_area> triangles;
    double wallMilliseconds = 0;
};

namespace {

static_assert(VXT_AREA_CLOSED == static_cast<int>(AreaEnd::Closed));
static_assert(VXT_AREA_ROUNDING == static_cast<int>(AreaEnd::Rounding));
static_assert(VXT_AREA_BUDGET == static_cast<int>(AreaEnd::Budget));

cpu::AreaDesc toAreaDesc(const vxt_host_area_desc* given) {
    const vxt_host_area_desc desc = readOptions(given, vxt_host_area_desc_init(), "area meter");
    return {.threads = desc.threads,
            .tolerance = desc.tolerance,
            .resolution = desc.resolution,
            .mostSteps = desc.most_steps};
}

vxt_pair_area toArea(const PairArea& pair) noexcept {
    return {pair.bounds.lo, pair.bounds.hi, pair.pair, pair.item, pair.pose, number<vxt_area_end>(pair.end)};
}

vxt_label_area toLabelArea(const LabelArea& label) noexcept {
    return {label.bounds.lo,
            label.bounds.hi,
            label.pair,
            label.item,
            label.pose,
            label.label,
            number<vxt_area_end>(label.end),
            0};
}

vxt_triangle_area toTriangleArea(const TriangleArea& triangle) noexcept {
    return {triangle.bounds.lo, triangle.bounds.hi, triangle.whole,   triangle.pair,
            triangle.item,      triangle.pose,      triangle.triangle};
}

} // namespace

const char* vxt_area_end_name(vxt_area_end end) {
    return toString(number<AreaEnd>(end));
}

vxt_result vxt_areas_create(vxt_areas** areas) {
    return create(areas, [] { return vxt_areas(); });
}

vxt_result vxt_areas_get(const vxt_areas* areas, vxt_area_view* view) {
    return call([&] {
        const vxt_areas& from = need(areas, "areas");
        vxt_area_view out = vxt_area_view_init();
        out.pairs = handOut<vxt_pair_area>(from.pairs, &out.pair_count);
        out.labels = handOut<vxt_label_area>(from.labels, &out.label_count);
        out.wall_milliseconds = from.wallMilliseconds;
        out.triangles = handOut<vxt_triangle_area>(from.triangles, &out.triangle_count);
        writeStruct(view, out, "view");
    });
}

void vxt_areas_destroy(vxt_areas* areas) {
    delete areas;
}

vxt_result vxt_host_area_meter_create(const vxt_host_area_desc* desc, vxt_host_area_meter** meter) {
    return create(meter, [&] { return take(cpu::AreaMeter::create(toAreaDesc(desc))); });
}

vxt_result vxt_host_area_meter_measure(vxt_host_area_meter* meter, const vxt_host_batch* batch, vxt_areas* areas) {
    return call([&] {
        cpu::AreaMeter& by = need(meter, "meter").object;
        vxt_areas& to = need(areas, "areas");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        const AreaAnswer answer = take(by.measure(of.batch()));
        vxt_areas out;
        out.wallMilliseconds = answer.wallMilliseconds;
        std::ranges::transform(answer.pairs, std::back_inserter(out.pairs), toArea);
        to = std::move(out);
    });
}

vxt_result vxt_host_area_meter_measure_triangles(vxt_host_area_meter* meter, const vxt_host_batch* batch,
                                                 vxt_areas* areas) {
    return call([&] {
        cpu::AreaMeter& by = need(meter, "meter").object;
        vxt_areas& to = need(areas, "areas");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        const TriangleAreaAnswer answer = take(by.measureTriangles(of.batch()));
        vxt_areas out;
        out.wallMilliseconds = answer.wallMilliseconds;
        std::ranges::transform(answer.pairs, std::back_inserter(out.pairs), toArea);
        std::ranges::transform(answer.triangles, std::back_inserter(out.triangles), toTriangleArea);
        to = std::move(out);
    });
}

vxt_result vxt_host_area_meter_measure_labels(vxt_host_area_meter* meter, const vxt_host_batch* batch,
                                              const int32_t* labels, size_t label_count, vxt_areas* areas) {
    return call([&] {
        cpu::AreaMeter& by = need(meter, "meter").object;
        vxt_areas& to = need(areas, "areas");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        const LabelAreaAnswer answer = take(by.measureLabels(of.batch(), toSpan(labels, label_count, "labels")));
        vxt_areas out;
        out.wallMilliseconds = answer.wallMilliseconds;
        std::ranges::transform(answer.labels, std::back_inserter(out.labels), toLabelArea);
        to = std::move(out);
    });
}

uint32_t vxt_host_area_meter_threads(const vxt_host_area_meter* meter) {
    return meter == nullptr ? 0 : meter->object.threads();
}

void vxt_host_area_meter_destroy(vxt_host_area_meter* meter) {
    delete meter;
}

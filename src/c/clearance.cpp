// SPDX-License-Identifier: MIT
// How near.
#include "c/answer.h"
#include "c/batch.h"
#include "c/clearances.h"
#include "c/convert.h"
#include "c/handles.h"

#include <algorithm>
#include <limits>

using namespace voxtact;
using namespace voxtact::c;

namespace {

static_assert(VXT_CLEARANCE_CLOSED == static_cast<int>(ClearanceEnd::Closed));
static_assert(VXT_CLEARANCE_BEYOND == static_cast<int>(ClearanceEnd::Beyond));
static_assert(VXT_CLEARANCE_ROUNDING == static_cast<int>(ClearanceEnd::Rounding));
static_assert(VXT_CLEARANCE_BUDGET == static_cast<int>(ClearanceEnd::Budget));

cpu::ClearanceDesc toDesc(const vxt_host_clearance_desc* given) {
    const vxt_host_clearance_desc desc = readOptions(given, vxt_host_clearance_desc_init(), "clearance meter");
    return {.threads = desc.threads,
            .tolerance = desc.tolerance,
            .maximum = desc.maximum == 0 ? std::numeric_limits<double>::infinity() : desc.maximum,
            .resolution = desc.resolution,
            .mostSteps = desc.most_steps,
            .labelsAtAnyOpacity = desc.labels_at_any_opacity != 0};
}

} // namespace

vxt_label_clearance voxtact::c::toLabelClearance(const LabelClearance& label) noexcept {
    return {label.bounds.lo,
            label.bounds.hi,
            label.pair,
            label.item,
            label.pose,
            label.label,
            number<vxt_clearance_end>(label.end),
            0};
}

vxt_pair_clearance voxtact::c::toClearance(const PairClearance& pair) noexcept {
    vxt_pair_clearance out{};
    out.lo = pair.bounds.lo;
    out.hi = pair.bounds.hi;
    out.pair = pair.pair;
    out.item = pair.item;
    out.pose = pair.pose;
    out.end = number<vxt_clearance_end>(pair.end);
    if (pair.closest) {
        out.has_closest = 1;
        out.triangle = pair.closest->triangle;
        std::ranges::copy(pair.closest->mesh, out.mesh);
        std::ranges::copy(pair.closest->volume, out.volume);
        std::ranges::copy(pair.closest->perTranslation, out.per_translation);
        std::ranges::copy(pair.closest->perRotation, out.per_rotation);
    }
    return out;
}

const char* vxt_clearance_end_name(vxt_clearance_end end) {
    return toString(number<ClearanceEnd>(end));
}

vxt_result vxt_clearances_create(vxt_clearances** clearances) {
    return create(clearances, [] { return vxt_clearances(); });
}

vxt_result vxt_clearances_get(const vxt_clearances* clearances, vxt_clearance_view* view) {
    return call([&] {
        const vxt_clearances& from = need(clearances, "clearances");
        vxt_clearance_view out = vxt_clearance_view_init();
        out.pairs = handOut<vxt_pair_clearance>(from.pairs, &out.pair_count);
        out.labels = handOut<vxt_label_clearance>(from.labels, &out.label_count);
        out.wall_milliseconds = from.wallMilliseconds;
        writeStruct(view, out, "view");
    });
}

void vxt_clearances_destroy(vxt_clearances* clearances) {
    delete clearances;
}

vxt_result vxt_host_clearance_meter_create(const vxt_host_clearance_desc* desc, vxt_host_clearance_meter** meter) {
    return create(meter, [&] { return take(cpu::ClearanceMeter::create(toDesc(desc))); });
}

vxt_result vxt_host_clearance_meter_measure(vxt_host_clearance_meter* meter, const vxt_host_batch* batch,
                                            vxt_clearances* clearances) {
    return call([&] {
        cpu::ClearanceMeter& by = need(meter, "meter").object;
        vxt_clearances& to = need(clearances, "clearances");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        const ClearanceAnswer answer = take(by.measure(of.batch()));
        vxt_clearances out;
        out.wallMilliseconds = answer.wallMilliseconds;
        std::ranges::transform(answer.pairs, std::back_inserter(out.pairs), toClearance);
        to = std::move(out);
    });
}

vxt_result vxt_host_clearance_meter_measure_labels(vxt_host_clearance_meter* meter, const vxt_host_batch* batch,
                                                   const int32_t* labels, size_t label_count,
                                                   vxt_clearances* clearances) {
    return call([&] {
        cpu::ClearanceMeter& by = need(meter, "meter").object;
        vxt_clearances& to = need(clearances, "clearances");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        const LabelClearanceAnswer answer = take(by.measureLabels(of.batch(), toSpan(labels, label_count, "labels")));
        vxt_clearances out;
        out.wallMilliseconds = answer.wallMilliseconds;
        std::ranges::transform(answer.labels, std::back_inserter(out.labels), toLabelClearance);
        to = std::move(out);
    });
}

vxt_result vxt_host_clearance_meter_within(vxt_host_clearance_meter* meter, const vxt_host_batch* batch, double margin,
                                           vxt_answer* answer) {
    return call([&] {
        cpu::ClearanceMeter& by = need(meter, "meter").object;
        vxt_answer& to = need(answer, "answer");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        to = toAnswer(take(by.within(of.batch(), margin)));
    });
}

uint32_t vxt_host_clearance_meter_threads(const vxt_host_clearance_meter* meter) {
    return meter == nullptr ? 0 : meter->object.threads();
}

void vxt_host_clearance_meter_destroy(vxt_host_clearance_meter* meter) {
    delete meter;
}

vxt_result vxt_host_clearance_tracker_create(const vxt_host_tracker_desc* desc, vxt_host_clearance_tracker** tracker) {
    return create(tracker, [&] {
        const vxt_host_tracker_desc given = readOptions(desc, vxt_host_tracker_desc_init(), "tracker");
        cpu::TrackerDesc made{.resolution = given.resolution, .mostSteps = given.most_steps};
        if (given.maximum != 0) {
            made.maximum = given.maximum;
        }
        return take(cpu::ClearanceTracker::create(made));
    });
}

vxt_result vxt_host_clearance_tracker_track(vxt_host_clearance_tracker* tracker, const vxt_host_item* item,
                                            double threshold, vxt_tracked_clearance* clearance) {
    return call([&] {
        cpu::ClearanceTracker& by = need(tracker, "tracker").object;
        const cpu::BatchItem of = HostBatchOf::toItem(readStruct(item, vxt_host_item_init(), "item"));
        const TrackedClearance found = take(by.track(of, threshold));
        vxt_tracked_clearance out = vxt_tracked_clearance_init();
        out.lo = found.bounds.lo;
        out.hi = found.bounds.hi;
        out.hit = found.hit ? 1 : 0;
        out.possible = found.possible ? 1 : 0;
        out.searched = found.searched ? 1 : 0;
        writeStruct(clearance, out, "clearance");
    });
}

void vxt_host_clearance_tracker_destroy(vxt_host_clearance_tracker* tracker) {
    delete tracker;
}

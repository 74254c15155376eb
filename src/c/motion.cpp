// SPDX-License-Identifier: MIT
// On the way.
#include "c/answer.h"
#include "c/batch.h"
#include "c/convert.h"
#include "c/handles.h"
#include "c/motions.h"

#include <algorithm>

using namespace voxtact;
using namespace voxtact::c;

namespace {

static_assert(VXT_INTERPOLATION_SCREW == static_cast<int>(Interpolation::Screw));
static_assert(VXT_INTERPOLATION_SLERP == static_cast<int>(Interpolation::Slerp));
static_assert(VXT_MOTION_DECIDED == static_cast<int>(MotionEnd::Decided));
static_assert(VXT_MOTION_GRAZES == static_cast<int>(MotionEnd::Grazes));
static_assert(VXT_MOTION_BUDGET == static_cast<int>(MotionEnd::Budget));

cpu::MotionDesc toDesc(const vxt_host_motion_desc* given) {
    const vxt_host_motion_desc desc = readOptions(given, vxt_host_motion_desc_init(), "motion checker");
    return {.threads = desc.threads,
            .interpolation = number<Interpolation>(desc.interpolation),
            .resolution = desc.resolution,
            .touchResolution = desc.touch_resolution,
            .mostSteps = desc.most_steps};
}

vxt_segment_motion toSegment(const SegmentMotion& motion) noexcept {
    vxt_segment_motion out{};
    out.free_until = motion.freeUntil;
    out.segment = motion.segment;
    out.item = motion.item;
    out.pose = motion.pose;
    out.possible = motion.possible ? 1 : 0;
    out.end = number<vxt_motion_end>(motion.end);
    if (motion.touch) {
        out.touches = 1;
        out.touch_at = motion.touch->at;
        out.triangle = motion.touch->triangle;
        std::ranges::copy(motion.touch->world_from_object, out.world_from_object);
        std::ranges::copy(motion.touch->position, out.position);
    }
    return out;
}

} // namespace

vxt_motions voxtact::c::toMotions(const std::vector<SegmentMotion>& motions, double wallMilliseconds) {
    vxt_motions out;
    out.wallMilliseconds = wallMilliseconds;
    std::ranges::transform(motions, std::back_inserter(out.segments), toSegment);
    return out;
}

const char* vxt_interpolation_name(vxt_interpolation interpolation) {
    return toString(number<Interpolation>(interpolation));
}

const char* vxt_motion_end_name(vxt_motion_end end) {
    return toString(number<MotionEnd>(end));
}

vxt_result vxt_motions_create(vxt_motions** motions) {
    return create(motions, [] { return vxt_motions(); });
}

vxt_result vxt_motions_get(const vxt_motions* motions, vxt_motion_view* view) {
    return call([&] {
        const vxt_motions& from = need(motions, "motions");
        vxt_motion_view out = vxt_motion_view_init();
        out.segments = handOut<vxt_segment_motion>(from.segments, &out.segment_count);
        out.wall_milliseconds = from.wallMilliseconds;
        writeStruct(view, out, "view");
    });
}

void vxt_motions_destroy(vxt_motions* motions) {
    delete motions;
}

vxt_result vxt_host_motion_checker_create(const vxt_host_motion_desc* desc, vxt_host_motion_checker** checker) {
    return create(checker, [&] { return take(cpu::MotionChecker::create(toDesc(desc))); });
}

vxt_result vxt_host_motion_checker_check(vxt_host_motion_checker* checker, const vxt_host_batch* batch,
                                         vxt_motions* motions) {
    return call([&] {
        cpu::MotionChecker& by = need(checker, "checker").object;
        vxt_motions& to = need(motions, "motions");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        const MotionAnswer answer = take(by.check(of.batch()));
        to = toMotions(answer.segments, answer.wallMilliseconds);
    });
}

vxt_result vxt_host_motion_checker_around(vxt_host_motion_checker* checker, const vxt_host_batch* batch,
                                          double distance, double angle, vxt_answer* answer) {
    return call([&] {
        cpu::MotionChecker& by = need(checker, "checker").object;
        vxt_answer& to = need(answer, "answer");
        const HostBatchOf of(batch, vxt_host_batch_init(), vxt_host_item_init());
        to = toAnswer(take(by.around(of.batch(), {distance, angle})));
    });
}

uint32_t vxt_host_motion_checker_threads(const vxt_host_motion_checker* checker) {
    return checker == nullptr ? 0 : checker->object.threads();
}

void vxt_host_motion_checker_destroy(vxt_host_motion_checker* checker) {
    delete checker;
}

vxt_result vxt_pose_between(const double from[16], const double to[16], double parameter,
                            vxt_interpolation interpolation, const double centre[3], double world_from_object[16]) {
    return call([&] {
        const Interpolation how = number<Interpolation>(interpolation);
        const bool wantsCentre = how == Interpolation::Slerp;
        const Vec3 middle = centre == nullptr && !wantsCentre ? Vec3{} : toVec3(centre, "centre");
        writeMat4(world_from_object, take(poseBetween(toMat4(from, "from"), toMat4(to, "to"), parameter, how, middle)),
                  "world_from_object");
    });
}

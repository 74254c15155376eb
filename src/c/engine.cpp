// SPDX-License-Identifier: MIT
// The host engine, and its questions.
#include "c/answer.h"
#include "c/convert.h"
#include "c/handles.h"
#include "core/facts/facts.h"
#include "voxtact/named_questions.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

static_assert(VXT_FACT_NUMBER == static_cast<int>(FactKind::Number));
static_assert(VXT_FACT_LABELS == static_cast<int>(FactKind::Labels));
static_assert(VXT_INTERPOLATION_SCREW == static_cast<int>(Interpolation::Screw));
static_assert(VXT_INTERPOLATION_SLERP == static_cast<int>(Interpolation::Slerp));
static_assert(VXT_MAX_THREADS == cpu::kMaxThreads && VXT_MAX_TABLE_SIZE == kMaxTableSize);
static_assert(VXT_MAX_SAMPLES_PER_VOXEL == kMaxSamplesPerVoxel && VXT_MAX_ENTRIES == kMaxEntries);
static_assert(VXT_DEFAULT_TABLE_SIZE == kDefaultTableSize && VXT_DEFAULT_ENTRIES == cpu::EntrySurface().entries);
static_assert(VXT_DEFAULT_PLAN_MAX == static_cast<int>(kDefaultPlanMaximum));
static_assert(VXT_DEFAULT_PLAN_STEPS == cpu::Plan().maxSteps);
static_assert(VXT_DEFAULT_TRACKER_STEPS == cpu::TrackerDesc().maxSteps);

/// A number of the caller's, where 0 stands for the default.
template <class Number> void set(Number& to, Number given) noexcept {
    if (given != 0) {
        to = given;
    }
}

Setting toSetting(const vxt_setting& given) {
    const std::string name = &need(given.name, "the name of a setting");
    const int values =
        (given.text != nullptr ? 1 : 0) + (given.numbers != nullptr ? 1 : 0) + (given.labels != nullptr ? 1 : 0);
    if (values > 1) {
        refuse(ErrorCode::InvalidArgument, "the setting '" + name + "' has more than one of text, numbers and labels");
    }
    if (given.text != nullptr) {
        return {given.name, std::string_view(given.text)};
    }
    if (given.numbers != nullptr) {
        return {given.name, toSpan(given.numbers, given.count, name.c_str())};
    }
    if (given.labels != nullptr) {
        return {given.name, toSpan(given.labels, given.count, name.c_str())};
    }
    return {given.name, given.number};
}

cpu::BatchItem toItem(const vxt_host_item& item, const std::string& which) {
    return {objectOf(item.mesh), objectOf(item.volume), objectOf(item.transfer_function),
            toPoses(item.world_from_object, item.pose_count, (which + ": world_from_object").c_str()),
            objectOf(item.labels)};
}

cpu::PlanObstacle toObstacle(const vxt_obstacle& given) {
    const std::span<const std::int32_t> avoid = toSpan(given.avoid, given.avoid_count, "obstacle: avoid");
    return {.volume = objectOf(given.volume),
            .transferFunction = objectOf(given.transfer_function),
            .threshold = thresholdOf(given.opacity_threshold),
            .labels = objectOf(given.labels),
            .avoid = {avoid.begin(), avoid.end()},
            .name = given.name == nullptr ? "" : given.name};
}

/// `obstacles` must outlive it.
cpu::Plan toPlan(const vxt_plan& given, std::span<const cpu::PlanObstacle> obstacles) {
    cpu::Plan out;
    out.target = toVec3(given.target, "target");
    out.surface.volume = objectOf(given.entry_volume);
    out.surface.transferFunction = objectOf(given.entry_transfer_function);
    out.surface.threshold = thresholdOf(given.entry_threshold);
    out.surface.labels = objectOf(given.entry_labels);
    out.surface.label = given.entry_label;
    out.surface.radius = given.entry_radius;
    out.surface.borderEntries = given.border_entries != 0;
    set(out.surface.entries, given.entries);
    out.obstacles = obstacles;
    set(out.needle.diameter, given.needle_diameter);
    set(out.needle.length, given.needle_length);
    if (given.mesh != nullptr) {
        const Vec3 axis = toVec3(given.mesh_axis, "mesh_axis");
        out.mesh = cpu::PlanMesh{objectOf(given.mesh), toVec3(given.mesh_tip, "mesh_tip"),
                                 axis == Vec3{} ? Vec3{0, 0, 1} : axis};
    }
    out.margin = given.margin;
    if (given.max_length != 0) {
        out.longest = given.max_length;
    }
    if (given.limit_angle != 0) {
        out.steepest = given.max_angle;
    }
    out.triangleDistances = given.triangle_distances != 0;
    set(out.tolerance, given.tolerance);
    set(out.maximum, given.max);
    set(out.maxSteps, given.max_steps);
    out.cancel = objectOf(given.cancel);
    return out;
}

} // namespace

vxt_result vxt_host_engine_create(uint32_t threads, vxt_host_engine** engine) {
    return create(engine, [&] { return take(cpu::HostEngine::create(threads)); });
}

uint32_t vxt_host_engine_threads(const vxt_host_engine* engine) {
    return engine == nullptr ? 0 : engine->object.threads();
}

void vxt_host_engine_destroy(vxt_host_engine* engine) {
    delete engine;
}

vxt_result vxt_ask(vxt_host_engine* engine, const char* question, const vxt_setting* settings, size_t setting_count,
                   const vxt_pairs* pairs, vxt_answer* answer) {
    return call([&] {
        cpu::HostEngine& by = need(engine, "engine").object;
        vxt_answer& to = need(answer, "answer");
        const std::string_view asked = &need(question, "question");
        std::vector<Setting> given;
        std::ranges::transform(toSpan(settings, setting_count, "settings"), std::back_inserter(given), toSetting);
        const vxt_pairs of = readStruct(pairs, zero<vxt_pairs>(), "pairs");
        std::vector<cpu::BatchItem> items;
        for (const vxt_host_item& item : toSpan(of.items, of.item_count, "items")) {
            items.push_back(toItem(item, "item " + std::to_string(items.size())));
        }
        to.object = take(ask(by, asked, given,
                             cpu::Batch{.items = items,
                                        .view = toView(of.view),
                                        .threshold = thresholdOf(of.opacity_threshold),
                                        .cancel = objectOf(of.cancel)}));
    });
}

vxt_result vxt_ask_plan(vxt_host_engine* engine, const vxt_plan* question, vxt_answer* answer) {
    return call([&] {
        cpu::HostEngine& by = need(engine, "engine").object;
        vxt_answer& to = need(answer, "answer");
        const vxt_plan given = readStruct(question, zero<vxt_plan>(), "question");
        std::vector<cpu::PlanObstacle> obstacles;
        std::ranges::transform(toSpan(given.obstacles, given.obstacle_count, "obstacles"),
                               std::back_inserter(obstacles), toObstacle);
        to.object = toTables(take(by.ask(toPlan(given, obstacles))));
    });
}

vxt_result vxt_tracker_create(double max, double resolution, uint64_t max_steps, vxt_tracker** tracker) {
    return create(tracker, [&] {
        cpu::TrackerDesc desc;
        set(desc.maximum, max);
        set(desc.resolution, resolution);
        set(desc.maxSteps, max_steps);
        return take(cpu::DistanceTracker::create(desc));
    });
}

vxt_result vxt_tracker_track(vxt_tracker* tracker, const vxt_host_item* item, double opacity_threshold,
                             vxt_tracked* tracked) {
    return call([&] {
        cpu::DistanceTracker& by = need(tracker, "tracker").object;
        const cpu::BatchItem of = toItem(need(item, "item"), "item");
        const TrackedDistance found = take(by.track(of, thresholdOf(opacity_threshold)));
        vxt_tracked out = zero<vxt_tracked>();
        out.lower = found.bounds.lower;
        out.upper = found.bounds.upper;
        out.touch = found.hit ? 1 : found.possible ? 2 : 0;
        out.searched = found.searched ? 1 : 0;
        writeStruct(tracked, out, "tracked");
    });
}

void vxt_tracker_destroy(vxt_tracker* tracker) {
    delete tracker;
}

vxt_result vxt_check_solid(const vxt_mesh_view* mesh, vxt_solid_facts* facts) {
    return call([&] {
        const SolidFacts found = take(checkSolid(toMeshView(mesh)));
        need(facts, "facts") = {found.holes,       found.openEdges,   found.nonManifold, found.inward ? 1U : 0U,
                                found.longestHole, found.signedVolume};
    });
}

vxt_result vxt_mesh_fill_holes(const vxt_mesh_view* mesh, vxt_mesh_data** filled, double* area) {
    return create(filled, [&] {
        FilledMesh made = take(fillHoles(toMeshView(mesh)));
        if (area != nullptr) {
            *area = made.area;
        }
        return std::move(made.mesh);
    });
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

vxt_result vxt_labels_along(const vxt_labels* labels, const double from[3], const double to[3], int32_t* found,
                            size_t room, size_t* count) {
    return call([&] {
        const LabelData& in = need(labels, "labels").object;
        std::size_t& number = need(count, "count");
        const std::vector<std::int32_t> all = take(labelsAlong(in, toVec3(from, "from"), toVec3(to, "to")));
        const std::size_t shown = std::min(room, all.size());
        if (room != 0) {
            std::copy_n(all.begin(), shown, &need(found, "found"));
        }
        number = all.size();
    });
}

size_t vxt_question_count(void) {
    return namedQuestions().size();
}

vxt_result vxt_question_get(size_t index, vxt_question* question) {
    return call([&] {
        if (index >= namedQuestions().size()) {
            refuse(ErrorCode::NotReady, "there is no question " + std::to_string(index));
        }
        const NamedQuestion& of = namedQuestions()[index];
        vxt_question out = zero<vxt_question>();
        out.name = of.name.data();
        out.text = of.text.data();
        out.measures = of.measures ? 1 : 0;
        out.least_worst = of.isLeastWorst ? 1 : 0;
        writeStruct(question, out, "question");
    });
}

size_t vxt_fact_count(void) {
    return kFacts.size();
}

vxt_result vxt_fact_get(size_t index, vxt_fact* fact) {
    return call([&] {
        static const std::vector<std::string> ranges = [] {
            std::vector<std::string> all;
            std::ranges::transform(kFacts, std::back_inserter(all), rangeText);
            return all;
        }();
        if (index >= kFacts.size()) {
            refuse(ErrorCode::NotReady, "there is no fact " + std::to_string(index));
        }
        const Fact& of = kFacts[index];
        vxt_fact out = zero<vxt_fact>();
        out.question = of.question.data();
        out.name = of.name.data();
        out.unit = of.unit.data();
        out.text = of.text.data();
        out.range = ranges[index].c_str();
        out.min = of.min;
        out.max = of.max;
        out.standard = of.standard.value_or(0);
        out.has_standard = of.standard ? 1 : 0;
        out.kind = static_cast<vxt_fact_kind>(of.kind);
        out.choices = of.choices.data();
        writeStruct(fact, out, "fact");
    });
}

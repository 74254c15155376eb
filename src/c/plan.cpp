// SPDX-License-Identifier: MIT
// Which straight paths.
#include "c/convert.h"
#include "c/handles.h"

#include <algorithm>

using namespace voxtact;
using namespace voxtact::c;

struct vxt_plan {
    std::vector<vxt_planned_path> paths;
    std::vector<vxt_entry_triangle> triangles;
    std::vector<double> triangleClearances; ///< of each, or none
    PlanAnswer totals;                      ///< without these
};

namespace {

static_assert(VXT_SAFETY_UNSAFE == static_cast<int>(Safety::Unsafe));
static_assert(VXT_SAFETY_SAFE == static_cast<int>(Safety::Safe));
static_assert(VXT_SAFETY_POSSIBLE == static_cast<int>(Safety::Possible));

// What the initialisers of the header repeat.
static_assert(kDefaultPlanTolerance == 0.05 && kDefaultPlanMaximum == 10);
static_assert(Needle{}.diameter == 2 && Needle{}.length == 200);

cpu::PlannerDesc toDesc(const vxt_host_planner_desc* given) {
    const vxt_host_planner_desc desc = readOptions(given, vxt_host_planner_desc_init(), "planner");
    return {
        .threads = desc.threads, .tolerance = desc.tolerance, .maximum = desc.maximum, .mostSteps = desc.most_steps};
}

cpu::PlanObstacle toObstacle(const vxt_plan_obstacle& given) {
    const std::span<const std::int32_t> avoid = toSpan(given.avoid, given.avoid_count, "obstacle: avoid");
    return {.volume = objectOf(given.volume),
            .transferFunction = objectOf(given.transfer_function),
            .threshold = given.threshold,
            .labels = objectOf(given.labels),
            .avoid = {avoid.begin(), avoid.end()}};
}

/// A task of the caller's as the planner takes it.
class TaskOf {
  public:
    explicit TaskOf(const vxt_plan_task* given) : given_(readStruct(given, vxt_plan_task_init(), "task")) {
        for (const vxt_plan_obstacle& obstacle :
             readStructs(given_.obstacles, given_.obstacle_count, vxt_plan_obstacle_init(), "obstacle")) {
            obstacles_.push_back(toObstacle(obstacle));
        }
    }

    /// Valid as long as this is.
    [[nodiscard]] cpu::PlanTask task() const {
        cpu::PlanTask task;
        task.target = toVec3(given_.target, "target");
        task.surface = {.entries = given_.entries,
                        .volume = objectOf(given_.entry_volume),
                        .transferFunction = objectOf(given_.entry_transfer_function),
                        .threshold = given_.entry_threshold,
                        .labels = objectOf(given_.entry_labels),
                        .label = given_.entry_label,
                        .radius = given_.entry_radius,
                        .borderEntries = given_.border_entries != 0};
        task.obstacles = obstacles_;
        task.needle = {given_.needle_diameter, given_.needle_length};
        if (given_.mesh != nullptr) {
            task.mesh = cpu::PlanMesh{objectOf(given_.mesh), toVec3(given_.mesh_tip, "mesh_tip"),
                                      toVec3(given_.mesh_axis, "mesh_axis")};
        }
        task.margin = given_.margin;
        if (given_.max_length != 0) {
            task.longest = given_.max_length;
        }
        if (given_.has_max_angle != 0) {
            task.steepest = given_.max_angle;
        }
        task.triangleClearances = given_.triangle_clearances != 0;
        task.cancel = objectOf(given_.cancel);
        return task;
    }

  private:
    vxt_plan_task given_;
    std::vector<cpu::PlanObstacle> obstacles_;
};

vxt_planned_path toPath(const PlannedPath& path) noexcept {
    vxt_planned_path out{};
    std::ranges::copy(path.position, out.position);
    out.length = path.length;
    out.angle = path.angle.value_or(0);
    out.lo = path.clearance.lo;
    out.hi = path.clearance.hi;
    out.entry = path.entry;
    out.safety = number<vxt_safety>(path.safety);
    out.end = number<vxt_clearance_end>(path.end);
    out.has_angle = path.angle ? 1 : 0;
    if (path.nearest) {
        out.has_nearest = 1;
        out.obstacle = path.nearest->obstacle;
        out.label = path.nearest->label;
        std::ranges::copy(path.nearest->position, out.nearest);
        std::ranges::copy(path.nearest->onPath, out.on_path);
    }
    return out;
}

vxt_entry_triangle toTriangle(const EntryTriangle& triangle) noexcept {
    return {{triangle.paths[0], triangle.paths[1], triangle.paths[2]}, triangle.safe ? 1U : 0U};
}

vxt_plan toPlan(PlanAnswer answer, bool triangleClearances) {
    vxt_plan out;
    if (triangleClearances) {
        std::ranges::transform(answer.triangles, std::back_inserter(out.triangleClearances), &EntryTriangle::clearance);
    }
    std::ranges::transform(answer.paths, std::back_inserter(out.paths), toPath);
    std::ranges::transform(answer.triangles, std::back_inserter(out.triangles), toTriangle);
    answer.paths = {};
    answer.triangles = {};
    out.totals = std::move(answer);
    return out;
}

} // namespace

const char* vxt_safety_name(vxt_safety safety) {
    return toString(number<Safety>(safety));
}

vxt_result vxt_plan_create(vxt_plan** plan) {
    return create(plan, [] { return vxt_plan(); });
}

vxt_result vxt_plan_get(const vxt_plan* plan, vxt_plan_view* view) {
    return call([&] {
        const vxt_plan& from = need(plan, "plan");
        vxt_plan_view out = vxt_plan_view_init();
        out.paths = handOut<vxt_planned_path>(from.paths, &out.path_count);
        out.triangles = handOut<vxt_entry_triangle>(from.triangles, &out.triangle_count);
        out.triangle_clearances = from.triangleClearances.empty() ? nullptr : from.triangleClearances.data();
        out.area = from.totals.area;
        out.safe_area = from.totals.safeArea;
        out.wall_milliseconds = from.totals.wallMilliseconds;
        out.directions = from.totals.directions;
        out.no_surface = from.totals.noSurface;
        out.on_border = from.totals.onBorder;
        out.too_long = from.totals.tooLong;
        out.too_oblique = from.totals.tooOblique;
        writeStruct(view, out, "view");
    });
}

void vxt_plan_destroy(vxt_plan* plan) {
    delete plan;
}

vxt_result vxt_host_planner_create(const vxt_host_planner_desc* desc, vxt_host_planner** planner) {
    return create(planner, [&] { return take(cpu::Planner::create(toDesc(desc))); });
}

vxt_result vxt_host_planner_plan(vxt_host_planner* planner, const vxt_plan_task* task, vxt_plan* plan) {
    return call([&] {
        cpu::Planner& by = need(planner, "planner").object;
        vxt_plan& to = need(plan, "plan");
        const TaskOf of(task);
        const cpu::PlanTask asked = of.task();
        to = toPlan(take(by.plan(asked)), asked.triangleClearances);
    });
}

uint32_t vxt_host_planner_threads(const vxt_host_planner* planner) {
    return planner == nullptr ? 0 : planner->object.threads();
}

void vxt_host_planner_destroy(vxt_host_planner* planner) {
    delete planner;
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

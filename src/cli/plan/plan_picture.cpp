// SPDX-License-Identifier: MIT
#include "cli/plan/plan_picture.h"
#include "cli/plan/plan_colours.h"
#include "cli/render/device_picture.h"
#include "cli/render/mesh_distance.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/glm_bridge.h"
#include "voxtact/io.h"
#include "voxtact/looks.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

using glm::dvec3;

Colour toColour(const Rgb& rgb) {
    return {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
}

ViewDirection directionTo(const dvec3& eye) {
    return {glm::degrees(std::atan2(eye.x, -eye.y)), glm::degrees(std::asin(std::clamp(eye.z, -1.0, 1.0)))};
}

/// The plan and the path of a picture.
struct Shown {
    const TargetPlan* plan = nullptr;
    const PlannedPath* best = nullptr; ///< null: no safe path
    dvec3 along{0, -1, 0};             ///< from the target to the best entry, or else to the middle of all entries
    dvec3 away{};                      ///< perpendicular to the path: this side is cut away
};

dvec3 middleOf(const PlanAnswer& answer) {
    dvec3 sum(0);
    for (const PlannedPath& path : answer.paths) {
        sum += toGlm(path.position) / static_cast<double>(answer.paths.size());
    }
    return sum;
}

Shown shownOf(std::span<const TargetPlan> plans) {
    Shown out{plans.data()};
    if (const std::vector<ChosenPath> best = rankedPaths(plans, 1); !best.empty()) {
        out.plan = best.front().plan;
        out.best = best.front().path;
        out.along = glm::normalize(toGlm(out.best->position) - toGlm(out.plan->target.at));
    } else if (const dvec3 middle = middleOf(out.plan->answer) - toGlm(out.plan->target.at); glm::length(middle) > 1) {
        out.along = glm::normalize(middle);
    }
    const dvec3 level = glm::cross(out.along, dvec3(0, 0, 1));
    out.away = glm::length(level) > 0.1 ? glm::normalize(level) : dvec3(1, 0, 0);
    // The side towards the left or the front, by convention.
    if (out.away.x - out.away.y < 0) {
        out.away = -out.away;
    }
    return out;
}

std::string hundredths(double value, double (*round)(double)) {
    return number(round(value * 100) / 100);
}

class PlanPainter {
  public:
    PlanPainter(const PlanOptions& options, const PlanInputs& inputs, const Shown& shown,
                const device::Session& session)
        : options_(options), inputs_(inputs), shown_(shown), session_(session) {}

    [[nodiscard]] Result<void> read() {
        scene_.volume = *inputs_.shown;
        const PlanVolume& head = *inputs_.head;
        Result<std::vector<ControlPoint>> points = loadControlPoints(options_.transferFunction);
        VOXTACT_TRY(points);
        scene_.values = head.values;
        scene_.domain = tableDomain(options_.transferFunction, head.type, head.values);
        scene_.opacity = points->empty() ? defaultRamp(scene_.domain) : std::move(*points);
        // The cut face shows voxel values.
        scene_.colours = {{head.values.lo, {0.05, 0.05, 0.05}}, {head.values.hi, {1, 0.98, 0.95}}};
        scene_.poses = {identity()};
        look_.transferFunction = options_.transferFunction;
        look_.progress = false;
        look_.background = {0.11, 0.12, 0.14};
        return {};
    }
    /// Paints the view from outside, slightly off the path, which would otherwise be a point.
    [[nodiscard]] Result<Picture> outside(VkExtent2D size) {
        constexpr double kOffPath = 0.45; // radians
        const dvec3 eye = std::cos(kOffPath) * shown_.along + std::sin(kOffPath) * shown_.away;
        begin(size, directionTo(glm::normalize(eye)), {});
        addEntries([](const Vec3&) { return true; });
        VOXTACT_TRY(addInstrument());
        std::vector<Swatch> swatches{{toColour(planColour(unsafe(), 1)), "unsafe"},
                                     {toColour(planColour(possible(), 1)), "undecided"}};
        if (shown_.best != nullptr) {
            swatches.push_back({look_.meshColours.back(), "best path"});
        }
        return paint(size, "entries to " + targetText() + ", " + areaText(), std::move(swatches), false);
    }
    /// Paints the view from the side, without the part in front of the path.
    [[nodiscard]] Result<Picture> cut(VkExtent2D size) {
        const Vec3 target = shown_.plan->target.at;
        const Vec3 normal = fromGlm(shown_.away);
        const double offset = glm::dot(shown_.away, toGlm(target));
        begin(size, directionTo(shown_.away), {{normal, offset}});
        addEntries([&](const Vec3& at) { return glm::dot(shown_.away, toGlm(at)) < offset; });
        ColouredMesh avoided = avoidedMesh(inputs_, target, normal);
        const bool some = !avoided.mesh.indices.empty();
        const Colour colour = avoided.colour;
        if (some) {
            add(std::move(avoided));
        }
        VOXTACT_TRY(addInstrument());
        std::vector<Swatch> swatches;
        if (some) {
            swatches.push_back({colour, "avoid"});
        }
        swatches.push_back({look_.meshColours.back(), "entry " + std::to_string(shown_.best->entry)});
        return paint(size,
                     "cut along the path: at least " + hundredths(shown_.best->clearance.lower, std::floor) +
                         " mm clear, " + hundredths(shown_.best->length, std::round) + " mm long",
                     std::move(swatches), true);
    }

  private:
    static PlannedPath unsafe() {
        PlannedPath path;
        path.safety = Safety::Unsafe;
        return path;
    }
    static PlannedPath possible() { return {}; }

    /// Returns the name of the target; if it is only a number, its position.
    [[nodiscard]] std::string targetText() const {
        const PlanTarget& target = shown_.plan->target;
        if (!std::ranges::all_of(target.name, [](char one) { return one >= '0' && one <= '9'; })) {
            return target.name;
        }
        std::string text;
        for (const double component : target.at) {
            text += (text.empty() ? "(" : ", ") + number(std::round(10 * component) / 10 + 0.0);
        }
        return text + ")";
    }
    [[nodiscard]] std::string areaText() const {
        const PlanAnswer& answer = shown_.plan->answer;
        if (inputs_.task.mesh) {
            return std::to_string(answer.paths.size()) + " paths";
        }
        return number(std::floor(answer.safeArea / 100)) + " of " + number(std::round(answer.area / 100)) +
               " cm\u00b2 safe";
    }
    void begin(VkExtent2D size, const ViewDirection& direction, std::vector<ClipPlane> clips) {
        look_.view.size = size;
        look_.meshColours.clear();
        scene_.meshes.clear();
        scene_.clips = std::move(clips);
        const bool annotated = std::min(size.width, size.height) >= kAnnotatedFrom;
        scene_.room = annotated ? std::optional(roomFor(size.width, size.height, true, true)) : std::nullopt;
        const Box2 room = scene_.room ? scene_.room->frame
                                      : Box2{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
        // Maximum reach of the instrument.
        Box around = transformBox(worldFromTexture(scene_.volume.grid), {{0, 0, 0}, {1, 1, 1}});
        constexpr double kMore = 60; // mm
        for (std::size_t axis = 0; axis < 3; ++axis) {
            around.lo[axis] -= kMore;
            around.hi[axis] += kMore;
        }
        scene_.clip_from_world = viewFrom(direction, scene_.volume.grid, around, size.width, size.height,
                                          ViewFrame{room.left, room.top, room.right, room.bottom});
    }
    void add(ColouredMesh mesh) {
        scene_.meshes.push_back(std::move(mesh.mesh));
        look_.meshColours.push_back(mesh.colour);
    }
    void addEntries(const std::function<bool(const Vec3&)>& kept) {
        for (ColouredMesh& mesh : entryMeshes(inputs_, *shown_.plan, *options_.maximum, kept)) {
            add(std::move(mesh));
        }
    }
    [[nodiscard]] Result<void> addInstrument() {
        if (shown_.best == nullptr) {
            return {};
        }
        Result<ColouredMesh> mesh = instrumentMesh(inputs_, *shown_.plan, *shown_.best);
        VOXTACT_TRY(mesh);
        add(std::move(*mesh));
        return {};
    }
    [[nodiscard]] Result<Picture> paint(VkExtent2D /*size*/, const std::string& title, std::vector<Swatch> swatches,
                                        bool withLegend) {
        Result<Picture> picture = renderOn(look_, scene_, session_);
        VOXTACT_TRY(picture);
        if (!scene_.room) {
            return picture;
        }
        Annotation annotation{title, std::move(swatches), {}, scene_.clip_from_world};
        if (withLegend || shown_.best == nullptr) {
            annotation.legend = distanceLegend(*options_.maximum);
        }
        VOXTACT_TRY(annotate(*picture, annotation, *scene_.room));
        return picture;
    }
    const PlanOptions& options_;
    const PlanInputs& inputs_;
    const Shown& shown_;
    const device::Session& session_;
    RenderOptions look_;
    RenderInputs scene_;
};

Picture besideEachOther(const Picture& left, const Picture& right) {
    constexpr std::size_t kBytes = 4;
    Picture out{left.width + right.width, left.height, {}};
    out.rgba.reserve(left.rgba.size() + right.rgba.size());
    for (std::size_t row = 0; row < out.height; ++row) {
        for (const Picture* part : {&left, &right}) {
            const auto begin = part->rgba.begin() + static_cast<std::ptrdiff_t>(row * part->width * kBytes);
            out.rgba.insert(out.rgba.end(), begin, begin + static_cast<std::ptrdiff_t>(part->width * kBytes));
        }
    }
    return out;
}

} // namespace

Result<Picture> planPicture(const PlanOptions& options, const PlanInputs& inputs, std::span<const TargetPlan> plans,
                            const device::Session& session) {
    const Shown shown = shownOf(plans);
    PlanPainter painter(options, inputs, shown, session);
    VOXTACT_TRY(painter.read());
    Result<Picture> left = painter.outside(options.half);
    if (shown.best == nullptr || !left.ok()) {
        return left;
    }
    const Result<Picture> right = painter.cut(options.half);
    VOXTACT_TRY(right);
    return besideEachOther(*left, *right);
}

} // namespace voxtact::app

// SPDX-License-Identifier: MIT
#include "cli/output/text_for_messages.h"
#include "cli/plan/plan_colours.h"
#include "cli/plan/plan_run.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

std::string tenths(double value) {
    return number(std::round(10 * value) / 10 + 0.0); // 0, not -0
}

std::string countOf(const PlanAnswer& answer, Safety safety) {
    return std::to_string(std::ranges::count(answer.paths, safety, &PlannedPath::safety));
}

std::string bestText(const PlannedPath& best) {
    return "entry " + std::to_string(best.entry) + " at (" + tenths(best.position[0]) + ", " +
           tenths(best.position[1]) + ", " + tenths(best.position[2]) + "), distance at least " +
           number(std::floor(100 * best.clearance.lower) / 100) + " mm, length " + tenths(best.length) + " mm";
}

void addNotesOf(const PlanInputs& inputs, const PlanAnswer& answer, const std::string& before,
                std::vector<std::string>& notes) {
    const std::uint32_t left = answer.noSurface + answer.onBorder + answer.tooLong + answer.tooOblique;
    notes.push_back(
        before + "paths: " + std::to_string(answer.paths.size()) + "; safe: " + countOf(answer, Safety::Safe) +
        ", unsafe: " + countOf(answer, Safety::Unsafe) + ", undecided: " + countOf(answer, Safety::Undecided) +
        (left == 0 ? ""
                   : "; directions that meet no surface: " + std::to_string(answer.noSurface) +
                         ", that enter where the image ends: " + std::to_string(answer.onBorder) + ", too long: " +
                         std::to_string(answer.tooLong) + ", too oblique: " + std::to_string(answer.tooOblique)));
    if (!inputs.task.mesh) {
        notes.push_back(before + "every path is safe from " + tenths(answer.safeArea) + " of " + tenths(answer.area) +
                        " mm² of the entries' surface");
    }
}

} // namespace

std::vector<ChosenPath> rankedPaths(std::span<const TargetPlan> plans, std::size_t max) {
    std::vector<ChosenPath> safe;
    for (const TargetPlan& plan : plans) {
        for (const PlannedPath& path : plan.answer.paths) {
            if (path.safety == Safety::Safe) {
                safe.push_back({&plan, &path});
            }
        }
    }
    const std::size_t kept = std::min(safe.size(), max);
    // Prefers the first of equal paths.
    const auto isBefore = [](const ChosenPath& a, const ChosenPath& b) {
        return isBetter(*a.path, *b.path) ||
               (!isBetter(*b.path, *a.path) && std::pair(a.plan, a.path) < std::pair(b.plan, b.path));
    };
    std::partial_sort(safe.begin(), safe.begin() + static_cast<std::ptrdiff_t>(kept), safe.end(), isBefore);
    safe.resize(kept);
    return safe;
}

std::vector<std::string> planNotes(const PlanInputs& inputs, std::span<const TargetPlan> plans) {
    std::vector<std::string> notes;
    for (const TargetPlan& plan : plans) {
        addNotesOf(inputs, plan.answer, plans.size() > 1 ? "target " + forMessage(plan.target.name) + ": " : "", notes);
    }
    const std::vector<ChosenPath> best = rankedPaths(plans, 1);
    if (best.empty()) {
        notes.emplace_back("no path is safe");
    } else {
        notes.push_back("best: " + bestText(*best.front().path) +
                        (plans.size() > 1 ? ", to target " + forMessage(best.front().plan->target.name) : ""));
    }
    return notes;
}

} // namespace voxtact::app

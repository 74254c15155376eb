// SPDX-License-Identifier: MIT
#pragma once

#include "arrays.h"
#include "edits.h"
#include "image.h"
#include "voxtact/cpu.h"
#include "voxtact/plan.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace voxtact::python {

/// All that is opaque in a volume: what a plan keeps clear of, besides labels.
struct PlanAvoided {
    std::shared_ptr<const Image> volume; ///< null: the scene's, as edited
    OpacityDesc opacity;
};

/// A plan as Python asks for it. Numbers are as in cpu::PlanTask and cpu::PlannerDesc, which say what is refused.
struct PlanWish {
    Vec3 target{};
    Needle needle;
    std::shared_ptr<const Shape> mesh; ///< instead of the needle; null: none
    Vec3 tip{};
    Vec3 axis{0, 0, 1};
    std::vector<std::int32_t> avoid; ///< labels, at any opacity
    std::optional<PlanAvoided> avoided;
    std::uint32_t entries = cpu::EntrySurface().entries;
    std::optional<std::int32_t> entryLabel;
    std::optional<double> entryRadius;
    bool borderEntries = false;
    double margin = 0;
    std::optional<double> longest;
    std::optional<double> steepest;
    double tolerance = kDefaultPlanTolerance;
    double maximum = kDefaultPlanMaximum;
    std::uint64_t mostSteps = cpu::PlannerDesc().mostSteps;
    bool triangleClearances = false;
};

/// A row of Plan::paths.
struct PathRow {
    std::uint32_t entry;
    std::uint32_t between0 = 0; ///< as the others of this name, so that equal rows are equal as bytes
    std::array<double, 3> position;
    double length;
    double angle;        ///< NaN: the entries' surface has no normal there
    std::uint8_t safety; ///< Safety
    std::array<std::uint8_t, 7> between1{};
    double lo;
    double hi;
    std::uint8_t end; ///< ClearanceEnd
    std::array<std::uint8_t, 3> between2{};
    std::int32_t obstacle; ///< 0: labels, 1: what is opaque; -1: nothing is nearest
    std::int32_t label;    ///< what follows is NaN where nothing is nearest, and this 0
    std::int32_t between3 = 0;
    std::array<double, 3> nearest;
    std::array<double, 3> onPath;
};

/// What a plan gave, as columns.
struct Plan {
    explicit Plan(PlanAnswer answer, bool withLabels);

    std::vector<PathRow> paths;
    std::vector<std::uint32_t> triangles; ///< three numbers of paths for each
    std::vector<std::uint8_t> safe;       ///< of each triangle
    std::vector<double> clearances;       ///< of each triangle, where they were asked for
    PlanAnswer totals;                    ///< without paths and triangles
};

/// `options`: members by their names in Python, all but `avoided`.
[[nodiscard]] PlanWish planWishOf(const Doubles& target, const py::dict& options);

void definePlans(py::module_& module);

} // namespace voxtact::python

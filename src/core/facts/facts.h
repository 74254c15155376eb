// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "voxtact/area.h"
#include "voxtact/data.h"
#include "voxtact/distance.h"
#include "voxtact/methods.h"
#include "voxtact/motion.h"
#include "voxtact/overlap.h"
#include "voxtact/plan.h"
#include "voxtact/questions.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

/// The table of facts: name, kind, unit, range, default and text of each setting of a question. The engines check
/// numbers against it; bindings list it; the program generates its options, their help and their errors from it.
namespace voxtact {

/// Kind of a setting's value.
enum class FactKind : std::uint32_t { Number, Whole, Flag, Choice, Numbers, Labels };

/// Whether a setting serves a question about labels.
enum class WithLabels : std::uint32_t { Any, Only, Never };

/// A setting of a question.
struct Fact {
    std::string_view question;        ///< subcommand of the program; "scene": all questions
    std::string_view name;            ///< words joined by '_'
    std::string_view unit = "";       ///< "mm", "mm^2", "mm^3", "degrees", "voxels"; empty: none
    double min = 0;                   ///< smallest value
    double max = kInfinity;           ///< largest value, included if finite
    std::optional<double> standard{}; ///< the default; none: the number is optional
    std::string_view text{};          ///< one line of --help
    bool isMinAllowed = true;
    bool isInfinityAllowed = false;
    FactKind kind = FactKind::Number;
    std::string_view choices = ""; ///< of a choice: its names, comma-separated, the default first
    std::string_view option{};     ///< the program's option without "--"; empty: it has none
    std::string_view table{};      ///< of a list: the table with a row per element, which the program prints
    WithLabels withLabels = WithLabels::Any;
};

/// Smallest whole number that a double cannot tell from its successor.
inline constexpr double kMaxWhole = 0x1p53;

namespace fact {

consteval Fact resolution(std::string_view question, std::string_view name = "resolution") {
    return {question, name, "voxels", 0x1p-12, 1, kDefaultResolution, "minimum size of pieces of triangles, voxels"};
}

consteval Fact whole(std::string_view question, std::string_view name, double min, double max, double standard,
                     std::string_view text) {
    return {.question = question,
            .name = name,
            .min = min,
            .max = max,
            .standard = standard,
            .text = text,
            .kind = FactKind::Whole};
}

consteval Fact maxSteps(std::string_view question, std::uint64_t standard) {
    return whole(question, "max_steps", 1, kMaxWhole, static_cast<double>(standard),
                 "iteration limit per row of the answer");
}

consteval Fact flag(std::string_view question, std::string_view name, std::string_view text,
                    std::string_view option = {}, WithLabels withLabels = WithLabels::Any) {
    return {.question = question,
            .name = name,
            .max = 1,
            .standard = 0,
            .text = text,
            .kind = FactKind::Flag,
            .option = option,
            .withLabels = withLabels};
}

consteval Fact choice(std::string_view question, std::string_view name, std::string_view choices,
                      std::string_view text) {
    return {.question = question, .name = name, .text = text, .kind = FactKind::Choice, .choices = choices};
}

consteval Fact labels(std::string_view question, std::string_view option) {
    return {.question = question,
            .name = "labels",
            .text = "one row per label: numbers, names, or all",
            .kind = FactKind::Labels,
            .option = option,
            .table = "labels"};
}

} // namespace fact

inline constexpr std::array kFacts{
    Fact{"scene", "opacity_threshold", "", 0, 1, kDefaultThreshold, "opacity at which a value is opaque"},
    Fact{"scene", "deflection", "mm", 1e-6, kInfinity, kDefaultDeflection,
         "STEP, IGES: distance of triangles from the surface, mm"},
    Fact{"touch", "margin", "mm", 0, kInfinity, {}, "is anything opaque within this distance, mm?"},
    Fact{"touch", "uncertainty_distance", "mm", 0, kInfinity, {}, "test all poses within this translation, mm"},
    Fact{"touch", "uncertainty_angle", "degrees", 0, 180, {}, "test all poses within this rotation, degrees"},
    fact::flag("touch", "witness", "find a witness point of each yes"),
    fact::flag("touch", "solid", "include the inside of the mesh, which must be closed", "solid"),
    fact::resolution("touch"),
    fact::maxSteps("touch", Touch().maxSteps),
    fact::choice("count", "projection", "view,two-view,dominant-axis,certified", "how triangles become fragments"),
    fact::choice("count", "boundary", "auto,range,clamp", "treatment of fragments outside the image"),
    fact::flag("count", "triangles", "triangles with passing fragments, and their counts"),
    fact::flag("count", "contacts", "a contact per passing fragment"),
    fact::flag("count", "bounds", "world bounding box of each pair's passing fragments"),
    fact::flag("count", "labels", "counts per label of the passing fragments"),
    fact::flag("count", "stop_at_first", "early exit: the count is 0 or 1, a lower bound"),
    fact::whole("count", "samples_per_voxel", 1, kMaxSamplesPerVoxel, kDefaultSamplesPerVoxel,
                "dominant-axis: samples per voxel side"),
    Fact{"count", "resolution", "voxels", 0x1p-12, 1, kDefaultResolution,
         "certified: minimum size of pieces of triangles, voxels"},
    Fact{"count", "max_depth", "mm", 0, kInfinity, kDefaultMaxDepth, "contacts: maximum depth, mm", false},
    fact::whole("count", "max_contacts", 1, double{std::numeric_limits<std::uint32_t>::max()}, Count().maxContacts,
                "contacts: maximum number"),
    Fact{.question = "distance",
         .name = "tolerance",
         .unit = "mm",
         .min = 1e-6,
         .standard = kDefaultTolerance,
         .text = "stop when upper - lower is at most this, mm",
         .option = "tolerance"},
    Fact{.question = "distance",
         .name = "max",
         .unit = "mm",
         .text = "stop when lower reaches this distance, mm",
         .isMinAllowed = false,
         .isInfinityAllowed = true,
         .option = "max"},
    fact::labels("distance", "to"),
    fact::flag("distance", "solid", "include the inside of the mesh, which must be closed", "solid", WithLabels::Never),
    fact::flag("distance", "any_opacity", "with labels: measure whole labels, opaque or not", "any-opacity",
               WithLabels::Only),
    fact::resolution("distance"),
    fact::maxSteps("distance", Distance().maxSteps),
    Fact{.question = "area",
         .name = "tolerance",
         .unit = "mm^2",
         .min = 1e-9,
         .standard = kDefaultAreaTolerance,
         .text = "stop when upper - lower is at most this, mm^2",
         .option = "tolerance"},
    fact::labels("area", "in"),
    fact::flag("area", "triangles", "the area of each triangle"),
    fact::resolution("area"),
    fact::maxSteps("area", Area().maxSteps),
    Fact{.question = "overlap",
         .name = "tolerance",
         .unit = "mm^3",
         .min = 1e-9,
         .standard = kDefaultOverlapTolerance,
         .text = "stop when upper - lower is at most this, mm^3",
         .option = "tolerance"},
    Fact{.question = "overlap",
         .name = "bands",
         .text = "one row per band of values: ascending limits",
         .kind = FactKind::Numbers,
         .option = "bands",
         .table = "bands",
         .withLabels = WithLabels::Never},
    fact::labels("overlap", "in"),
    fact::maxSteps("overlap", Overlap().maxSteps),
    fact::choice("motion", "interpolation", "screw,slerp", "motion between two poses"),
    Fact{"motion", "resolution", "mm", 1e-6, kInfinity, kDefaultMotionResolution,
         "maximum motion from toi_lower to toi_upper, mm"},
    fact::resolution("motion", "touch_resolution"),
    fact::maxSteps("motion", Motion().maxSteps),
    Fact{"plan", "tolerance", "mm", 1e-6, kInfinity, kDefaultPlanTolerance,
         "stop when upper - lower is at most this, mm"},
    Fact{"plan",
         "max",
         "mm",
         0,
         kInfinity,
         {},
         "stop when lower reaches this, mm; default: enough to rank the paths",
         false},
    Fact{"plan", "margin", "mm", 0, kInfinity, 0, "safe distance from the obstacles, mm"},
    Fact{"plan", "max_length", "mm", 0, kInfinity, {}, "maximum length of a path, mm", false},
    Fact{"plan", "max_angle", "degrees", 0, 90, {}, "maximum angle to the normal of the entry, degrees"},
};

/// Returns a fact; a name that is not in the table does not compile.
consteval const Fact& factOf(std::string_view question, std::string_view name) {
    for (const Fact& fact : kFacts) {
        if (fact.question == question && fact.name == name) {
            return fact;
        }
    }
    throw "no such fact";
}

/// Returns a fact by name; null if there is none.
[[nodiscard]] const Fact* findFact(std::string_view question, std::string_view name) noexcept;
/// Returns the range as text: "from 1e-06 mm on", "above 0 mm", "from 0 to 180 degrees".
[[nodiscard]] std::string rangeText(const Fact& fact);
/// Returns true if the value is in the range.
[[nodiscard]] bool isInRange(const Fact& fact, double value) noexcept;
/// Refuses a value outside the range: "the tolerance 0 mm is not a number from 1e-06 mm on".
[[nodiscard]] Result<void> checkFact(const Fact& fact, double value);

} // namespace voxtact

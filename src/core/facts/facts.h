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

#include <array>
#include <optional>
#include <string>
#include <string_view>

/// The table of facts: name, unit, range, default and text of each number of a question. The engines check numbers
/// against it; the program generates its options, their help and their errors from it.
namespace voxtact {

/// A number of a question.
struct Fact {
    std::string_view question;        ///< subcommand of the program; "scene": all questions
    std::string_view name;            ///< words joined by '_'
    std::string_view unit;            ///< "mm", "mm^2", "mm^3", "degrees", "voxels"; empty: none
    double min = 0;                   ///< smallest value
    double max = kInfinity;           ///< largest value, included if finite
    std::optional<double> standard{}; ///< the default; none: the number is optional
    std::string_view text;            ///< one line of --help
    bool isMinAllowed = true;
    bool isInfinityAllowed = false;
};

inline constexpr std::array kFacts{
    Fact{"scene", "opacity_threshold", "", 0, 1, kDefaultThreshold, "opacity at which a value is opaque"},
    Fact{"scene", "deflection", "mm", 1e-6, kInfinity, kDefaultDeflection,
         "STEP, IGES: distance of triangles from the surface, mm"},
    Fact{"touch", "margin", "mm", 0, kInfinity, {}, "is anything opaque within this distance, mm?"},
    Fact{"touch", "uncertainty_distance", "mm", 0, kInfinity, {}, ""},
    Fact{"touch", "uncertainty_angle", "degrees", 0, 180, {}, ""},
    Fact{"count", "resolution", "voxels", 0x1p-12, 1, kDefaultResolution,
         "certified: minimum size of pieces of triangles, voxels"},
    Fact{"count", "max_depth", "mm", 0, kInfinity, kDefaultMaxDepth, "contacts: maximum depth, mm", false},
    Fact{"distance", "tolerance", "mm", 1e-6, kInfinity, kDefaultTolerance,
         "stop when upper - lower is at most this, mm"},
    Fact{"distance", "max", "mm", 0, kInfinity, {}, "stop when lower reaches this distance, mm", false, true},
    Fact{"area", "tolerance", "mm^2", 1e-9, kInfinity, kDefaultAreaTolerance,
         "stop when upper - lower is at most this, mm^2"},
    Fact{"overlap", "tolerance", "mm^3", 1e-9, kInfinity, kDefaultOverlapTolerance,
         "stop when upper - lower is at most this, mm^3"},
    Fact{"motion", "resolution", "mm", 1e-6, kInfinity, kDefaultMotionResolution,
         "maximum motion from toi_lower to toi_upper, mm"},
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

/// Returns the range as text: "from 1e-06 mm on", "above 0 mm", "from 0 to 180 degrees".
[[nodiscard]] std::string rangeText(const Fact& fact);
/// Returns true if the value is in the range.
[[nodiscard]] bool isInRange(const Fact& fact, double value) noexcept;
/// Refuses a value outside the range: "the tolerance 0 mm is not a number from 1e-06 mm on".
[[nodiscard]] Result<void> checkFact(const Fact& fact, double value);

} // namespace voxtact

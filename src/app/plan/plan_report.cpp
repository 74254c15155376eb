// SPDX-License-Identifier: MIT
#include "app/plan/plan_colours.h"
#include "app/plan/plan_run.h"
#include "app/version.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace voxtact::app {

namespace {

constexpr std::size_t kRanked = 25;
/// Of a picture: more would only hide each other.
constexpr std::size_t kMostDots = 8000;
constexpr double kDisc = 240; ///< pixels, the radius of a half of the map

std::string htmlText(const std::string& text) {
    std::string out;
    for (const char one : text) {
        out += one == '&'   ? "&amp;"
               : one == '<' ? "&lt;"
               : one == '>' ? "&gt;"
               : one == '"' ? "&quot;"
                            : std::string(1, one);
    }
    return out;
}

using Rounding = double (*)(double);

/// `round`: std::floor and std::ceil keep what is certain of a bound.
std::string fixed(double value, int digits, Rounding round = std::round) {
    const double scale = std::pow(10.0, digits);
    std::ostringstream out;
    out << std::fixed << std::setprecision(digits) << round(value * scale) / scale + 0.0; // 0, not -0
    return out.str();
}

std::string colourText(const Rgb& colour) {
    std::ostringstream out;
    out << "#" << std::hex << std::setfill('0');
    for (const std::uint8_t component : colour) {
        out << std::setw(2) << static_cast<unsigned>(component);
    }
    return out.str();
}

/// A half of the directions, seen along z from outside: as far from the disc's middle as the angle to z is large.
void writeHalf(std::ostream& out, const PlanInputs& inputs, const PlanAnswer& answer, double maximum, bool upper) {
    const std::size_t step = answer.paths.size() / kMostDots + 1;
    const Vec3& target = inputs.task.target;
    const double size = std::max(
        2.0, 0.9 * kDisc * std::sqrt(8.0 / static_cast<double>(std::min(answer.directions / step, kMostDots) + 1)));
    const double middle = kDisc + 10;
    out << "<figure><svg width=\"" << 2 * middle << "\" height=\"" << 2 * middle << "\"><circle cx=\"" << middle
        << "\" cy=\"" << middle << "\" r=\"" << kDisc << "\" fill=\"#f4f4f4\" stroke=\"#999\"/>\n";
    for (std::size_t i = 0; i < answer.paths.size(); i += step) {
        const PlannedPath& path = answer.paths[i];
        const double x = path.position[0] - target[0];
        const double y = path.position[1] - target[1];
        const double z = (upper ? 1 : -1) * (path.position[2] - target[2]);
        const double flat = std::hypot(x, y);
        if (z < 0) {
            continue;
        }
        const double far = flat > 0 ? kDisc * std::atan2(flat, z) / (std::acos(0.0) * flat) : 0;
        out << "<circle cx=\"" << fixed(middle + (upper ? 1 : -1) * far * x, 1) << "\" cy=\""
            << fixed(middle + far * y, 1) << "\" r=\"" << fixed(size / 2, 1) << "\" fill=\""
            << colourText(planColour(path, maximum)) << "\"><title>" << path.entry << ": "
            << fixed(path.clearance.lo, 2, std::floor) << " mm</title></circle>\n";
    }
    out << "</svg><figcaption>" << (upper ? "entries above the target, seen from above" : "below it, seen from below")
        << "</figcaption></figure>\n";
}

std::vector<const PlannedPath*> ranked(const PlanAnswer& answer) {
    std::vector<const PlannedPath*> safe;
    for (const PlannedPath& path : answer.paths) {
        if (path.safety == Safety::Safe) {
            safe.push_back(&path);
        }
    }
    const std::size_t kept = std::min(safe.size(), kRanked);
    std::partial_sort(safe.begin(), safe.begin() + static_cast<std::ptrdiff_t>(kept), safe.end(),
                      [](const PlannedPath* a, const PlannedPath* b) { return isBetter(*a, *b); });
    safe.resize(kept);
    return safe;
}

Rounding roundingOf(const std::string& column) {
    return column == "clearance_lo"   ? Rounding{std::floor}
           : column == "clearance_hi" ? Rounding{std::ceil}
                                      : Rounding{std::round};
}

void writeRanking(std::ostream& out, const PlanInputs& inputs, const PlanAnswer& answer) {
    const io::Table table = planTable(inputs, answer, false);
    out << "<h2>The safest paths</h2>\n<table><tr>";
    for (const std::string& column : table.columns) {
        out << "<th>" << column << "</th>";
    }
    out << "</tr>\n";
    for (const PlannedPath* path : ranked(answer)) {
        out << "<tr>";
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            const io::Cell cell = table.cell(static_cast<std::size_t>(path - answer.paths.data()), column);
            out << "<td>";
            if (const auto* text = std::get_if<std::string>(&cell)) {
                out << htmlText(*text);
            } else if (const auto* real = std::get_if<double>(&cell)) {
                out << (std::isfinite(*real) ? fixed(*real, 2, roundingOf(table.columns[column])) : number(*real));
            } else if (const auto* whole = std::get_if<std::uint64_t>(&cell)) {
                out << *whole;
            } else if (const auto* word = std::get_if<io::NumberWord>(&cell)) {
                out << word->word;
            }
            out << "</td>";
        }
        out << "</tr>\n";
    }
    out << "</table>\n";
}

} // namespace

void writePlanReport(std::ostream& out, const PlanInputs& inputs, const PlanAnswer& answer,
                     const std::vector<std::string>& notes, double maximum) {
    out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Paths to a target</title>\n<style>"
           "body{font:15px/1.4 sans-serif;margin:2em;max-width:80em}table{border-collapse:collapse;font-size:13px}"
           "td,th{border:1px solid #ccc;padding:2px 6px;text-align:right}figure{display:inline-block;margin:0 1em 1em "
           "0}"
           "figcaption{text-align:center}</style></head><body>\n<h1>Paths to ("
        << fixed(inputs.task.target[0], 2) << ", " << fixed(inputs.task.target[1], 2) << ", "
        << fixed(inputs.task.target[2], 2)
        << ")</h1>\n<p>World millimetres, LPS. A safe path certainly keeps more than " << number(inputs.task.margin)
        << " mm.</p>\n<ul>\n";
    for (const std::string& note : notes) {
        out << "<li>" << htmlText(note) << "</li>\n";
    }
    out << "</ul>\n<h2>Where they begin</h2>\n";
    writeHalf(out, inputs, answer, maximum, true);
    writeHalf(out, inputs, answer, maximum, false);
    out << "<p>Red: unsafe. Grey: possible. Safe by clearance: ";
    constexpr int kSteps = 5;
    for (int i = 0; i <= kSteps; ++i) {
        const double share = static_cast<double>(i) / kSteps;
        out << "<span style=\"border-left:1em solid " << colourText(viridis(share)) << ";padding:0 1em 0 .3em\">"
            << number(std::round(100 * share * maximum) / 100) << (i == kSteps ? " mm and more" : " mm") << "</span>";
    }
    out << "</p>\n";
    writeRanking(out, inputs, answer);
    out << "<p>voxtact " << htmlText(std::string(programVersion())) << "</p>\n</body></html>\n";
}

} // namespace voxtact::app
